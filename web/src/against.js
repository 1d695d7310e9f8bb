// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The terrain beside a real DEM that was not used to make it, and beside simple terrains around the same rivers.
import { axes, chart, layOut, number } from './chart.js';
import { css, mix } from './colours.js';
import { draw, legend, make, sign, table } from './elements.js';
import { dialog } from './keys.js';

/**
 * What a figure would be in the DEM itself is its goal; without one it is the DEM's own figure. Where lands were given
 * it, it is not judged.
 */
const figures = [
  { key: 'correlation', name: 'correlation of heights', goal: 1, decimals: 3 },
  { key: 'correlation_above_river', name: 'correlation above the nearest river', goal: 1, decimals: 3 },
  { key: 'rmse_m', name: 'RMS difference', unit: 'm', goal: 0 },
  { key: 'bias_m', name: 'mean difference', unit: 'm', goal: 0, signs: true },
  { key: 'same_reach', name: 'same reach', unit: '%', goal: 1, decimals: 1 },
  { key: 'divides_found', name: 'divides found', unit: '%', goal: 1, decimals: 1 },
  { key: 'divides_right', name: 'divides right', unit: '%', goal: 1, decimals: 1 },
  { key: 'slopes_difference', name: 'difference of slopes', goal: 0, decimals: 3 },
  { key: 'mean_slope_deg', name: 'mean slope', unit: '°', decimals: 1, given: ['cone', 'dilation'] },
  { key: 'hypsometric_integral', name: 'hypsometric integral', decimals: 3 }];

/**
 * The colours of the map of differences, as lib/thalweg/draw/comparison.cpp paints it: steeper near 0. share: [-1, 1]
 * of the limit.
 */
const [lower, level, higher] = [[33, 102, 171], [247, 247, 245], [179, 23, 43]];
const colourOf = (share) => css(mix([level, share < 0 ? lower : higher], Math.abs(share)));
const divides = [['divides of both', '#000'], ['of the DEM alone', '#e8a400'], ['of this terrain alone', '#7a3fb0']];

/** Decimals that give the smallest of some lengths three digits. */
function decimalsOf(lengths) {
  const least = Math.min(...lengths.filter((v) => v > 0));
  return Number.isFinite(least) ? Math.min(3, Math.max(0, 2 - Math.floor(Math.log10(least)))) : 1;
}

/**
 * Each figure of each land: {name, head, texts, real: text, given: whether each was given it, misses: how far from its
 * goal, in units of the last decimal}. Lands that read the same are equal.
 */
function compared({ rows, real }) {
  const metres = decimalsOf(rows.map((row) => row.rmse_m));
  return figures.map(({ key, name, unit, goal, decimals = metres, signs, given = [] }) => {
    const times = unit === '%' ? 100 : 1;
    /** @type {Intl.NumberFormatOptions} */
    const digits = {
      minimumFractionDigits: decimals,
      maximumFractionDigits: decimals,
      signDisplay: signs ? 'exceptZero' : 'negative',
    };
    const units = (v) => (Number.isFinite(v) ? Math.round(times * v * 10 ** decimals) : NaN);
    const text = (v) =>
      Number.isFinite(v)
        ? (units(v) / 10 ** decimals).toLocaleString('en', digits).replace(/,/g, '\u202f').replace('-', '\u2212')
        : '–';
    const values = rows.map((row) => row[key]);
    const made = rows.map((row) => given.includes(row.key));
    const aim = made.includes(true) ? NaN : units(goal ?? real[key]);
    return {
      name,
      head: unit ? `${name} [${unit}]` : name,
      texts: values.map(text),
      real: goal === undefined ? text(real[key]) : '',
      given: made,
      misses: values.map((v) => Math.abs(units(v) - aim)),
    };
  });
}

const leastOf = (misses) => Math.min(...misses.filter(Number.isFinite));

