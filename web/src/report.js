// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The written part of the page: diagrams, tables, targets and results.
import { chart, number } from './chart.js';
import { make, section, table } from './elements.js';
import { relief } from './relief.js';

const words = (name) => name.replace(/_/g, ' ');

function increments(curve) {
  if (!curve) return [];
  return [
    chart([{ points: curve.points.map(([x, dh]) => [x, dh]), name: 'Δh', kind: 'line' }],
      { title: `Increment “${curve.name}”: height gained at each step from the valley`, x: 'distance [cells]', y: 'Δh [m]', zeroX: true, zeroY: true }),
    chart([{ points: [[0, 0], ...curve.points.map(([x, , H]) => [x, H])], name: 'H', kind: 'area' }],
      { title: 'Height above the valley', x: 'distance [cells]', y: 'H [m]', zeroX: true, zeroY: true }),
  ];
}

/** Figures of the network and of the rivers its DEM draws, beside what is known of nature. */
function lawTable(law) {
  const sources = [...new Set(law.rows.map((r) => r.source).filter(Boolean))];
  const sides = [['network', 'network'], ['DEM', 'dem']].filter(([, key]) => law.rows.some((r) => r[key]));
  const figure = (of, unit) => make('span', {}, of.value === null ? '–' : `${number(of.value, 3)}${unit && unit !== '°' ? '\u00a0' : ''}${of.value === null ? '' : unit}`,
    of.note && make('small', { textContent: of.note }));
  const nature = (r) => (r.nature
    ? make('span', {}, `${number(r.nature[0], 3)} to ${number(r.nature[1], 3)}`, make('sup', { textContent: ` ${sources.indexOf(r.source) + 1}` })) : '–');
  const t = table(['law', ...sides.map(([head]) => head), 'natural range'],
    law.rows.map((r) => [r.name, ...sides.map(([, key]) => figure(r[key], r.unit)), nature(r)]), 'Network laws');
  t.className = 'laws';
  return [t, make('ol', { className: 'sources' }, ...sources.map((text) => make('li', { textContent: text })))];
}

function support(law) {
  if (!law.support) return null;
  const { cells, km2, as_dense } = law.support;
  return make('p', { className: 'hint', textContent: `DEM: streams where at least ${number(cells)} cells (${number(km2, 3)} km²) drain by D8` +
    (as_dense ? ', which gives them the total length of the network' : '') + '.' });
}

function laws(law) {
  if (!law || law.rows.length === 0) return [];
  const names = [['network', 0], ['DEM', 1]];
  const pair = (parts, what) => {
    const series = parts.map((part, i) => ({ ...part, name: names[i][0], tone: names[i][1], kind: 'points' })).filter((s) => s.points.length);
    if (!series.length) return null;
    const figure = chart(series, { height: 150, logY: true, legend: true, ...what });
    figure.classList.add('pair');
    return figure;
  };
  const byOrder = (pick, title, y) => pair([law.orders, law.dem_orders].map((orders) => {
    const points = orders.map((o) => [o.order, pick(o)]).filter(([, v]) => v > 0);
    return { points, fit: fit(points) };
  }), { title, x: 'Strahler order', y, wholeX: true });
  const byArea = (power, title, y) => pair([power.network, power.dem].map((p) => ({ points: p ? p.bins.map(([a, v]) => [a, v]) : [], fit: p?.fit })),
    { title, x: 'area [km²]', y, logX: true, height: 176 });
  return [
    ...lawTable(law), support(law),
    law.orders.length ? table(['order', 'streams', 'mean length [m]', 'mean area [km²]'],
      law.orders.map((o) => [String(o.order), number(o.streams), number(o.length_m), number(o.area_m2 / 1e6)]), 'Streams by Strahler order') : null,
    byOrder((o) => o.streams, 'Law of stream numbers', 'streams'),
    byOrder((o) => o.length_m / 1000, 'Law of stream lengths', 'mean length [km]'),
    byOrder((o) => o.area_m2 / 1e6, 'Law of drainage areas', 'mean area [km²]'),
    byArea(law.concavity, 'Slope against area, means of bins', 'slope [m/m]'),
    byArea(law.hack, 'Hack’s law: longest flow path against area', 'length [km]'),
  ];
}

/** The straight line through logarithms, least squares: the one whose slope is the ratio. */
function fit(points) {
  if (points.length < 2) return undefined;
  const n = points.length;
  const mx = points.reduce((s, p) => s + p[0], 0) / n;
  const my = points.reduce((s, p) => s + Math.log10(p[1]), 0) / n;
  const slope = points.reduce((s, p) => s + (p[0] - mx) * (Math.log10(p[1]) - my), 0) / points.reduce((s, p) => s + (p[0] - mx) ** 2, 0);
  return [points[0][0], points.at(-1)[0]].map((x) => [x, 10 ** (my + slope * (x - mx))]);
}

