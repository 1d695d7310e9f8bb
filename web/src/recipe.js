// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The recipe as folded sections of fields, those in use first, with a filter and a line of help.
import { make } from './elements.js';
import { Field, limits } from './fields.js';

const titles = {
  grid: 'Grid',
  network: 'Rivers',
  'network.dla': 'Rivers: DLA cluster',
  'network.tokunaga': 'Rivers: Tokunaga tree',
  'network.forest': 'Rivers: forest from the coast',
  'network.lines': 'Rivers: lines of a file',
  skeleton: 'Ridges and points',
  surface: 'Surface',
  strata: 'How layers of rock lie',
  layer: 'Layer of rock',
  statistics: 'Statistics',
  detail: 'Detail',
  output: 'Output',
};

function titleOf(section) {
  const [, base, number] = /^([^0-9]*?)(?:\.(\d+))?$/.exec(section);
  const name = titles[base] ?? base.replace(/^./, (c) => c.toUpperCase()).replaceAll('.', ': ');
  return number ? `${name} ${number}` : name;
}

const sectionOf = (path) => path.split('.').slice(0, -1).join('.');
/** "patch.2.rotate" is the key "patch.rotate". */
const keyOf = (path) => path.replace(/\.\d+(?=\.)/g, '');

/** Puts children in an order, touching none that are in place: moving one would take its focus. */
function order(parent, children) {
  children.forEach(
    (child, i) => parent.children[i] !== child && parent.insertBefore(child, parent.children[i] ?? null),
  );
  while (parent.children.length > children.length) parent.lastElementChild.remove();
}

/** A folded section and its fields. */
class Section {
  #effective = make('div');
  #idle = make('details', { className: 'more-keys' }, make('summary', { textContent: 'Without effect now' }));
  #count = make('small', { className: 'many' });
  #remove;
  #refused;