/** In which figures this terrain is nearer than every simple one, and in which one of those is. */
function sentence({ dem, rows }, all) {
  const [, ...simple] = rows.map((row) => row.name);
  const told = all
    .map(({ name, misses: [here, ...others] }) => ({ name, here, others, least: leastOf(others) }))
    .filter(({ here, least }) => Number.isFinite(here + least));
  if (!told.length) return null;
  const [better, equal, worse] = [(f) => f.here < f.least, (f) => f.here === f.least, (f) => f.here > f.least].map(
    (is) => told.filter(is),
  );
  const list = (some) => some.map(({ name }) => name).join(', ');
  const nearer = ({ name, here, others }) =>
    `${name} (${[...simple.keys()]
      .filter((k) => others[k] < here)
      .sort((a, b) => others[a] - others[b])
      .map((k) => simple[k])
      .join(', ')})`;
  const than =
    simple.length > 1
      ? `each of the ${['two', 'three'][simple.length - 2] ?? simple.length} simple terrains`
      : `the ${simple[0]}`;
  const whole = better.length === told.length;
  return make(
    'p',
    { className: 'lead' },
    make('b', {
      textContent:
        `This terrain is nearer to ${dem} than ${than} in ` +
        `${whole ? 'all' : better.length || 'none'}${whole ? '' : ' of'} ${told.length} figures`,
    }),
    whole || !better.length ? '.' : `: ${list(better)}.`,
    worse.length
      ? ` ${simple.length > 1 ? 'A simple one' : `The ${simple[0]}`} is nearer in ${worse.length}: ` +
          `${simple.length > 1 ? worse.map(nearer).join(', ') : list(worse)}.`
      : '',
    equal.length ? ` As near as the best of them: ${list(equal)}.` : '',
  );
}

function figuresTable({ rows }, all) {
  const best = ({ misses }, k) => misses[k] === leastOf(misses) && misses.some((miss) => miss > misses[k]);
  const cell = (f, k) =>
    best(f, k)
      ? make('b', {}, sign('●', 'best', 'best'), f.texts[k])
      : make('span', {}, f.texts[k], f.given[k] && make('small', { textContent: 'given' }));
  const t = table(
    ['figure', ...rows.map((row) => row.name), 'DEM'],
    all.map((f) => [f.head, ...rows.map((_, k) => cell(f, k)), f.real]),
    'Compared with a real DEM',
  );
  t.classList.add('against');
  return t;
}

const meanings = [
  ['Height above the nearest river', 'a cell’s height less that of the river cell nearest to it.'],
  ['Same reach', 'cells whose water first meets the same reach of river as in the DEM.'],
  [
    'Divides',
    'lines between what drains to different reaches, off the rivers. Found: the DEM’s, where the terrain has one ' +
      'within 3 cells; right: the terrain’s, where the DEM has one within 3 cells.',
  ],
  [
    'Difference of slopes',
    'the greatest distance upwards between its line and the DEM’s under Slopes (Kolmogorov–Smirnov).',
  ],
];

/** What the colours and lines of the map of differences are. */
function keyOf(metres) {
  const parts = 60;
  const scale = draw(
    'svg',
    { class: 'scale', width: '100%', height: 26, 'aria-hidden': 'true' },
    ...Array.from({ length: parts }, (_, k) =>
      draw('rect', {
        x: `${((100 * k) / parts).toFixed(2)}%`,
        width: `${(100 / parts).toFixed(2)}%`,
        height: 10,
        fill: colourOf((2 * k + 1) / parts - 1),
        'shape-rendering': 'crispEdges',
      }),
    ),
    ...[
      ['start', 0, `\u2212${metres}: this terrain lower`],
      ['middle', '50%', '0'],
      ['end', '100%', `higher: +${metres}`],
    ].map(([anchor, x, text]) => draw('text', { class: 'tick', x, y: 22, 'text-anchor': anchor }, text)),
  );
  const line = (colour) =>
    draw(
      'g',
      {},
      draw('rect', { x: -12, y: -6, width: 24, height: 12, rx: 2, fill: css(level) }),
      draw('path', { d: 'M-12 0H12', stroke: colour, 'stroke-width': 2.5 }),
    );
  return [scale, legend(divides.map(([name, colour]) => [name, line(colour)]), { wide: true })];
}

