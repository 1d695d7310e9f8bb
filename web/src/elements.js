// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Elements of the page: those that are there, and those that it is made of.

/** @param {string} id of an element of report.html */
export const byId = (id) => /** @type {HTMLElement} */ (document.getElementById(id));

/** @param {string} id */
export const inputById = (id) => /** @type {HTMLInputElement} */ (byId(id));

/** @param {string} id */
export const selectById = (id) => /** @type {HTMLSelectElement} */ (byId(id));

/** Tells something in the middle of the view; '': it is gone. */
export function tellAll(words) {
  byId('message').textContent = words;
  byId('message').hidden = words === '';
}

/**
 * An element with properties of its own and with children, of which those that are false, null or '' are left out.
 * @template {keyof HTMLElementTagNameMap} Tag
 * @param {Tag} tag
 * @param {Record<string, any>} properties
 * @param {any[]} children
 * @returns {HTMLElementTagNameMap[Tag]}
 */
export function make(tag, properties = {}, ...children) {
  const e = Object.assign(document.createElement(tag), properties);
  e.append(...children.filter((child) => child || child === 0));
  return e;
}

/** A button that does something when it is clicked. */
export function button(textContent, title, click) {
  const element = make('button', { type: 'button', textContent, title });
  element.addEventListener('click', click);
  return element;
}

/** An element of SVG: its attributes, then text or elements in it. */
export function draw(name, attributes = {}, ...children) {
  const e = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [key, value] of Object.entries(attributes)) e.setAttribute(key, value);
  e.append(...children);
  return e;
}

export function section(title, ...children) {
  const body = children.filter(Boolean);
  return body.length ? make('section', {}, make('h2', { textContent: title }), ...body) : null;
}

/** What opens on demand; null if there is nothing to open. */
export function fold(head, ...children) {
  const body = children.filter(Boolean);
  return body.length ? make('details', {}, make('summary', {}, head), ...body) : null;
}

/** rows: [[cell, …], …]; the first cell of a row names it; all are text or nodes. */
export function table(heads, rows, label) {
  const head = make(
    'tr',
    {},
    ...heads.map((text, i) => make(text ? 'th' : 'td', { className: i ? 'n' : '', textContent: text })),
  );
  for (const th of head.querySelectorAll('th')) th.scope = 'col';
  const body = rows.map(([name, ...cells]) =>
    make('tr', {}, make('th', { scope: 'row' }, name), ...cells.map((cell) => make('td', { className: 'n' }, cell))),
  );
  const t = make('table', {}, make('thead', {}, head), make('tbody', {}, ...body));
  t.setAttribute('aria-label', label);
  return t;
}

/** A sign that stands for words. */
export function sign(text, words, className) {
  const mark = make('span', { className, textContent: text, title: words });
  mark.setAttribute('role', 'img');
  mark.setAttribute('aria-label', words);
  return mark;
}

/** Which mark is whose: [[name, mark], …]. */
export function legend(marks, { wide = false } = {}) {
  const box = wide ? { class: 'mark wide', viewBox: '-12 -6 24 12' } : { class: 'mark', viewBox: '-6 -6 12 12' };
  return make(
    'p',
    { className: 'marks' },
    ...marks.map(([name, mark]) => make('span', {}, draw('svg', { ...box, 'aria-hidden': 'true' }, mark), name)),
  );
}

/** The marks of series, no two of the same form: a filled circle, a ring, a diamond. */
export function symbol(k, x = 0, y = 0) {
  if (k < 2) return draw('circle', { class: `s${k}`, cx: x, cy: y, r: k ? 3.4 : 4 });
  return draw('path', { class: `s${k}`, d: `M${x} ${y - 4.6}l4.6 4.6-4.6 4.6-4.6-4.6Z` });
}

/** The marks of what values are compared with. */
export function rung(k) {
  return draw('path', { class: `rung s${k}`, d: k > 1 ? 'M0-6V6M-2.5-6h5M-2.5 6h5' : 'M0-6V6' });
}

/** Lets the reader save something: a Blob, under a name made of a title. */
export function save(blob, title, ending) {
  const name = title.replace(/[^\p{L}\p{N}]+/gu, '-').replace(/^-|-$/g, '') || 'thalweg';
  const link = make('a', { href: URL.createObjectURL(blob), download: `${name}.${ending}` });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

export function copyable(text, label) {
  const copy = make('button', { type: 'button', textContent: 'Copy' });
  copy.setAttribute('aria-label', `Copy ${label}`);
  const box = make('pre', { textContent: text, tabIndex: 0 });
  box.setAttribute('aria-label', label);
  box.setAttribute('role', 'region');
  copy.addEventListener('click', async () => {
    try {
      await navigator.clipboard.writeText(text);
      copy.textContent = 'Copied';
    } catch { // a page from a file may not write to the clipboard
      getSelection().selectAllChildren(box);
      copy.textContent = 'Selected';
    }
    setTimeout(() => (copy.textContent = 'Copy'), 1500);
  });
  return make('div', { className: 'copy' }, copy, box);
}
