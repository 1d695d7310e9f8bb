// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The figures by which experts judge land, beside those of real land.
import { between, chart, number } from './chart.js';
import { fold, legend, make, rung, sign, symbol, table } from './elements.js';
import { bars, strips } from './strips.js';

/** @type {[string, RegExp][]} */
const groups = [['slopes', /^slope_(?!area)/], ['rivers', /^(theta|chi|density|slope_area|straight|perched)/],
  ['forms and summits', /^(hypso|peaks|pits|valleys|hollows|level|prominen|isolation|form)/], ['texture', /./]];
const judged = (f) => f.range && f.value !== null;
const verdict = (f) =>
  judged(f)
    ? sign(
        f.in_range ? '✓' : '✗',
        `${f.in_range ? 'within' : 'outside'} ${between(f.range)}`,
        f.in_range ? 'ok' : 'bad',
      )
    : '';

function indices({ figures, beside }) {
  const lands = beside.map((land) => land.name);
  const left = new Map(Object.entries(figures));
  const parts = groups.flatMap(([title, keys]) => {
    const rows = [...left].filter(([key]) => keys.test(key));
    rows.forEach(([key]) => left.delete(key));
    return rows.length
      ? [
          strips(
            [title, 'compared', 'here', ''],
            rows.map(([, f]) => ({
              name: make('span', {}, f.name, f.unit && ` [${f.unit}]`),
              range: f.range ?? null,
              dots: [f.value],
              ticks: lands.map((name) => f.beside?.[name]),
              words:
                [
                  f.range && `range ${between(f.range)}`,
                  ...lands.map((name) => f.beside && `${name} ${number(f.beside[name], 3)}`),
                ]
                  .filter(Boolean)
                  .join(', ') || 'nothing to compare',
              cells: [number(f.value, 3), verdict(f)],
            })),
            `Relief beside reference DEMs: ${title}`,
          ),
        ]
      : [];
  });
  return make('div', { className: 'relief' }, ...parts);
}

function sentence({ figures }) {
  const all = Object.values(figures).filter(judged);
  return `${all.filter((f) => f.in_range).length} of ${all.length} figures are within a quarter of the reference DEMs.`;
}

function figuresTable({ figures, beside }) {
  return fold(
    'As a table',
    table(
      ['figure', 'here', ...beside.map((land) => land.name), 'range'],
      Object.values(figures).map((f) => [
        f.unit ? `${f.name} [${f.unit}]` : f.name,
        number(f.value, 3),
        ...beside.map((land) => number(f.beside?.[land.name], 3)),
        f.range ? between(f.range) : '–',
      ]),
      'Relief compared with reference DEMs',
    ),
  );
}

/** Shares of slopes, up to the steepest that any of them has. */
function slopes({ slopes: here, beside }) {
  const all = [here.shares_of_2_deg ?? [], ...beside.map((land) => land.slopes)];
  if (!all[0].length) return null;
  const least = 0.0005;
  const last = Math.max(...all.map((shares) => shares.findLastIndex((share) => share >= least)));
  const line = (shares) => shares.slice(0, last + 1).map((share, i) => [2 * i + 1, 100 * share]);
  return chart(all.map((shares, k) => ({ points: line(shares), name: k ? beside[k - 1].name : 'here', kind: 'line' })),
    { title: 'Slopes, shares of two degrees each', x: 'slope [°]', y: 'cells [%]', zeroX: true, zeroY: true });
}

function forms({ forms: here, beside }) {
  const lands = [here, ...beside.map((land) => land.forms)];
  const shown = Object.keys(here).filter((name) => lands.some((shares) => shares[name] >= 0.002));
  if (!Object.values(here).some((share) => share > 0)) return null;
  return make(
    'figure',
    {},
    make('figcaption', { textContent: 'Geomorphons: the landform of each cell' }),
    bars(
      ['form', 'cells', 'here [%]'],
      shown.map((name) => ({
        name,
        values: lands.map((land) => 100 * land[name]),
        cells: [number(100 * here[name], 3)],
      })),
      'Geomorphons: the landform of each cell',
    ),
  );
}

function slopeArea({ slope_area: here, beside }) {
  if (!here) return null;
  const points = (bins) => bins.map(([area, slope]) => [area, slope]);
  return chart(
    [
      { points: points(here.bins), fit: here.fit, name: 'here', kind: 'points' },
      ...beside.map((land) => ({ points: points(land.slope_area), name: land.name, kind: 'points' })),
    ],
    {
      title:
        `Slope against area along the DEM’s rivers: θ = ${number(here.theta, 3)} ± ${number(here.error, 1)}, ` +
        `r² ${number(here.r2, 3)}`,
      x: 'area [km²]',
      y: 'slope [m/m]',
      logX: true,
      logY: true,
    },
  );
}

export function relief(data) {
  if (!data) return [];
  const lands = data.beside.map((land) => `${land.name}: ${land.source}, cells of ${number(land.cell_m)} m`).join('. ');
  const marks = (of) => legend([['here', symbol(0)], ...data.beside.map((land, k) => [land.name, of(k + 1)])]);
  return [make('p', { className: 'lead', textContent: sentence(data) }), marks(rung), indices(data),
    make('p', { className: 'hint', textContent: `${lands}.` }), figuresTable(data),
    marks(symbol), make('div', { className: 'plots' }, slopes(data), slopeArea(data), forms(data))];
}