function map({ dem, difference: { limit_m: limit, width, height, image } }) {
  const metres = `${number(limit)}\u00a0m`;
  const title = `This terrain less ${dem}`;
  const picture = () =>
    make('img', {
      className: 'map',
      width,
      height,
      src: image,
      alt:
        `Map of this terrain less ${dem}: blue where it is lower, red where it is higher, up to ${metres}. ` +
        'Lines are divides: black of both, amber of the DEM alone, violet of this terrain alone.',
    });
  const button = make('button', { type: 'button', className: 'show', textContent: 'Enlarge' });
  button.setAttribute('aria-label', 'Enlarge the map of differences');
  let large;
  button.addEventListener('click', () => {
    large ??= Object.assign(dialog(title, picture(), ...keyOf(metres)), { className: 'report large' });
    large.showModal();
  });
  return make(
    'figure',
    {},
    make('figcaption', { className: 'with' }, make('span', { textContent: title }), button),
    picture(),
    ...keyOf(metres),
  );
}

/** Numbers of cells from which on a square is darker: two a decade, or one if these were too many. */
function stepsTo(most) {
  const all = Array.from(
    { length: 2 * Math.ceil(Math.log10(most + 1)) },
    (_, i) => (i % 2 ? 3 : 1) * 10 ** Math.floor(i / 2),
  ).filter((step) => step <= most);
  return all.length > 10 ? all.filter((_, i) => i % 2 === 0) : all;
}

/** How many cells have which height in the DEM and in this terrain. */
function scatter({ low, high, side, counts }, correlation) {
  const steps = stepsTo(counts.reduce((a, b) => Math.max(a, b), 0));
  const shade = (k) => (steps.length > 1 ? 0.14 + (0.86 * k) / (steps.length - 1) : 1).toFixed(2);
  const squares = steps.map(() => []);
  counts.forEach((count, i) => squares[steps.findLastIndex((step) => count >= step)]?.push(i));
  const words =
    `Heights from ${number(low)} to ${number(high)} m of all cells, in the DEM and in this terrain, ` +
    'with the line where both are equal' +
    (Number.isFinite(correlation) ? `; their correlation is ${number(correlation, 3)}` : '');
  const field = make('div', { className: 'plot' });
  const what = { x: 'DEM [m]', y: 'this terrain [m]', least: 2 };
  let shown = 0;

  function paint(width) {
    shown = width;
    const ends = [{ points: [[low, low], [high, high]] }];
    const { box: { left, right } } = layOut(ends, what, width);
    const laid = layOut(ends, { ...what, height: right - left + 54 }, width);
    const { box, place } = laid;
    const size = (right - left) / side;
    const [x, y] = [(column) => (left + size * column).toFixed(1), (row) => (box.bottom - size * row).toFixed(1)];
    const path = (all) =>
      all
        .map((i) => ({ column: i % side, row: Math.floor(i / side) }))
        .map(({ column, row }) => `M${x(column)} ${y(row)}H${x(column + 1)}V${y(row + 1)}H${x(column)}Z`)
        .join('');
    const [[x1, y1], [x2, y2]] = [[low, low], [high, high]].map(place);
    field.replaceChildren(
      draw(
        'svg',
        { width, height: laid.height, role: 'img', 'aria-label': words },
        ...axes(laid, what),
        ...squares.map((all, k) => draw('path', { class: 'square', 'fill-opacity': shade(k), d: path(all) })),
        draw('line', { class: 'equal', x1, y1, x2, y2 }),
      ),
    );
  }
  paint(356);
  new ResizeObserver(
    ([
      {
        contentRect: { width },
      },
    ]) => width > 0 && Math.abs(width - shown) > 0.5 && paint(width),
  ).observe(field);
  const part = 100 / steps.length;
  return make(
    'figure',
    { className: 'scatter' },
    make('figcaption', { textContent: 'Heights of the same cells; the line: equal heights' }),
    field,
    draw(
      'svg',
      {
        class: 'scale',
        width: '100%',
        height: 26,
        role: 'img',
        'aria-label': `Shades: from ${steps.map((step) => number(step)).join(', ')} cells on`,
      },
      ...steps.map((_, k) =>
        draw('rect', {
          class: 'square',
          x: `${(part * k).toFixed(2)}%`,
          width: `${part.toFixed(2)}%`,
          height: 10,
          'fill-opacity': shade(k),
        }),
      ),
      ...steps.map((step, k) =>
        draw('text', { class: 'tick', x: `${(part * k).toFixed(2)}%`, y: 22 }, `${number(step)}${k ? '' : ' cell'}`),
      ),
    ),
  );
}

