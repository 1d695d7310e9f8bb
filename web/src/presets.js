// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Kinds of land that a document may begin with: the presets of `thalweg make`, as the program tells them.
import { make } from './elements.js';
import { plain } from './fields.js';

const editOf = (name) => `preset ${name}`;

/** "basin-and-range": "Basin and range" */
export const titleOf = (name) => name.replaceAll('-', ' ').replace(/^./, (c) => c.toUpperCase());

/** "a plain": "A plain." */
export const sentence = (words) => `${words.replace(/^./, (c) => c.toUpperCase())}.`;

/**
 * Whether nothing of a document is the reader's own: it names no file, and nothing but presets was chosen since it
 * began. files: keys that name one.
 */
export function isFresh({ undo, redo, values }, files) {
  const isPreset = (name) => !name || name.startsWith(editOf(''));
  return isPreset(undo) && isPreset(redo) && files.every(({ path }) => !plain(values[path]));
}

export class Presets {
  #files;
  #isFresh = null; // of the document shown last

  /** presets, keys: README.md; begin(edit): the document begins anew by an edit. */
  constructor({ presets, keys }, begin) {
    this.#files = keys.filter((key) => key.is_file);
    const all = presets.map(({ name, meaning, not_meant, recipe }) => {
      const button = make(
        'button',
        { type: 'button', title: 'Begin anew with this land; undo brings back what is there' },
        make('b', { textContent: titleOf(name) }),
        make('span', { textContent: sentence(meaning) }),
        make('small', { textContent: sentence(`not ${not_meant}`) }),
      );
      button.dataset.preset = name;
      button.addEventListener('click', () => begin({ name: editOf(name), steps: [{ recipe }] }));
      return button;
    });
    const head = make('summary', { textContent: 'Begin with' });
    this.element = make('details', { id: 'presets', hidden: all.length === 0 }, head, ...all);
  }

  /** By a document: unfolded as long as it is fresh. */
  show(document) {
    const isNow = isFresh(document, this.#files);
    if (isNow === this.#isFresh) return;
    this.#isFresh = isNow;
    this.element.open = isNow;
  }
}
