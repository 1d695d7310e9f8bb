// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The studio's dialog that writes files.
import { button, copyable, make } from './elements.js';
import { dialog } from './keys.js';

const files = [
  'dem.tif', 'network.gpkg', 'report.html', 'recipe.toml', 'contours.gpkg', 'catchments.gpkg', 'map.png', 'report.json',
];

/** Saves a file at an address of the program's; the page's own query goes with it. */
function download(address, file) {
  const url = new URL(address, location.href);
  for (const [name, value] of new URLSearchParams(location.search)) {
    if (!url.searchParams.has(name)) url.searchParams.append(name, value);
  }
  make('a', { href: url.href, download: file }).click();
}

export class Exporting {
  #write;
  #outcome = make('div', { className: 'outcome' });
  #command = make('div');
  #whole = button('Export everything', 'Write all files of make into the export folder', () => this.#export());
  #choice = make('select', { id: 'one-file' }, ...files.map((value) => make('option', { value, textContent: value })));
  #one = button('Save', 'Save this file', () => this.#export(this.#choice.value));
  #dialog;

  /** write(file, or undefined for all): a promise of {files, folder, url}. */
  constructor(write) {
    this.#write = write;
    this.#outcome.setAttribute('role', 'status');
    const label = make('label', { htmlFor: 'one-file', textContent: 'One file' });
    this.#dialog = dialog(
      'Export',
      make('p', { textContent: 'All files that make writes, in a folder beside the recipe:' }),
      this.#whole,
      make('p', { className: 'one' }, label, this.#choice, this.#one),
      this.#outcome,
      make('p', { className: 'hint', textContent: 'The same by the command line:' }),
      this.#command,
    );
    this.#dialog.id = 'export';
  }

  open() {
    this.#dialog.showModal();
  }

  showCommand(command) {
    this.#command.replaceChildren(copyable(command, 'the command'));
  }

  #enable(isEnabled) {
    this.#whole.disabled = this.#one.disabled = !isEnabled;
  }

  async #export(file) {
    this.#enable(false);
    this.#outcome.replaceChildren(make('p', { textContent: file ? `Making ${file}…` : 'Writing all files…' }));
    try {
      const reply = await this.#write(file);
      if (file && reply.url) download(reply.url, file);
      this.#tell(reply, file);
    } catch (error) {
      this.#outcome.replaceChildren(make('p', { className: 'refused', textContent: error.message }));
    }
    this.#enable(true);
  }

  #tell({ files: written = [], folder = '' }, file) {
    const text = file ? `${file} is saved.` : `${written.length} files in`;
    /** @type {HTMLElement[]} */
    const parts = [make('p', { className: 'done', textContent: text })];
    if (!file) parts.push(copyable(folder, 'the folder'));
    if (written.length > 1) {
      const list = make('p', { className: 'hint', textContent: written.join(', ') });
      parts.push(make('details', {}, make('summary', { textContent: 'Which' }), list));
    }
    this.#outcome.replaceChildren(...parts);
  }
}