/** The DEM as a pale band, this terrain as everywhere, the others in the tones left. */
const tone = (k) => ['dem', 0][k] ?? 1 + ((k - 2) % 3);

/** Up to the steepest of the DEM and of this terrain. */
function slopes(all, tones) {
  const last = Math.max(
    ...all.slice(0, 2).map((land) => land.shares_of_2_deg.findLastIndex((share) => share >= 0.0005)),
  );
  const points = (shares) =>
    shares
      .slice(0, last + 1)
      .reduce((sums, share) => [...sums, sums.at(-1) + 100 * share], [0])
      .map((sum, i) => [2 * i, sum]);
  return chart(
    all.map((land) => ({ points: points(land.shares_of_2_deg), name: land.name, tone: tones(land), kind: 'line' })),
    {
      title: 'Slopes: share of cells gentler than',
      x: 'slope [°]',
      y: 'cells [%]',
      zeroX: true,
      zeroY: true,
      topY: 100,
      height: 170,
    },
  );
}

function hypsometry(all, tones) {
  return chart(
    all.map((land) => ({
      points: land.points.map(([share, z]) => [100 * share, z]),
      name: land.name,
      tone: tones(land),
      kind: 'line',
    })),
    {
      title: 'Hypsometry: share of the land above a height',
      x: 'area above [%]',
      y: 'height [m]',
      zeroX: true,
      height: 170,
    },
  );
}

export function against(data) {
  if (!data) return [];
  const all = compared(data);
  const names = [...new Set([...data.slopes, ...data.hypsometry].map((land) => land.name))];
  const tones = (land) => tone(names.indexOf(land.name));
  return [
    sentence(data, all),
    figuresTable(data, all),
    make(
      'p',
      { className: 'hint' },
      sign('●', 'a dot', 'best'),
      ` and bold: the nearest to the DEM. ${number(data.cells)} cells compared; ` +
        'the DEM was not used to make this terrain.' +
        (all.some((f) => f.given.includes(true)) ? ' Given: the DEM’s own, by which the simple terrain was made.' : ''),
    ),
    make(
      'ul',
      { className: 'hint meanings' },
      ...meanings.map(([name, text]) => make('li', {}, make('b', { textContent: name }), `: ${text}`)),
    ),
    data.difference && map(data),
    make(
      'div',
      { className: 'plots against' },
      data.scatter && scatter(data.scatter, data.rows[0]?.correlation),
      make(
        'div',
        {},
        legend(
          names.map((name, k) => [name, draw('path', { class: `line s${tone(k)}`, d: 'M-12 0H12' })]),
          { wide: true },
        ),
        slopes(data.slopes, tones),
        hypsometry(data.hypsometry, tones),
      ),
    ),
  ];
}
