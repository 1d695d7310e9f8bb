// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the program is doing and what it said: over the view, and as a list.
import { button, byId, make } from './elements.js';

/** The bar above the view and the words in it. */
export class Progress {
  #bar = make('div', { id: 'bar' }, make('i'));
  #words = make('span');
  #doing;
  #stop;
  #spoken = make('p', { className: 'unseen' });
  #fading; // after which the words go
  #done = { job: -1, stage: '', share: 0 }; // of the stage that runs

  /** stop(): the reader wants no more of it. */
  constructor(stop) {
    this.#stop = button('Stop', 'Stop what is being computed', stop);
    this.#doing = make('div', { id: 'doing', hidden: true }, this.#words, this.#stop);
    this.#spoken.setAttribute('role', 'status');
    this.#bar.setAttribute('aria-hidden', 'true');
    byId('stage').append(this.#bar, this.#doing, this.#spoken);
  }

  /** Tells something; '': what was told is gone. isBad: it stays; isRunning: it can be stopped. */
  tell(text, { isBad = false, isRunning = false } = {}) {
    clearTimeout(this.#fading);
    this.#words.textContent = text;
    this.#doing.classList.toggle('bad', isBad);
    this.#stop.hidden = !isRunning;
    this.#doing.hidden = text === '';
    if (!isRunning) this.#spoken.textContent = text;
    if (!isRunning && !isBad && text) this.#fading = setTimeout(() => (this.#doing.hidden = true), 4000);
  }

  /** A stage runs. share: how much of it is done. */
  run({ job, stage, share }) {
    const before = this.#done;
    // A stage of several passes does not run backwards.
    const least = before.job === job && before.stage === stage ? before.share : share;
    const done = Math.max(least, share);
    this.#done = { job, stage, share: done };
    this.#bar.classList.add('on');
    this.#bar.querySelector('i').style.width = `${(100 * done).toFixed(1)}%`;
    const percent = done > 0 && done < 1 ? ` ${Math.round(100 * done)}\u00a0%` : '';
    this.tell(stage.replace(/_/g, ' ') + percent, { isRunning: true });
  }

  /** Nothing runs any more. */
  end() {
    this.#bar.classList.remove('on');
  }
}

/** What the program said, and above it the warnings of the last job. */
export class Messages {
  #list = make('ol', { className: 'said' });
  #head = make('summary', { textContent: 'Messages' });
  #warnings = []; // items
  element = make('details', { className: 'messages', hidden: true }, this.#head, this.#list);

  #count() {
    const { length } = this.#list.children;
    this.element.hidden = length === 0;
    this.#head.textContent = `Messages (${length})`;
  }

  add(text) {
    this.#list.append(make('li', { textContent: text }));
    while (this.#list.children.length > 50) this.#list.firstElementChild.remove();
    this.#count();
  }

  /** findings: as in report.json; its warnings take the place of those before. */
  warn(findings) {
    for (const item of this.#warnings) item.remove();
    const warnings = findings.filter(({ severity }) => severity === 'warning');
    this.#warnings = warnings.map(({ kind, text, remedy }) =>
      make('li', { className: 'careful', title: kind, textContent: remedy ? `${text}. ${remedy}.` : text }),
    );
    this.#list.prepend(...this.#warnings);
    this.#count();
  }
}
