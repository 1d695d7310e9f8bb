// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The card with what was measured: over the view, on a phone below it.
import './measure.css';
import { plot } from './chart.js';
import { make } from './elements.js';

export class MeasureCard {
  /** Shows a reading of the diagram at a point; null: none. */
  read = (_index) => {};
  #title = make('h2');
  #hint = make('p', { className: 'hint' });
  #body = make('div');
  #foot = make('div', { className: 'do' });
  #spoken = make('p', { className: 'unseen' });
  #speaking; // what waits to be spoken
  #whole;

  /** stage: what the view lies in; close(): the card is closed by its button. */
  constructor(stage, close) {
    const button = make('button', { type: 'button', className: 'close', textContent: '×', title: 'Close (Esc)' });
    button.setAttribute('aria-label', 'Close');
    button.addEventListener('click', close);
    const head = make('header', {}, this.#title, button);
    this.#whole = make(
      'section', { id: 'measure', className: 'report', hidden: true }, head, this.#hint, this.#body, this.#foot,
    );
    this.#whole.setAttribute('aria-label', 'Measurement');
    this.#spoken.setAttribute('role', 'status');
    const phone = matchMedia('(max-width: 860px)');
    const settle = () => (phone.matches ? stage.after(this.#whole) : stage.append(this.#whole));
    phone.addEventListener('change', settle);
    settle();
    stage.append(this.#spoken);
  }

  /** Tells who does not see the view, once a quarter of a second at most. */
  speak(words) {
    clearTimeout(this.#speaking);
    this.#speaking = setTimeout(() => (this.#spoken.textContent = words), 250);
  }

  /** help: what to do next, '' for nothing. */
  show({ isOpen, title, help }) {
    this.#whole.hidden = !isOpen;
    document.documentElement.dataset.measure = isOpen ? 'on' : 'off';
    this.#hint.textContent = help;
    this.#hint.hidden = help === '';
    this.#title.textContent = title;
  }

  /** Fills in what was found (measurements.js). point(place or null): where the diagram is read. */
  fill({ chart, content, missing, points }, point) {
    const { activeElement } = document;
    const isReading = this.#body.contains(activeElement) && activeElement.closest('.plot');
    const isUnfolded = this.#body.querySelector('details')?.open;
    this.read = () => {};
    const parts = [];
    if (chart) {
      const onread = (i) => point(i === null ? null : points[i]);
      const { figure, read } = plot([chart.series], { ...chart.what, onread });
      this.read = read;
      parts.push(figure);
    }
    if (missing) parts.push(make('p', { className: 'missing', textContent: missing }));
    this.#body.replaceChildren(...parts, ...content.filter(Boolean));
    if (isUnfolded) this.#body.querySelector('details')?.setAttribute('open', '');
    if (isReading) /** @type {HTMLElement} */ (this.#body.querySelector('.plot'))?.focus();
  }

  /** What can be done with a measurement. */
  offer(...controls) {
    this.#foot.replaceChildren(...controls);
  }

  clear() {
    this.read = () => {};
    this.#body.replaceChildren();
    this.#foot.replaceChildren();
    this.#spoken.textContent = '';
  }
}
