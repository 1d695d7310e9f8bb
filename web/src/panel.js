// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The panel: whether the terrain is right, what became of a file's rivers, diagrams, and how it was made.
import './panel.css';
import { against } from './against.js';
import { chart, number } from './chart.js';
import { copyable, fold, make, section, table } from './elements.js';
import { laws } from './laws.js';
import { ledger } from './ledger.js';
import { profiles } from './profile.js';
import { relief } from './relief.js';
import { bars } from './strips.js';
import { listed, verdict } from './verdict.js';

function hypsometry(curve, statistics) {
  if (!curve) return null;
  const facts = ['highest', 'mean', 'lowest'].map((name) => [name, statistics.find((s) => s.name === `${name} height`)])
    .filter(([, found]) => found).map(([name, { got, unit }]) => [name, `${number(got, 4)}\u00a0${unit}`]);
  return make(
    'div',
    { className: 'beside' },
    chart([{ points: curve.points.map(([a, z]) => [100 * a, z]), kind: 'area', name: 'height' }], {
      title: 'Share of the land above a height',
      x: 'area above [%]',
      y: 'height [m]',
      zeroX: true,
      small: true,
      height: 130,
    }),
    make(
      'dl',
      {},
      ...[['integral', number(curve.integral, 3)], ...facts].flatMap(([name, value]) => [
        make('dt', { textContent: name }),
        make('dd', { textContent: value }),
      ]),
    ),
  );
}

function increments(curve) {
  if (!curve) return null;
  const what = { x: 'distance [cells]', zeroX: true, zeroY: true, small: true, height: 130 };
  return make(
    'div',
    { className: 'plots small' },
    chart([{ points: curve.points.map(([x, dh]) => [x, dh]), name: 'Δh', kind: 'line' }], {
      ...what,
      title: `Increment “${curve.name}”`,
      y: 'Δh [m]',
    }),
    chart([{ points: [[0, 0], ...curve.points.map(([x, , H]) => [x, H])], name: 'H', kind: 'area' }], {
      ...what,
      title: 'Height above the valley',
      y: 'H [m]',
    }),
  );
}

function statistics(all) {
  const asked = all.filter((s) => s.asked !== null);
  const rest = all.filter((s) => s.asked === null);
  return [
    asked.length &&
      table(
        ['', 'target', 'result', 'unit'],
        asked.map((s) => [s.name, number(s.asked, 5), number(s.got, 5), s.unit]),
        'Statistics, target and result',
      ),
    rest.length &&
      fold(
        `${rest.length} ${asked.length ? 'more ' : ''}figures`,
        table(
          ['figure', 'result', 'unit'],
          rest.map((s) => [s.name, number(s.got, 5), s.unit]),
          'Statistics',
        ),
      ),
  ];
}

function times(timings) {
  if (!timings.length) return null;
  const whole = timings.reduce((sum, [, s]) => sum + s, 0);
  return fold(
    `Time: ${number(whole, 3)} s in ${timings.length} stages`,
    bars(
      ['stage', 'share', 'seconds'],
      timings.map(([name, s]) => ({ name, values: [s], cells: [s.toFixed(2)] })),
      'Time by stage',
    ),
  );
}

/**
 * Fills the panel's parts. actions: flyTo(x, y), point(x, y) and unpoint() of a marker on the land; places in cells.
 * Gives {hover(x, y, arc)}: the pointer on the land, arc -1 for none.
 */
export function fillPanel(parts, data, actions) {
  for (const part of Object.values(parts)) part.classList.add('report');
  verdict(parts.verdict, data, actions);
  ledger(parts.ledger, data);
  const profile = profiles(data, actions);
  parts.sections.append(
    ...[
      section('Compared with a real DEM', ...against(data.against)),
      profile.element,
      section('Hypsometry', hypsometry(data.hypsometry, data.statistics)),
      section('Increment', increments(data.curve)),
      section('Network laws', ...laws(data.laws)),
      section('Relief beside reference DEMs', ...relief(data.relief)),
      section('Targets and results', ...statistics(data.statistics)),
      section(
        'Make it again',
        copyable(data.command, 'the command'),
        data.recipe && fold('recipe.toml', copyable(data.recipe, 'the recipe')),
        times(data.timings),
        listed('finding', data.findings, actions),
        listed('repair', data.repairs, actions),
      ),
      section(
        'Notes',
        data.notes.length ? make('ul', {}, ...data.notes.map((text) => make('li', { textContent: text }))) : null,
      ),
    ].filter(Boolean),
  );
  return { hover: profile.hover };
}

/** A height with as many digits as tell heights of this land apart. */
export function metres(z, { min, max }) {
  return number(max - min >= 50 ? Math.round(z) : z, 5);
}

/** One line under the title. */
export function summary(data, rivers) {
  const { grid, heights } = data;
  const km = (cells) => number((cells * grid.cell_m) / 1000, 3);
  return [
    `${number(grid.width, 7)} × ${number(grid.height, 7)} cells of ${number(grid.cell_m)} m ` +
      `(${km(grid.width)} × ${km(grid.height)} km)`,
    grid.crs_name || (grid.crs ? (grid.crs.length < 24 ? grid.crs : 'own CRS') : 'no CRS'),
    rivers.count ? `${number(rivers.count)} arcs to order ${rivers.highest}` : 'no rivers',
    heights ? `${metres(heights.min, heights)} to ${metres(heights.max, heights)} m` : 'no surface',
  ].join(' · ');
}
