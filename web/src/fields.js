// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Fields for the keys of a recipe: what a key's type, range and choices make of it.
import { make } from './elements.js';

/** A text without the quotes of TOML; numbers as short as they are. */
export function plain(text) {
  const bare = /^(['"])(.*)\1$/s.exec(text ?? '')?.[2] ?? text ?? '';
  return bare.trim() !== '' && Number.isFinite(Number(bare)) ? String(Number(bare)) : bare;
}

const lists = { two: 2, three: 3, four: 4 };
const parts = (text) => (text.match(/-?[\d.]+(?:e[-+]?\d+)?/gi) ?? []).map(Number);

/** Whether a value is the default, which may be in words, such as "20 for dla and forest, else 0". */
export function isStandard({ type, standard }, value) {
  const words = plain(standard);
  if (plain(value) === words) return true;
  if (type.split(' ')[0] in lists) return parts(words).slice(0, parts(value).length).join() === parts(value).join();
  return /^(integer|number)/.test(type) && / /.test(words) && parts(words).includes(Number(value));
}

const closed = ({ range, choices }) => choices.length > 0 && range.split(' | ').every((word) => choices.includes(word));

/** Positions 0 to 1000 of a slider, and the values there; null where a slider would be of no use. */
export function scale({ type, low, high, standard }) {
  if (!/^(integer|number)$/.test(type) || low === null || high === null || !(high > low)) return null;
  const whole = type === 'integer';
  const usual = Math.abs(Number(plain(standard))) || parts(plain(standard)).find((v) => v > 0) || 0;
  const linear = low < 0 || high / Math.max(low, whole ? 1 : usual ? usual / 10 : high / 1000) <= 1000;
  if (linear) {
    const rough = (high - low) / 200;
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = whole
      ? Math.max(1, Math.round(rough))
      : [1, 2, 5, 10].map((m) => m * power).find((s) => s >= rough * 0.999);
    return {
      toValue: (p) =>
        Number(Math.min(high, low + Math.round(((p / 1000) * (high - low)) / step) * step).toPrecision(6)),
      toPlace: (v) => (1000 * (v - low)) / (high - low),
    };
  }
  // Three decades about what is usual; the field takes what lies beyond.
  const from = Math.max(low, whole ? 1 : usual ? usual / 1000 : high / 1e6);
  const to = Math.min(high, usual ? usual * 1000 : high);
  const zero = low <= 0 ? 40 : 0; // places at the left end that stand for the lowest value
  const round = (v) => (whole ? Math.round(Number(v.toPrecision(2))) : Number(v.toPrecision(2)));
  return {
    toValue: (p) =>
      p < zero ? low : Math.min(high, Math.max(low, round(from * (to / from) ** ((p - zero) / (1000 - zero))))),
    toPlace: (v) =>
      v < from
        ? v > low
          ? zero
          : 0
        : Math.min(1000, zero + ((1000 - zero) * Math.log(v / from)) / Math.log(to / from)),
  };
}

/** What a key allows, in words. */
export function limits({ range, unit, standard }) {
  return [
    range && `${range}${unit ? ` ${unit}` : ''}`,
    standard === '' || standard === "''" ? '' : `default ${plain(standard)}`,
  ]
    .filter(Boolean)
    .join('; ');
}

let count = 0;

const wordsOf = (path) => path.split('.').at(-1).replace(/_/g, ' ');

// What the value of a key is edited by, one function a type: {nodes, write(value): shows it}. field: of the key;
// set(value): the reader has given it.

function checkbox(field, set) {
  const box = field.input({ type: 'checkbox' });
  box.addEventListener('change', () => set(String(box.checked)));
  return { nodes: [box], write: (value) => (box.checked = (value || plain(field.key.standard)) === 'true') };
}

function list({ id, key, title }, set) {
  const select = make('select', { id, title });
  select.addEventListener('change', () => set(select.value));
  const write = (value) => {
    const all = key.choices.includes(value) ? key.choices : [value, ...key.choices];
    select.replaceChildren(...all.map((v) => make('option', { value: v, textContent: v === '' ? '–' : v })));
    select.value = value;
  };
  return { nodes: [select], write };
}

/** Some numbers that are one value. */
function numbers(field, set) {
  const { id, key, path } = field;
  const fields = Array.from({ length: lists[key.type.split(' ')[0]] }, (_, i) => {
    const one = field.input({ type: 'number', step: 'any', id: i ? '' : id });
    one.setAttribute('aria-label', `${wordsOf(path)}, ${i + 1}`);
    return one;
  });
  for (const one of fields) {
    one.addEventListener('change', () => {
      const all = fields.map((f) => f.value);
      if (all.every((v) => v !== '')) set(`[${all.join(', ')}]`);
      else if (all.every((v) => v === '')) set('');
    });
  }
  return { nodes: fields, write: (value) => fields.forEach((f, i) => (f.value = parts(value)[i] ?? '')) };
}

/** A slider beside a field: it tries while it is drawn, and sets when it is let go. */
function slider(field, walk, text, set) {
  const { act, path, title } = field;
  const range = make('input', { type: 'range', min: 0, max: 1000, step: 1, title });
  range.setAttribute('aria-label', `${wordsOf(path)}, slider`);
  let isDrawn = false;
  range.addEventListener('input', () => {
    isDrawn = true;
    text.value = String(walk.toValue(Number(range.value)));
    range.setAttribute('aria-valuetext', text.value);
    act.trying(path, text.value);
  });
  // Drawn away and back again is no change.
  const putBack = () => {
    isDrawn = false;
    act.trying(path, field.shown);
    field.put(field.shown);
  };
  range.addEventListener('change', () => {
    isDrawn = false;
    if (text.value === field.shown) putBack();
    else set(text.value);
  });
  const letGo = () => setTimeout(() => isDrawn && putBack());
  range.addEventListener('pointerup', letGo);
  range.addEventListener('blur', letGo);
  const follow = () => {
    if (isDrawn) return;
    const value = text.value === '' ? Number(text.placeholder) || 0 : Number(text.value);
    range.value = String(walk.toPlace(value));
    range.setAttribute('aria-valuetext', text.value || 'default');
  };
  return { range, follow };
}

function text(field, set) {
  const { id, key } = field;
  const isNumber = /^(integer|number)$/.test(key.type);
  const box = field.input(isNumber ? { type: 'number', step: 'any' } : { type: 'text' });
  box.placeholder = key.is_file ? 'no file' : isNumber ? plain(key.standard).split(' ')[0] || 'left out' : '';
  const walk = scale(key);
  const { range, follow } = walk ? slider(field, walk, box, set) : { range: null, follow() {} };
  const write = (value) => {
    box.value = value;
    follow();
  };
  box.addEventListener('change', () => set(box.value.trim()));
  box.addEventListener('keydown', (event) => {
    if (event.key !== 'Escape') return;
    write(plain(field.shown));
    event.stopPropagation();
  });
  /** @type {HTMLElement[]} */
  const nodes = range ? [range] : [];
  if (key.choices.length) {
    const choices = make('datalist', { id: `${id}l` }, ...key.choices.map((value) => make('option', { value })));
    box.setAttribute('list', choices.id);
    nodes.push(choices);
  }
  return { nodes: [...nodes, box], write };
}

function controlOf({ type, range, choices }) {
  if (type === 'yes/no') return checkbox;
  if (closed({ range, choices })) return list;
  return type.split(' ')[0] in lists ? numbers : text;
}

/** A field of a key. */
export class Field {
  /** The value as it stands in the recipe, without quotes. */
  shown;
  #write;
  #back;
  #refused;

  /**
   * path: the key's in this recipe ("patch.2.rotate"); act: {trying(path, value), set(path, value), unset(path)}, the
   * last two give promises.
   */
  constructor(key, path, act) {
    this.key = key;
    this.path = path;
    this.act = act;
    this.id = `key${++count}`;
    this.title = `${path}: ${limits(key)}`;
    this.#refused = make('p', { className: 'refused', hidden: true, id: `${this.id}e` });
    this.#refused.setAttribute('role', 'alert');
    this.#back = this.#backButton();
    const unit = key.unit && make('small', { textContent: ` ${key.unit}` });
    const label = make('label', { htmlFor: this.id }, wordsOf(path), unit);
    const { nodes, write } = controlOf(key)(this, (value) => this.#set(value));
    this.#write = write;
    const control = make('span', { className: 'control' }, ...nodes);
    control.classList.toggle('wide', nodes.length > 1 || /^text/.test(key.type));
    this.element = make('div', { className: 'key' }, label, control, this.#back, this.#refused);
    this.element.dataset.path = path;
  }

  #backButton() {
    const { act, key, path } = this;
    const title = `Back to the default${key.standard ? ` (${plain(key.standard)})` : ''}`;
    const back = make('button', { type: 'button', className: 'back', textContent: '↺', title });
    back.setAttribute('aria-label', `${path.split('.').at(-1)}: back to the default`);
    back.addEventListener('click', () => this.#settle(act.unset(path)));
    return back;
  }

  /** An input of this field. */
  input(properties) {
    const { id, title } = this;
    return Object.assign(make('input', { id, title, autocomplete: 'off', spellcheck: false }), properties);
  }

  #say(error) {
    this.#refused.textContent = error?.message ?? '';
    this.#refused.hidden = !error;
  }

  /** What is refused is told beside the field, which shows the former value again. */
  async #settle(promise) {
    this.#say(null);
    try {
      await promise;
    } catch (error) {
      this.#say(error);
      this.put(this.shown);
    }
  }

  #set(value) {
    const { act, key, path } = this;
    if (value === this.shown) return;
    if (value === '' && key.type !== 'text') this.#settle(act.unset(path));
    else this.#settle(act.set(path, value));
  }

  /** Shows a value; value: as it stands in the recipe; null where the key is left out, undefined: without effect. */
  put(value) {
    this.shown = plain(value);
    this.#write(this.shown);
    const isChanged = this.shown !== '' && !isStandard(this.key, value);
    this.element.classList.toggle('changed', isChanged);
    this.#back.style.visibility = isChanged ? '' : 'hidden';
  }

  /** Shows the value of another document. */
  show(value) {
    if (plain(value) !== this.shown) this.#say(null); // a refusal stays until the key is another
    this.put(value);
  }

  /** Whether the value is not the default. */
  get changed() {
    return this.element.classList.contains('changed');
  }
}
