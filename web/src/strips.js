// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Tables whose rows are small plots: where values lie against a range, and bars.
import { number } from './chart.js';
import { draw, make, rung, symbol } from './elements.js';

/** Ranges of rows stand under each other, between these shares of a strip's width. */
const [begin, end] = [0.3, 0.7];
const percent = (share) => `${(100 * share).toFixed(2)}%`;

/** Where a value lies: [0, 1], and on which side it is beyond the strip. A wide range is logarithmic. */
function scaleOf([low, high]) {
  const log = low > 0 && high / low > 20;
  const up = log ? Math.log10 : (v) => v;
  const span = up(high) - up(low);
  return (v) => {
    const within = span > 0 ? (v > 0 || !log ? (up(v) - up(low)) / span : -Infinity) : 0.5 + Math.sign(v - low);
    const share = begin + within * (end - begin);
    return { share: Math.min(0.97, Math.max(0.03, share)), beyond: share > 1 ? 1 : share < 0 ? -1 : 0 };
  };
}

/** Something drawn in pixels at a share of the width. */
const at = (share, ...children) => draw('svg', { x: percent(share), y: '50%', overflow: 'visible' }, ...children);

/**
 * The plot of a row: {range: [low, high] | null, dots: [number | null, …] marks of series, ticks: likewise, of what
 * they are compared with}. Without a range the strip reaches from 0, or from the least value below it, to the largest.
 */
function strip({ range, dots, ticks = [] }, words) {
  const known = [...dots, ...ticks].filter((v) => Number.isFinite(v));
  const place = scaleOf(range ?? [Math.min(0, ...known), Math.max(0, ...known)]);
  const shown = (values) =>
    values
      .map((v, k) => [v, k])
      .filter(([v]) => Number.isFinite(v))
      .map(([v, k]) => [place(v), k]);
  const svg = draw('svg', { class: 'strip', width: '100%', height: 18, role: 'img', 'aria-label': words },
    draw('line', { class: 'axis', x1: 0, x2: '100%', y1: '50%', y2: '50%' }));
  if (range) {
    svg.append(draw('rect', { class: 'band', x: percent(begin), width: percent(end - begin), y: 1, height: 16 }));
  }
  for (const [{ share }, k] of shown(ticks)) svg.append(at(share, rung(k + 1)));
  for (const [{ share, beyond }, k] of shown(dots).reverse()) {
    svg.append(
      at(
        share,
        beyond
          ? draw('path', { class: `beyond s${k}`, d: `M${(5 - 10 * k) * beyond} 0l${-8 * beyond}-5v10Z` })
          : symbol(k),
      ),
    );
  }
  return svg;
}

/** rows: [{name, range, dots, ticks, words (for who does not see the plot), cells: [text or node, …]}]. */
export function strips(heads, rows, label) {
  return grid(heads, rows.map((row) => [row.name, strip(row, row.words), ...row.cells]), label);
}

/** rows: [{name, values, cells}]: bars of each value, one below the other, against the largest of all. */
export function bars(heads, rows, label) {
  const most = Math.max(...rows.flatMap((row) => row.values), 1e-12);
  const thick = rows[0].values.length > 1 ? 4 : 8;
  return grid(
    heads,
    rows.map((row) => [
      row.name,
      draw(
        'svg',
        {
          class: 'bars',
          width: '100%',
          height: row.values.length * (thick + 1),
          role: 'img',
          'aria-label': row.values.map((v) => number(v, 3)).join(', '),
        },
        ...row.values.map((v, k) =>
          draw('rect', {
            class: `bar s${k}`,
            y: k * (thick + 1),
            height: thick,
            width: percent(Math.max(0, v / most)),
          }),
        ),
      ),
      ...row.cells,
    ]),
    label,
  );
}

function grid(heads, rows, label) {
  const cell = (content, i) => make('td', { className: i ? 'n' : 'drawn' }, content);
  const t = make(
    'table',
    { className: 'strips' },
    make(
      'thead',
      {},
      make(
        'tr',
        {},
        ...heads.map((head, i) =>
          head ? make('th', { scope: 'col', className: i > 1 ? 'n' : '' }, head) : make('td', { className: 'sign' }),
        ),
      ),
    ),
    make(
      'tbody',
      {},
      ...rows.map(([name, ...cells]) => make('tr', {}, make('th', { scope: 'row' }, name), ...cells.map(cell))),
    ),
  );
  t.setAttribute('aria-label', label);
  return t;
}
