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

/**
 * A field of a key. path: the key's in this recipe ("patch.2.rotate"); act: {trying(path, value), set(path, value),
 * unset(path)}, the last two give promises. Gives {element, show(value or undefined)}.
 */
export function field(key, path, act) {
  const id = `key${++count}`;
  const name = path.split('.').at(-1);
  const title = `${path}: ${limits(key)}`;
  const refused = make('p', { className: 'refused', hidden: true, id: `${id}e` });
  refused.setAttribute('role', 'alert');
  const back = make('button', {
    type: 'button',
    className: 'back',
    textContent: '↺',
    title: `Back to the default${key.standard ? ` (${plain(key.standard)})` : ''}`,
  });
  back.setAttribute('aria-label', `${name}: back to the default`);
  const label = make(
    'label',
    { htmlFor: id },
    name.replace(/_/g, ' '),
    key.unit && make('small', { textContent: ` ${key.unit}` }),
  );
  const control = make('span', { className: 'control' });
  const element = make('div', { className: 'key' }, label, control, back, refused);
  element.dataset.path = path;
  let shown;
  let write;
  const say = (error) => {
    refused.textContent = error?.message ?? '';
    refused.hidden = !error;
  };
  const settle = async (promise) => {
    say(null);
    try {
      await promise;
    } catch (error) {
      say(error);
      show(shown);
    }
  };
  const set = (value) => {
    if (value === shown) return;
    if (value === '' && key.type !== 'text') settle(act.unset(path));
    else settle(act.set(path, value));
  };
  const input = (properties) =>
    Object.assign(make('input', { id, title, autocomplete: 'off', spellcheck: false }), properties);

  if (key.type === 'yes/no') {
    const box = input({ type: 'checkbox' });
    box.addEventListener('change', () => set(String(box.checked)));
    write = (value) => (box.checked = (value || plain(key.standard)) === 'true');
    control.append(box);
  } else if (closed(key)) {
    const list = make('select', { id, title });
    list.addEventListener('change', () => set(list.value));
    write = (value) => {
      list.replaceChildren(
        ...[...(key.choices.includes(value) ? [] : [value]), ...key.choices].map((v) =>
          make('option', { value: v, textContent: v === '' ? '–' : v }),
        ),
      );
      list.value = value;
    };
    control.append(list);
  } else if (key.type.split(' ')[0] in lists) {
    const fields = Array.from({ length: lists[key.type.split(' ')[0]] }, (_, i) => {
      const one = input({ type: 'number', step: 'any', id: i ? '' : id });
      one.setAttribute('aria-label', `${name.replace(/_/g, ' ')}, ${i + 1}`);
      return one;
    });
    for (const one of fields) {
      one.addEventListener('change', () => {
        const all = fields.map((f) => f.value);
        if (all.every((v) => v !== '')) set(`[${all.join(', ')}]`);
        else if (all.every((v) => v === '')) set('');
      });
    }
    write = (value) => fields.forEach((f, i) => (f.value = parts(value)[i] ?? ''));
    control.append(...fields);
  } else {
    const figure = /^(integer|number)$/.test(key.type);
    const text = input(figure ? { type: 'number', step: 'any' } : { type: 'text' });
    text.placeholder = key.is_file ? 'no file' : figure ? plain(key.standard).split(' ')[0] || 'left out' : '';
    text.addEventListener('change', () => set(text.value.trim()));
    text.addEventListener(
      'keydown',
      (event) => event.key === 'Escape' && (write(plain(shown)), event.stopPropagation()),
    );
    const walk = scale(key);
    if (walk) control.append(slider(walk, text, `${name.replace(/_/g, ' ')}, slider`));
    write = (value) => {
      text.value = value;
      text.dispatchEvent(new Event('shown'));
    };
    if (key.choices.length) {
      const list = make('datalist', { id: `${id}l` }, ...key.choices.map((value) => make('option', { value })));
      text.setAttribute('list', list.id);
      control.append(list);
    }
    control.append(text);
  }
  control.classList.toggle('wide', control.childElementCount > 1 || /^text/.test(key.type));

  /** A slider beside a field: it tries while it is drawn, and sets when it is let go. */
  function slider(walk, text, words) {
    const range = make('input', { type: 'range', min: 0, max: 1000, step: 1, title });
    range.setAttribute('aria-label', words);
    let drawn = false;
    range.addEventListener('input', () => {
      drawn = true;
      text.value = String(walk.toValue(Number(range.value)));
      range.setAttribute('aria-valuetext', text.value);
      act.trying(path, text.value);
    });
    range.addEventListener('change', () => {
      drawn = false;
      if (text.value === shown) undrawn();
      else set(text.value);
    });
    // Drawn away and back again is no change.
    const undrawn = () => {
      drawn = false;
      act.trying(path, shown);
      show(shown);
    };
    const letGo = () => setTimeout(() => drawn && undrawn());
    range.addEventListener('pointerup', letGo);
    range.addEventListener('blur', letGo);
    text.addEventListener('shown', () => {
      if (drawn) return;
      const value = text.value === '' ? Number(text.placeholder) || 0 : Number(text.value);
      range.value = walk.toPlace(value);
      range.setAttribute('aria-valuetext', text.value || 'default');
    });
    return range;
  }

  back.addEventListener('click', () => settle(act.unset(path)));
  /** value: as it stands in the recipe; null where the key is left out, undefined where it has no effect. */
  function show(value) {
    shown = plain(value);
    write(shown);
    const changed = shown !== '' && !isStandard(key, value);
    element.classList.toggle('changed', changed);
    back.style.visibility = changed ? '' : 'hidden';
  }
  return {
    element, path, key,
    show(value) {
      if (plain(value) !== shown) say(null); // a refusal stays until the key is another
      show(value);
    },
    get changed() {
      return element.classList.contains('changed');
    },
  };
}
