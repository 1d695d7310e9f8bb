// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The recipe as folded sections of fields, those in use first, with a filter and a line of help.
import { make } from './elements.js';
import { field, limits } from './fields.js';

const titles = {
  grid: 'Grid',
  network: 'Rivers',
  'network.dla': 'Rivers: DLA cluster',
  'network.tokunaga': 'Rivers: Tokunaga tree',
  'network.forest': 'Rivers: forest from the coast',
  'network.lines': 'Rivers: lines of a file',
  skeleton: 'Ridges and points',
  surface: 'Surface',
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

/**
 * keys: of @@STUDIO@@. act: {trying(path, value), set(path, value), unset(path)}; leave: paths that have their places
 * elsewhere. Gives {element, show(document)}.
 */
export function recipeForm(keys, act, leave) {
  const byPath = new Map(keys.map((key) => [key.path, key]));
  const sections = new Map();
  let values = {};
  const search = make('input', { type: 'search', id: 'find-key', placeholder: 'Find a key', autocomplete: 'off' });
  search.setAttribute('aria-label', 'Find a key');
  const used = make('div');
  const unused = make('div');
  const rest = make('details', { className: 'unused' }, make('summary', { textContent: 'Not in this recipe' }), unused);
  const nothing = make('p', {
    className: 'hint',
    textContent: 'No key has this in its name or meaning.',
    hidden: true,
  });
  const help = make('div', { id: 'key-help' });
  const element = make(
    'section',
    { id: 'keys-form' },
    make('h2', { textContent: 'Recipe' }),
    search,
    nothing,
    used,
    rest,
    help,
  );
  element.setAttribute('aria-label', 'Recipe');

  function describe(path) {
    const key = byPath.get(keyOf(path));
    if (!key || help.dataset.path === path) return;
    help.dataset.path = path;
    help.replaceChildren(
      make('b', { textContent: path }),
      ` ${key.meaning}${key.unit ? ` [${key.unit}]` : ''}`,
      make('small', {
        textContent: [limits(key), key.used_by && !(path in values) && `needs ${key.used_by}`]
          .filter(Boolean)
          .join('; '),
      }),
    );
  }
  for (const kind of ['focusin', 'pointerover']) {
    element.addEventListener(kind, ({ target }) => {
      const at = target.closest('.key');
      if (at) describe(at.dataset.path);
    });
  }

  function section(name) {
    if (sections.has(name)) return sections.get(name);
    const number = /\.\d+$/.exec(name)?.[0] ?? '';
    const fields = keys
      .filter((key) => sectionOf(key.path) === name.slice(0, name.length - number.length) && !leave.includes(key.path))
      .map((key) => field(key, number ? `${name}.${key.path.split('.').at(-1)}` : key.path, act));
    for (const { element: e } of fields) {
      for (const c of e.querySelectorAll('input, select')) c.setAttribute('aria-describedby', help.id);
    }
    const set = make('div');
    const more = make('details', { className: 'more-keys' }, make('summary', { textContent: 'Without effect now' }));
    const remove = make('button', { type: 'button', className: 'remove', textContent: `Take “${titleOf(name)}” out` });
    const refused = make('p', { className: 'refused', hidden: true });
    refused.setAttribute('role', 'alert');
    remove.addEventListener('click', async () => {
      refused.hidden = true;
      await act.unset(name).catch((error) => Object.assign(refused, { textContent: error.message, hidden: false }));
    });
    const many = make('small', { className: 'many' });
    const whole = make(
      'details',
      { className: 'keys-section' },
      make('summary', {}, titleOf(name), many),
      set,
      more,
      remove,
      refused,
    );
    const made = { name, fields, set, more, remove, many, whole };
    sections.set(name, made);
    return made;
  }

  /** Puts children in an order, touching none that are in place: moving one would take its focus. */
  function order(parent, children) {
    children.forEach(
      (child, i) => parent.children[i] !== child && parent.insertBefore(child, parent.children[i] ?? null),
    );
    while (parent.children.length > children.length) parent.lastElementChild.remove();
  }

  function show({ values: given, sections: now }) {
    values = given;
    const all = [...new Set(keys.map((key) => sectionOf(key.path)))].filter(Boolean);
    const inUse = all.flatMap((name) =>
      now.filter((one) => one === name || (one.startsWith(`${name}.`) && /^\d+$/.test(one.slice(name.length + 1)))),
    );
    for (const name of now) if (!inUse.includes(name) && name) inUse.push(name);
    // Of numbered sections another may be added.
    const others = all.flatMap((name) => {
      const numbers = inUse
        .filter((one) => one !== name && keyOf(`${one}.`) === `${name}.`)
        .map((one) => Number(one.slice(name.length + 1)));
      return inUse.includes(name) ? [] : numbers.length ? [`${name}.${Math.max(...numbers) + 1}`] : [name];
    });
    for (const name of [...inUse, ...others]) {
      const { fields, set, more, remove, many } = section(name);
      const isUsed = inUse.includes(name);
      const effective = isUsed ? fields.filter((f) => values[f.path] !== undefined) : fields;
      const idle = fields.filter((f) => !effective.includes(f));
      order(set, effective.map((f) => f.element));
      const list = [more.firstElementChild, ...idle.map((f) => f.element)];
      order(more, list);
      more.hidden = idle.length === 0;
      for (const f of fields) f.show(values[f.path]);
      const changed = fields.filter((f) => f.changed).length;
      many.textContent = isUsed && changed ? ` ${changed} changed` : '';
      remove.hidden = !isUsed || ['grid', 'network', 'surface', 'output'].includes(name) || name.startsWith('network.');
    }
    order(used, inUse.map((name) => sections.get(name).whole));
    order(unused, others.map((name) => sections.get(name).whole));
    rest.hidden = others.length === 0;
    for (const name of [...sections.keys()]) if (!inUse.includes(name) && !others.includes(name)) sections.delete(name);
    find();
  }

  let open = null; // what was unfolded before something was sought
  function find() {
    const words = search.value.trim().toLowerCase().split(/\s+/).filter(Boolean);
    const folds = [...element.querySelectorAll('details')];
    if (words.length && !open) open = new Set(folds.filter((d) => d.open));
    let found = 0;
    for (const { fields, whole, more, remove } of sections.values()) {
      let here = 0;
      for (const { element: e, path, key } of fields) {
        // Anywhere in the path, at the beginning of words of the meaning.
        const name = `${path} ${path.replaceAll('_', ' ')}`.toLowerCase();
        const meaning = ` ${key.meaning.toLowerCase().replace(/[^\p{L}\p{N}]+/gu, ' ')}`;
        const hit = words.every((word) => name.includes(word) || meaning.includes(` ${word}`));
        e.hidden = !hit;
        here += hit;
      }
      whole.hidden = words.length > 0 && here === 0;
      if (words.length) {
        whole.open = here > 0;
        more.open = [...more.querySelectorAll('.key')].some((e) => !e.hidden);
      }
      remove.classList.toggle('away', words.length > 0);
      found += here;
    }
    if (words.length) rest.open = [...unused.children].some((e) => !e.hidden);
    rest.classList.toggle('away', words.length > 0 && !rest.open);
    nothing.hidden = found > 0;
    if (!words.length && open) {
      for (const d of folds) d.open = open.has(d);
      open = null;
    }
  }
  search.addEventListener('input', find);
  search.addEventListener('keydown', (event) => {
    if (event.key !== 'Escape' || search.value === '') return;
    search.value = '';
    find();
  });
  return { element, show };
}