  /** fields: of fields.js; unset(path): takes the section out of the recipe, gives a promise. */
  constructor(name, fields, unset) {
    this.name = name;
    this.fields = fields;
    const textContent = `Take “${titleOf(name)}” out`;
    this.#remove = make('button', { type: 'button', className: 'remove', textContent });
    this.#remove.addEventListener('click', () => this.#takeOut(unset));
    this.#refused = make('p', { className: 'refused', hidden: true });
    this.#refused.setAttribute('role', 'alert');
    const head = make('summary', {}, titleOf(name), this.#count);
    const parts = [head, this.#effective, this.#idle, this.#remove, this.#refused];
    this.element = make('details', { className: 'keys-section' }, ...parts);
  }

  async #takeOut(unset) {
    this.#refused.hidden = true;
    try {
      await unset(this.name);
    } catch (error) {
      Object.assign(this.#refused, { textContent: error.message, hidden: false });
    }
  }

  /** values: of the document; isUsed: the recipe has the section. */
  show(values, isUsed) {
    const { fields, name } = this;
    const effective = isUsed ? fields.filter((f) => values[f.path] !== undefined) : fields;
    const idle = fields.filter((f) => !effective.includes(f));
    order(this.#effective, effective.map((f) => f.element));
    order(this.#idle, [this.#idle.firstElementChild, ...idle.map((f) => f.element)]);
    this.#idle.hidden = idle.length === 0;
    for (const f of fields) f.show(values[f.path]);
    const changed = fields.filter((f) => f.changed).length;
    this.#count.textContent = isUsed && changed ? ` ${changed} changed` : '';
    const isNeeded = ['grid', 'network', 'surface', 'output'].includes(name) || name.startsWith('network.');
    this.#remove.hidden = !isUsed || isNeeded;
  }

  /** Shows the fields that all words are found in, and gives how many they are. */
  find(words) {
    let found = 0;
    for (const { element, path, key } of this.fields) {
      // Anywhere in the path, at the beginning of words of the meaning.
      const name = `${path} ${path.replaceAll('_', ' ')}`.toLowerCase();
      const meaning = ` ${key.meaning.toLowerCase().replace(/[^\p{L}\p{N}]+/gu, ' ')}`;
      const isHit = words.every((word) => name.includes(word) || meaning.includes(` ${word}`));
      element.hidden = !isHit;
      if (isHit) ++found;
    }
    this.element.hidden = words.length > 0 && found === 0;
    if (words.length) {
      this.element.open = found > 0;
      this.#idle.open = this.#idle.querySelector('.key:not([hidden])') !== null;
    }
    this.#remove.classList.toggle('away', words.length > 0);
    return found;
  }
}

/** The names of a recipe's sections, and of those that it may have besides. paths: of all keys; now: of the recipe. */
function sectionsOf(paths, now) {
  const all = [...new Set(paths.map(sectionOf))].filter(Boolean);
  const used = all.flatMap((name) =>
    now.filter((one) => one === name || (one.startsWith(`${name}.`) && /^\d+$/.test(one.slice(name.length + 1)))),
  );
  for (const name of now) if (!used.includes(name) && name) used.push(name);
  // Of numbered sections another may be added.
  const unused = all.flatMap((name) => {
    const numbers = used
      .filter((one) => one !== name && keyOf(`${one}.`) === `${name}.`)
      .map((one) => Number(one.slice(name.length + 1)));
    if (used.includes(name)) return [];
    return numbers.length ? [`${name}.${Math.max(...numbers) + 1}`] : [name];
  });
  return { used, unused };
}

export class RecipeForm {
  #keys;
  #act;
  #leave;
  #sections = new Map(); // by name
  #values = {};
  #open = null; // what was unfolded before something was sought
  #search = make('input', { type: 'search', id: 'find-key', placeholder: 'Find a key', autocomplete: 'off' });
  #nothing = make('p', { className: 'hint', textContent: 'No key has this in its name or meaning.', hidden: true });
  #used = make('div');
  #unused = make('div');
  #rest = make(
    'details', { className: 'unused' }, make('summary', { textContent: 'Not in this recipe' }), this.#unused,
  );
  #help = make('div', { id: 'key-help' });

  /**
   * keys: as the program gives them (README.md). act: {trying(path, value), set(path, value), unset(path)}; leave:
   * paths that have their places elsewhere.
   */
  constructor(keys, act, leave) {
    this.#keys = keys;
    this.#act = act;
    this.#leave = leave;
    const head = make('h2', { textContent: 'Recipe' });
    const parts = [head, this.#search, this.#nothing, this.#used, this.#rest, this.#help];
    this.element = make('section', { id: 'keys-form' }, ...parts);
    this.element.setAttribute('aria-label', 'Recipe');
    for (const kind of ['focusin', 'pointerover']) {
      this.element.addEventListener(kind, ({ target }) => {
        const at = /** @type {HTMLElement} */ (target).closest('.key');
        if (at) this.#describe(/** @type {HTMLElement} */ (at).dataset.path);
      });
    }
    this.#search.setAttribute('aria-label', 'Find a key');
    this.#search.addEventListener('input', () => this.#find());
    this.#search.addEventListener('keydown', (event) => {
      if (event.key !== 'Escape' || this.#search.value === '') return;
      this.#search.value = '';
      this.#find();
    });
  }

  /** The line of help tells of a key. */
  #describe(path) {
    const key = this.#keys.find((one) => one.path === keyOf(path));
    if (!key || this.#help.dataset.path === path) return;
    const needs = key.used_by && !(path in this.#values) && `needs ${key.used_by}`;
    this.#help.dataset.path = path;
    this.#help.replaceChildren(
      make('b', { textContent: path }),
      ` ${key.meaning}${key.unit ? ` [${key.unit}]` : ''}`,
      make('small', { textContent: [limits(key), needs].filter(Boolean).join('; ') }),
    );
  }

  #section(name) {
    const known = this.#sections.get(name);
    if (known) return known;
    const number = /\.\d+$/.exec(name)?.[0] ?? '';
    const base = name.slice(0, name.length - number.length);
    const fields = this.#keys
      .filter(({ path }) => sectionOf(path) === base && !this.#leave.includes(path))
      .map((key) => new Field(key, number ? `${name}.${key.path.split('.').at(-1)}` : key.path, this.#act));
    for (const { element } of fields) {
      for (const c of element.querySelectorAll('input, select')) c.setAttribute('aria-describedby', this.#help.id);
    }
    const made = new Section(name, fields, this.#act.unset);
    this.#sections.set(name, made);
    return made;
  }

  /** Shows a document. */
  show({ values, sections }) {
    this.#values = values;
    const { used, unused } = sectionsOf(this.#keys.map((key) => key.path), sections);
    for (const name of [...used, ...unused]) this.#section(name).show(values, used.includes(name));
    order(this.#used, used.map((name) => this.#section(name).element));
    order(this.#unused, unused.map((name) => this.#section(name).element));
    this.#rest.hidden = unused.length === 0;
    for (const name of [...this.#sections.keys()]) {
      if (!used.includes(name) && !unused.includes(name)) this.#sections.delete(name);
    }
    this.#find();
  }

  /** Shows what is sought; when nothing is any more, what was unfolded before. */
  #find() {
    const words = this.#search.value.trim().toLowerCase().split(/\s+/).filter(Boolean);
    const folds = [...this.element.querySelectorAll('details')];
    if (words.length && !this.#open) this.#open = new Set(folds.filter((d) => d.open));
    let found = 0;
    for (const section of this.#sections.values()) found += section.find(words);
    if (words.length) this.#rest.open = this.#unused.querySelector(':scope > :not([hidden])') !== null;
    this.#rest.classList.toggle('away', words.length > 0 && !this.#rest.open);
    this.#nothing.hidden = found > 0;
    if (!words.length && this.#open) {
      for (const d of folds) d.open = this.#open.has(d);
      this.#open = null;
    }
  }
}
