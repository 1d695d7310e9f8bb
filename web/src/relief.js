// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The figures by which experts judge land, beside those of real land.
import { bars, chart, number } from './chart.js';
import { make, table } from './elements.js';

function figures({ figures: all, beside }) {
  const range = (f) => {
    if (!f.range || f.value === null) return '–';
    const words = `${number(f.range[0], 3)} to ${number(f.range[1], 3)}`;
    const mark = make('span', { className: f.in_range ? 'ok' : 'bad', textContent: f.in_range ? '✓' : '✗', title: words });
    mark.setAttribute('role', 'img');
    mark.setAttribute('aria-label', `${f.in_range ? 'within' : 'outside'} ${words}`);
    return mark;
  };
  const t = table(['figure', 'here', ...beside.map((land) => land.name), ''],
    Object.values(all).map((f) => [f.unit ? `${f.name} [${f.unit}]` : f.name, number(f.value, 3),
      ...beside.map((land) => number(f.beside?.[land.name], 3)), range(f)]), 'Relief compared with reference DEMs');
  t.className = 'relief';
  return t;
}

/** Shares of slopes, up to the steepest that any of them has. */
function slopes({ slopes: here, beside }) {
  const all = [here.shares_of_2_deg ?? [], ...beside.map((land) => land.slopes)];
  if (!all[0].length) return null;
  const least = 0.0005;
  const last = Math.max(...all.map((shares) => shares.findLastIndex((share) => share >= least)));
  const line = (shares) => shares.slice(0, last + 1).map((share, i) => [2 * i + 1, 100 * share]);
  return chart(all.map((shares, k) => ({ points: line(shares), name: k ? beside[k - 1].name : 'here', kind: 'line' })),
    { title: 'Slopes, shares of two degrees each', x: 'slope [°]', y: 'cells [%]', zeroX: true, zeroY: true, legend: true });
}

function forms({ forms: here, beside }) {
  const shown = Object.keys(here).filter((name) => [here, ...beside.map((land) => land.forms)].some((shares) => shares[name] >= 0.002));
  if (!Object.values(here).some((share) => share > 0)) return null;
  return bars(shown, [{ name: 'here', values: here }, ...beside.map((land) => ({ name: land.name, values: land.forms }))]
    .map(({ name, values }) => ({ name, values: shown.map((form) => 100 * values[form]) })),
  { title: 'Geomorphons: the landform of each cell', unit: '% of cells' });
}

function slopeArea({ slope_area: here, beside }) {
  if (!here) return null;
  const points = (bins) => bins.map(([area, slope]) => [area, slope]);
  return chart([{ points: points(here.bins), fit: here.fit, name: 'here', kind: 'points' },
    ...beside.map((land) => ({ points: points(land.slope_area), name: land.name, kind: 'points' }))],
  { title: `Slope against area along the DEM’s rivers: θ = ${number(here.theta, 3)} ± ${number(here.error, 1)}, r² ${number(here.r2, 3)}`,
    x: 'area [km²]', y: 'slope [m/m]', logX: true, logY: true, legend: true });
}

export function relief(data) {
  if (!data) return [];
  const lands = data.beside.map((land) => `${land.name}: ${land.source}, cells of ${number(land.cell_m)} m`).join('. ');
  return [figures(data),
    make('p', { className: 'hint', textContent: `✓: within a quarter of the reference DEMs. ${lands}.` }),
    slopes(data), forms(data), slopeArea(data)];
}
