// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Laws of the network and of the rivers that its DEM draws, beside what is known of nature.
import { between, chart, number } from './chart.js';
import { fold, legend, make, symbol, table } from './elements.js';
import { strips } from './strips.js';

const sides = [['network', 'network'], ['DEM', 'dem']];
const named = (r) => (r.unit ? `${r.name} [${r.unit}]` : r.name);

function lawStrips(rows, used) {
  const words = (r) => {
    if (!r.nature) return 'no natural range known';
    return [
      `natural range ${between(r.nature)}`,
      ...used
        .map(([name, key]) => [name, r[key]?.value])
        .filter(([, v]) => Number.isFinite(v))
        .map(([name, v]) => `${name} ${v < r.nature[0] ? 'below' : v > r.nature[1] ? 'above' : 'within'} it`),
    ].join(', ');
  };
  const name = (r) =>
    make(
      'span',
      { title: r.source },
      ...(r.nature ? [r.name, make('small', {}, `${between(r.nature)} ${r.unit}`)] : [named(r)]),
    );
  return strips(['law, natural range', 'compared', ...used.map(([head]) => head)],
    rows.map((r) => ({ name: name(r), range: r.nature, dots: sides.map(([, key]) => r[key]?.value), words: words(r),
      cells: used.map(([, key]) => number(r[key]?.value, 3)) })), 'Network laws and natural ranges');
}

/** The same in figures, with how sure they are and who found the ranges. */
function lawTable(rows, used) {
  const sources = [...new Set(rows.map((r) => r.source).filter(Boolean))];
  const figure = (of) => make('span', {}, number(of?.value, 3), of?.note && make('small', { textContent: of.note }));
  const nature = (r) =>
    r.nature
      ? make('span', {}, between(r.nature), make('sup', { textContent: ` ${sources.indexOf(r.source) + 1}` }))
      : '–';
  return fold('As a table, with sources', table(['law', ...used.map(([head]) => head), 'natural range'],
    rows.map((r) => [named(r), ...used.map(([, key]) => figure(r[key])), nature(r)]), 'Network laws'),
  make('ol', { className: 'sources' }, ...sources.map((text) => make('li', { textContent: text }))));
}

function support(law) {
  if (!law.support) return '';
  const { cells, km2, as_dense } = law.support;
  return (
    ` DEM: streams where at least ${number(cells)} cells (${number(km2, 3)} km²) drain by D8` +
    (as_dense ? ', which gives them the total length of the network.' : '.')
  );
}

/** The straight line through logarithms, least squares: the one whose slope is the ratio. */
function fit(points) {
  if (points.length < 2) return undefined;
  const n = points.length;
  const mx = points.reduce((s, p) => s + p[0], 0) / n;
  const my = points.reduce((s, p) => s + Math.log10(p[1]), 0) / n;
  const slope =
    points.reduce((s, p) => s + (p[0] - mx) * (Math.log10(p[1]) - my), 0) /
    points.reduce((s, p) => s + (p[0] - mx) ** 2, 0);
  return [points[0][0], points.at(-1)[0]].map((x) => [x, 10 ** (my + slope * (x - mx))]);
}

function diagrams(law) {
  const pair = (parts, what) => {
    const series = parts
      .map((part, k) => ({ ...part, name: sides[k][0], tone: k, kind: 'points' }))
      .filter((s) => s.points.length);
    return series.length ? chart(series, { small: true, logY: true, height: 140, ...what }) : null;
  };
  const byOrder = (pick, title, y) => pair([law.orders, law.dem_orders].map((orders) => {
    const points = orders.map((o) => [o.order, pick(o)]).filter(([, v]) => v > 0);
    return { points, fit: fit(points) };
  }), { title, x: 'order', y, wholeX: true });
  const byArea = (power, title, y) =>
    pair(
      [power.network, power.dem].map((p) => ({ points: p ? p.bins.map(([a, v]) => [a, v]) : [], fit: p?.fit })),
      { title, x: 'area [km²]', y, logX: true },
    );
  return make('div', { className: 'plots small' },
    byOrder((o) => o.streams, 'Stream numbers', 'streams'),
    byOrder((o) => o.length_m / 1000, 'Stream lengths', 'mean length [km]'),
    byOrder((o) => o.area_m2 / 1e6, 'Drainage areas', 'mean area [km²]'),
    byArea(law.hack, 'Hack: longest flow path', 'length [km]'),
    byArea(law.concavity, 'Concavity: slope of arcs', 'slope [m/m]'));
}

export function laws(law) {
  if (!law || law.rows.length === 0) return [];
  const used = sides.filter(([, key]) => law.rows.some((r) => r[key]));
  return [
    legend(used.map((side) => [side[0], symbol(sides.indexOf(side))])),
    lawStrips(law.rows, used),
    make('p', {
      className: 'hint',
      textContent:
        'Grey: the natural range; triangles are beyond the strip. Real rivers are outside at times.' + support(law),
    }),
    lawTable(law.rows, used),
    diagrams(law),
    law.orders.length
      ? fold(
          'Streams by Strahler order',
          table(
            ['order', 'streams', 'mean length [m]', 'mean area [km²]'],
            law.orders.map((o) => [String(o.order), number(o.streams), number(o.length_m), number(o.area_m2 / 1e6)]),
            'Streams by Strahler order',
          ),
        )
      : null,
  ];
}
