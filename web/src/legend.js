// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the colours of the land and the widths of its rivers stand for.
import { css, orderColours, riverStyle } from './colours.js';
import { make } from './elements.js';

/** The lines of each order up to the highest; by: 'hack' or 'strahler' where orders have colours of their own. */
function ordersOf(rivers, highest, by) {
  const isHack = by === 'hack';
  const most = isHack ? Math.min(orderColours.length, Math.max(...rivers.arcs.hack)) : highest;
  const row = make('div', { className: 'orders' }, isHack ? 'Hack order ' : 'Strahler order ');
  for (let order = 1; order <= most; ++order) {
    const { width, colour } = riverStyle(isHack ? most - order + 1 : order, most);
    const line = make('i', { className: 'river' });
    line.style.height = `${Math.max(2, width)}px`;
    line.style.background = css(by ? orderColours[Math.min(order, orderColours.length) - 1] : colour);
    row.append(make('span', {}, line, String(order)));
  }
  return row;
}

function rampOf({ ramp, from, to }) {
  const bar = make('i');
  bar.style.background = `linear-gradient(to right, ${ramp.map(css).join(', ')})`;
  const row = make('div', { className: 'ramp' });
  row.append(from, bar, to);
  return row;
}

function classesOf(entries) {
  const items = entries.map(([name, colour]) => {
    const square = make('i');
    square.style.background = css(colour);
    return make('span', {}, square, name);
  });
  return make('div', { className: 'classes' }, ...items);
}

/** shown: the legend of what is painted (colours.js), or null. */
export function showLegend(box, { land, rivers, highest, by, shown }) {
  const entries = [];
  if (rivers.count && highest) entries.push(ordersOf(rivers, highest, by));
  if (shown?.ramp && land.max > land.min && !land.level) entries.push(rampOf(shown));
  if (shown?.entries) entries.push(classesOf(shown.entries));
  box.replaceChildren(...entries);
}
