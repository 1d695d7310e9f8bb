// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What became of the lines of a file.
import { number } from './chart.js';
import { draw, fold, make, table } from './elements.js';

const percent = (share) => `${number(share > 0.99 ? Math.floor(1000 * share) / 10 : 100 * share, 3)}\u00a0%`;

/**
 * Where the length of rivers went: [{name, length}], the network first, then what was left out, the longest first;
 * coastlines are none.
 */
export function parts(given) {
  const begin = 'left out: ';
  const left = given
    .filter(([name]) => name.startsWith(begin) && !name.endsWith('coastlines'))
    .map(([name, length]) => ({ name: name.slice(begin.length), length }));
  return [
    { name: 'in the network', length: given.find(([name]) => name === 'in the network')?.[1] ?? 0 },
    ...left.sort((a, b) => b.length - a.length),
  ];
}

export function ledger(parent, { given }) {
  const value = (name) => given.find(([other]) => other === name);
  if (!value('read')) return;
  const all = parts(given);
  const whole = all.reduce((sum, { length }) => sum + length, 0) || 1;
  const coast = value('left out: coastlines')?.[1] ?? 0;
  const words = ([name, amount, unit]) => `${name} ${number(amount, 3)}\u00a0${unit}`;
  const further = ['in artificial channels', 'reversed', 'outlets extended by', 'ends moved by up to'].map(value)
    .filter((row) => row?.[1] > 0).map(words);
  parent.append(
    make(
      'p',
      { className: 'line' },
      make('b', {
        textContent:
          `${number(value('read')[1] - coast, 4)}\u00a0km of rivers given` +
          (coast > 0 ? ` beside ${number(coast, 3)}\u00a0km of coastlines` : ''),
      }),
      `: ${percent(all[0].length / whole)} in the network${further.map((text) => `, ${text}`).join('')}`,
    ),
  );
  if (all.length > 1) {
    let from = 0;
    const bar = draw('svg', { class: 'ledger-bar', width: '100%', height: 12, 'aria-hidden': 'true' });
    all.forEach(({ length }, k) => {
      bar.append(
        draw('rect', {
          class: `p${Math.min(k, 4)}`,
          x: `${((100 * from) / whole).toFixed(3)}%`,
          width: `${((100 * length) / whole).toFixed(3)}%`,
          height: 12,
        }),
      );
      from += length;
    });
    const swatch = (k) =>
      draw(
        'svg',
        { class: 'mark', viewBox: '0 0 10 10', 'aria-hidden': 'true' },
        draw('rect', { class: `p${Math.min(k, 4)}`, width: 10, height: 10, rx: 2 }),
      );
    parent.append(bar, make('p', { className: 'marks' }, ...all.map(({ name, length }, k) =>
      make('span', {}, swatch(k), `${k === 1 ? 'left out: ' : ''}${name} ${number(length, 3)}\u00a0km`))));
  }
  parent.append(
    fold(
      'As a table',
      table(
        ['what', 'amount', 'unit'],
        given.map(([name, amount, unit]) => [name, number(amount, 4), unit]),
        'The given rivers',
      ),
    ),
  );
}