function listed(one, { count, shown }) {
  if (!count) return null;
  const more = count > shown.length ? `; the first ${shown.length}` : '';
  return make('details', {}, make('summary', { textContent: `${number(count)} ${one}${count === 1 ? '' : 's'}${more}` }),
    make('ul', {}, ...shown.map((text) => make('li', { textContent: text }))));
}

function copyable(text, label) {
  const button = make('button', { type: 'button', textContent: 'Copy' });
  button.setAttribute('aria-label', `Copy ${label}`);
  const box = make('pre', { textContent: text, tabIndex: 0 });
  box.setAttribute('aria-label', label);
  box.setAttribute('role', 'region');
  button.addEventListener('click', async () => {
    try {
      await navigator.clipboard.writeText(text);
      button.textContent = 'Copied';
    } catch { // a page from a file may not write to the clipboard
      getSelection().selectAllChildren(box);
      button.textContent = 'Selected';
    }
    setTimeout(() => (button.textContent = 'Copy'), 1500);
  });
  return make('div', { className: 'copy' }, button, box);
}

export function fillReport(parent, data) {
  const verdict = (ok) => make('span', { className: ok ? 'ok' : 'bad', textContent: ok ? 'ok' : 'failed' });
  const failed = data.checks.filter((c) => !c.ok).length;
  const whole = data.timings.reduce((sum, [, s]) => sum + s, 0);
  const km = data.profile.length > 1 && data.profile[0][0] >= 2000;
  parent.append(...[
    section('Long profile', data.profile.length > 1 ? chart(
      [{ points: data.profile.map(([d, z]) => [km ? d / 1000 : d, z]).reverse(), kind: 'area', name: 'height' }],
      { title: 'Main stem, from the outlet up to its farthest source', x: km ? 'distance from the outlet [km]' : 'distance from the outlet [m]', y: 'height [m]', zeroX: true }) : null),
    section('Hypsometry', data.hypsometry ? chart(
      [{ points: data.hypsometry.points.map(([a, z]) => [100 * a, z]), kind: 'area', name: 'height' }],
      { title: `Share of the area above a height; integral ${number(data.hypsometry.integral, 3)}`, x: 'area above [%]', y: 'height [m]', zeroX: true }) : null),
    section('Increment', ...increments(data.curve)),
    section('Relief compared with reference DEMs', ...relief(data.relief)),
    section('Network laws', ...laws(data.laws)),
    section('Statistics', data.statistics.length ? table(['', 'target', 'result', ''],
      data.statistics.map((s) => [s.name, s.asked === null ? '–' : number(s.asked, 5), number(s.got, 5), s.unit]), 'Statistics, target and result') : null),
    section('The given rivers', data.given.length ? table(['', 'value', ''],
      data.given.map(([name, value, unit]) => [name, number(value, 4), unit]), 'The given rivers') : null),
    section('Checks', data.checks.length ? make('details', { open: failed > 0 },
      make('summary', {}, failed ? `${failed} of ${data.checks.length} checks failed ` : `${data.checks.length} checks passed `, verdict(failed === 0)),
      table(['check', 'found', 'limit', ''], data.checks.map((c) => [words(c.name), number(c.value), `${c.bound === 'at_least' ? '≥' : '≤'} ${number(c.limit)}`, verdict(c.ok)]), 'Checks')) : null,
    listed('finding', data.findings), listed('repair', data.repairs)),
    section('Time', data.timings.length && table(['stage', 'seconds'], [...data.timings.map(([name, s]) => [name, s.toFixed(2)]), ['total', whole.toFixed(2)]], 'Time by stage')),
    section('Make it again', copyable(data.command, 'the command'), data.recipe && make('details', {}, make('summary', { textContent: 'recipe.toml' }),
      copyable(data.recipe, 'the recipe'))),
    section('Notes', data.notes.length ? make('ul', {}, ...data.notes.map((text) => make('li', { textContent: text }))) : null),
  ].filter(Boolean));
}

/** A height with as many digits as tell heights of this land apart. */
export function metres(z, { min, max }) {
  return number(max - min >= 50 ? Math.round(z) : z, 5);
}

/** One line under the title. */
export function summary(data, rivers) {
  const { grid, heights } = data;
  const km = (cells) => number((cells * grid.cell_m) / 1000, 3);
  return [`${number(grid.width, 7)} × ${number(grid.height, 7)} cells of ${number(grid.cell_m)} m (${km(grid.width)} × ${km(grid.height)} km)`,
    grid.crs ? (grid.crs.length < 24 ? grid.crs : 'own CRS') : 'no CRS',
    rivers.count ? `${number(rivers.count)} arcs to order ${rivers.highest}` : 'no rivers',
    heights ? `${metres(heights.min, heights)} to ${metres(heights.max, heights)} m` : 'no surface'].join(' · ');
}
