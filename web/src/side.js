// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The studio's panel at the left: edits and their history, presets, seed, source, cluster, pruning
// length and the recipe's form.
import { ClusterPicture } from './cluster.js';
import { button, byId, inputById, make } from './elements.js';
import { isStandard, plain } from './fields.js';
import { Presets } from './presets.js';
import { RecipeForm } from './recipe.js';

const root = document.documentElement;
const branch = 'network.dla.branch';
const prune = 'network.prune';
const row = (label, ...controls) => make('div', { className: 'row' }, label, ...controls);

/** The slider of the pruning length as the recipe has it. */
class RecipeLength {
  least = 1;
  /** Whether the slider is drawn: what is shown is not the recipe's. */
  isDrawn = false;
  #side;

  constructor(side) {
    this.#side = side;
    byId('L').addEventListener('pointerup', () =>
      setTimeout(() => this.isDrawn && this.changed(inputById('L').value)),
    );
  }

  changing(value) {
    this.isDrawn = true;
    this.#side.act.trying(prune, value);
  }

  changed(value) {
    const { act, studio } = this.#side;
    this.isDrawn = false;
    const now = plain(studio.document.values[prune] ?? studio.scenes.now?.data.rivers.prune);
    if (Number(value) === Number(now)) act.trying(prune, value);
    else this.#side.quietly(act.set(prune, value));
  }
}

export class Side {
  /** What the fields do: {trying(path, value), set(path, value), unset(path)}, the last two give promises. */
  act;
  #undo = button('Undo', 'Undo (Ctrl+Z)', () => this.undo());
  #redo = button('Redo', 'Redo (Ctrl+Shift+Z, Ctrl+Y)', () => this.quietly(this.studio.ask({ do: 'redo' })));
  #seed = make('input', { type: 'number', id: 'seed', min: 0, step: 1, autocomplete: 'off' });
  #source = make('select', { id: 'source' });
  #lengths = byId('field-L');
  #length;

  /** studio: of studio.js; compare: the button that shows what was before. */
  constructor(studio, compare) {
    this.studio = studio;
    const { about, questions } = studio;
    this.act = {
      trying: (path, value) => questions.try({ set: path, value }),
      set: (path, value) => questions.edit({ set: path, value }),
      unset: (path) => questions.edit({ unset: path }),
    };
    this.cluster = new ClusterPicture(studio.keyOf(branch).choices, (arm) => this.quietly(this.act.set(branch, arm)));
    this.form = new RecipeForm(about.keys, this.act, ['seed', 'network.source', prune]);
    this.presets = new Presets(about, (edit) => this.quietly(studio.ask({ do: 'edit', edit })));
    const view = byId('controls');
    view.hidden = true;
    this.element = make('aside', { id: 'recipe' });
    this.element.setAttribute('aria-label', 'Studio');
    this.element.append(
      byId('title'),
      this.#toolbar(compare),
      this.presets.element,
      make('div', { id: 'length' }, this.#lengthField()),
      this.#firstKeys(),
      view,
      this.form.element,
      studio.messages.element,
      byId('foot'),
    );
    document.body.prepend(this.element);
    byId('ways').insertBefore(this.#toggle(), byId('bpanel'));
    this.#length = new RecipeLength(this);
  }

  #toolbar(compare) {
    const write = button('Export…', 'Write files', () => this.studio.exporting.open());
    const tools = make('div', { className: 'tools' }, this.#undo, this.#redo, compare, write);
    tools.setAttribute('role', 'toolbar');
    tools.setAttribute('aria-label', 'Edits');
    return tools;
  }

  #firstKeys() {
    const set = (path, value) => this.quietly(this.act.set(path, value));
    const [seed, source] = [this.#seed, this.#source];
    seed.addEventListener('change', () => seed.value !== '' && set('seed', seed.value));
    const chance = button('New seed', 'Another terrain of the same recipe', () =>
      set('seed', String(1 + Math.floor(Math.random() * 99999))),
    );
    const choices = this.studio.keyOf('network.source')?.choices ?? [];
    source.append(...choices.map((value) => make('option', { value, textContent: value })));
    source.addEventListener('change', () => set('network.source', source.value));
    return make(
      'div',
      { id: 'first' },
      row(make('label', { htmlFor: 'seed', textContent: 'Seed' }), seed, chance),
      row(make('label', { htmlFor: 'source', textContent: 'Rivers from' }), source),
      this.cluster.element,
    );
  }

  #lengthField() {
    this.#lengths.hidden = true;
    this.#lengths.querySelector('label').textContent = 'Prune streams below';
    return this.#lengths;
  }

  /** The button over the view that hides the panel. */
  #toggle() {
    const toggle = button('Recipe', 'Show or hide the recipe', () => {
      const off = root.dataset.recipe !== 'off';
      root.dataset.recipe = off ? 'off' : 'on';
      toggle.setAttribute('aria-pressed', String(!off));
    });
    toggle.setAttribute('aria-pressed', 'true');
    return toggle;
  }

  /** For what stands above the sections: a refusal is told in the view. */
  quietly(promise) {
    return promise.catch((error) => {
      this.studio.progress.tell(error.message, { isBad: true });
      this.show();
    });
  }

  /** What was drawn and not sent is taken back before the program's edits. */
  undo() {
    if (!this.studio.sheet?.desk.recall()) this.quietly(this.studio.ask({ do: 'undo' }));
  }

  /** The button of the last step, or of the one that was taken back. */
  press(again) {
    const pressed = again ? this.#redo : this.#undo;
    if (!pressed.disabled) pressed.click();
  }

  /** Everything by the document. */
  show() {
    this.form.show(this.studio.document);
    this.presets.show(this.studio.document);
    this.showFirst();
  }

  /** The controls above the sections, by the document. */
  showFirst() {
    const { values, undo, redo } = this.studio.document;
    this.#undo.disabled = !undo;
    this.#redo.disabled = !redo;
    this.#undo.title = `Undo${undo ? `: ${undo}` : ''} (Ctrl+Z)`;
    this.#redo.title = `Redo${redo ? `: ${redo}` : ''} (Ctrl+Shift+Z, Ctrl+Y)`;
    this.#seed.value = plain(values.seed ?? '');
    this.#source.value = plain(values['network.source'] ?? '');
    this.#source.parentElement.hidden = !('network.source' in values);
    this.cluster.mark(plain(values[branch] ?? 'largest'));
    this.#showLength(values);
  }

  #showLength(values) {
    const { keyOf, page, scenes } = this.studio;
    const isUsed = prune in values;
    // Left out, it is what the rivers were pruned at.
    const value = values[prune] ?? String(scenes.now?.data.rivers.prune ?? 0);
    this.#length.least = isUsed && Number(value) < 1 ? 0 : 1;
    this.#lengths.hidden = !page || !isUsed;
    if (!this.#length.isDrawn) {
      page?.bindLength(isUsed ? this.#length : null, isUsed ? Number(plain(value)) : undefined);
    }
    const standard = isStandard(keyOf(prune) ?? { type: '', standard: '' }, value) ? ', the default' : '';
    byId('L').title = isUsed ? `${prune}${standard}` : '';
  }

  /** The length of rivers that stay as they are while they are looked at. */
  bindFixedLength(value) {
    this.studio.page.bindLength({ least: this.#length.least, changing() {}, changed() {} }, value);
  }
}
