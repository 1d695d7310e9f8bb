// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the written part of the page is made of.

export function make(tag, properties = {}, ...children) {
  const e = Object.assign(document.createElement(tag), properties);
  e.append(...children.filter((child) => child !== null && child !== undefined && child !== ''));
  return e;
}

export function section(title, ...children) {
  const body = children.filter(Boolean);
  return body.length ? make('section', {}, make('h2', { textContent: title }), ...body) : null;
}

/** rows: [[cell, …], …]; the first cell of a row names it; cells after it are numbers unless they are nodes. */
export function table(heads, rows, label) {
  const head = make('tr', {}, ...heads.map((text, i) => make('th', { scope: 'col', textContent: text, className: i ? 'n' : '' })));
  const body = rows.map(([name, ...cells]) => make('tr', {}, make('th', { scope: 'row', textContent: name }),
    ...cells.map((cell) => (cell instanceof Node ? make('td', { className: 'n' }, cell) : make('td', { className: 'n', textContent: cell })))));
  const t = make('table', {}, make('thead', {}, head), make('tbody', {}, ...body));
  t.setAttribute('aria-label', label);
  return t;
}
