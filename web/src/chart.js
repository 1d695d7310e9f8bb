// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A diagram in SVG, drawn at the width it has: lines or points over labelled axes, with a reading under the pointer or
// by arrow keys.
import { draw, make, symbol } from './elements.js';

export function number(value, digits = 4) {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  if (value !== 0 && (Math.abs(value) >= 1e9 || Math.abs(value) < 1e-4)) return value.toExponential(2);
  const decimals = Math.max(0, Math.min(6, digits - 1 - Math.floor(Math.log10(Math.abs(value) || 1))));
  return value.toLocaleString('en', { maximumFractionDigits: decimals }).replace(/,/g, '\u202f').replace('-', '\u2212');
}

/** A range in figures. */
export const between = ([low, high]) => `${number(low, 3)}–${number(high, 3)}`;

/** The largest of 1, 2 or 5 times a power of ten that is not above a length. */
export function roundBelow(length) {
  const power = 10 ** Math.floor(Math.log10(length));
  return [5, 2, 1].map((m) => m * power).find((step) => step <= length * (1 + 1e-9)) ?? power;
}

function logarithmic(values) {
  const ends = [Math.min(...values), Math.max(...values)];
  const [low, high] = [ends[0] / 1.25, ends[1] * 1.25];
  const decades = Math.log10(high / low);
  const powers = Array.from({ length: Math.ceil(decades) + 1 }, (_, i) => 10 ** (Math.floor(Math.log10(low)) + i));
  const within = (t) => t >= low && t <= high;
  const round = [[1], [1, 2, 5]].map((steps) =>
    powers.flatMap((power) => steps.map((step) => step * power)).filter(within),
  );
  return {
    low,
    high,
    ticks: round.find((ticks) => ticks.length > 1) ?? [...new Set(ends)],
    share: (v) => Math.log10(v / low) / decades,
  };
}

function scale(values, { log, whole = false, least }) {
  if (log) return logarithmic(values);
  let low = Math.min(...values);
  let high = Math.max(...values);
  if (!(high - low > 1e-9 * Math.max(Math.abs(low), Math.abs(high), 1e-9))) {
    const half = Math.max(0.5, Math.abs(high) * 0.01);
    low -= half;
    high += half;
  }
  const step = whole ? 1 : roundBelow((high - low) / least);
  const ticks = [];
  for (let t = Math.ceil(low / step - 1e-9) * step; t <= high + 1e-9 * step; t += step) {
    ticks.push(Math.abs(t) < 1e-9 * step ? 0 : t);
  }
  if (whole) {
    low -= 0.3;
    high += 0.3;
  }
  return { low, high, ticks, share: (v) => (v - low) / (high - low) };
}

/** A power of ten as such where it would be long, the rest as they are. */
function tick(value, log) {
  const power = Math.round(Math.log10(value));
  if (!log || (power > -3 && power < 4)) return number(value, 3);
  return `10${[...String(power)].map((c) => '⁻⁰¹²³⁴⁵⁶⁷⁸⁹'['-0123456789'.indexOf(c)]).join('')}`;
}

/** Where things lie in a drawing of this width. */
export function layOut(series, what, width) {
  const points = series.flatMap((s) => s.points.concat(s.fit ?? []));
  const height = what.height ?? 150;
  const y = scale(
    points
      .map((p) => p[1])
      .filter(Number.isFinite)
      .concat(what.zeroY ? [0] : [], what.topY ?? []),
    { log: what.logY, least: what.least ?? 3 },
  );
  const x = scale(points.map((p) => p[0]).concat(what.zeroX ? [0] : []), {
    log: what.logX,
    whole: what.wholeX,
    least: what.least ?? (width < 240 ? 2 : 4),
  });
  const widest = Math.max(...y.ticks.map((t) => tick(t, what.logY).length));
  const box = { left: 10 + 6 * widest, top: 22, right: width - 10, bottom: height - 32 };
  /** @param {number[]} point */
  const place = ([a, b]) => [
    box.left + x.share(a) * (box.right - box.left),
    box.bottom - y.share(b) * (box.bottom - box.top),
  ];
  return { x, y, box, place, width, height };
}

const path = (points, place) =>
  points
    .map(
      (p, i) =>
        `${i ? 'L' : 'M'}${place(p)
          .map((v) => v.toFixed(1))
          .join(' ')}`,
    )
    .join('');

/** Points between gaps. */
function runs(points) {
  const all = [[]];
  for (const p of points) {
    if (Number.isFinite(p[1])) all.at(-1).push(p);
    else if (all.at(-1).length) all.push([]);
  }
  return all.filter((run) => run.length);
}

export function axes({ x, y, box, place, height, width }, what) {
  const parts = [];
  for (const t of y.ticks) {
    const at = place([x.low, t])[1];
    parts.push(draw('line', { class: 'rule', x1: box.left, x2: box.right, y1: at, y2: at }),
      draw('text', { class: 'tick', x: box.left - 5, y: at + 3.5, 'text-anchor': 'end' }, tick(t, what.logY)));
  }
  for (const t of x.ticks) {
    const at = place([t, y.low])[0];
    parts.push(draw('line', { class: 'rule', x1: at, x2: at, y1: box.bottom, y2: box.bottom + 4 }),
      draw('text', { class: 'tick', x: at, y: box.bottom + 15, 'text-anchor': 'middle' }, tick(t, what.logX)));
  }
  parts.push(draw('line', { class: 'axis', x1: box.left, x2: box.right, y1: box.bottom, y2: box.bottom }),
    draw('text', { class: 'name', x: 0, y: 11 }, `↑ ${what.y}`),
    draw('text', { class: 'name', x: width - 2, y: height - 3, 'text-anchor': 'end' }, `${what.x} →`));
  return parts;
}

function strokes(s, { y, place }) {
  const parts = [];
  const k = s.tone;
  if (s.kind === 'area') {
    const floor = y.low < 0 && y.high > 0 ? 0 : y.low;
    for (const run of runs(s.points)) {
      const ends = [run.at(-1), run[0]].map((p) => [p[0], floor]);
      parts.push(draw('path', { class: 'area', d: `${path(run.concat(ends), place)}Z` }));
    }
  }
  if (s.fit) parts.push(draw('path', { class: `fit s${k}`, d: path(s.fit, place) }));
  if (s.kind === 'points') parts.push(...s.points.map((p) => symbol(k, ...place(p).map((v) => Number(v.toFixed(1))))));
  else parts.push(draw('path', { class: `line s${k}`, d: runs(s.points).map((run) => path(run, place)).join('') }));
  return parts;
}

/** A diagram as it lies in its figure: drawn anew at each width, and read by pointer and keys. */
class Plot {
  #series;
  #what;
  #tip = make('div', { className: 'tip', hidden: true });
  #laid; // out, at the width it has
  #hair;
  #index = null; // that is read
  element = make('div', { className: 'plot', tabIndex: 0 }, this.#tip);

  /** series, what: as plot() has them; every series has a point. */
  constructor(series, what) {
    this.#series = series;
    this.#what = what;
    this.#paint(what.small ? 170 : 356);
    new ResizeObserver(([{ contentRect }]) => {
      const { width } = contentRect;
      if (width > 0 && Math.abs(width - this.#laid.width) > 0.5) this.#paint(width);
    }).observe(this.element);
    this.#describe();
    this.#follow();
  }

  #paint(width) {
    const what = this.#what;
    const laid = layOut(this.#series, what, width);
    this.#laid = laid;
    this.#hair = draw('g', { class: 'hair' });
    const flags = (what.flags ?? [])
      .map(laid.place)
      .map(([x, y]) => draw('path', { class: 'flag', d: `M${x.toFixed(1)} ${(y - 4).toFixed(1)}l-4.5-8h9Z` }));
    const lines = this.#series.flatMap((s) => strokes(s, laid));
    this.element.querySelector('svg')?.remove();
    const parts = [...axes(laid, what), ...lines, ...flags, this.#hair];
    this.element.prepend(draw('svg', { width, height: laid.height, 'aria-hidden': 'true' }, ...parts));
    this.read(this.#index);
  }

  /** The number of the point of a series that lies nearest to a share of the width. */
  #nearest({ points }, share) {
    const off = (p) => Math.abs(this.#laid.x.share(p[0]) - share);
    return points.reduce((best, p, i) => (off(p) < off(points[best]) ? i : best), 0);
  }

  /** What all series have at a point of the first. */
  #beside(index) {
    const [first] = this.#series;
    const share = this.#laid.x.share(first.points[index][0]);
    return this.#series.map((s) => s.points[s === first ? index : this.#nearest(s, share)]);
  }

  #words(index) {
    const [series, what] = [this.#series, this.#what];
    const nameOf = (k) => (series.length > 1 ? `${series[k].name} ` : '');
    const values = this.#beside(index).map((p, k) => nameOf(k) + withUnit(p[1], what.y));
    return [withUnit(series[0].points[index][0], what.x), ...values, what.note?.(index)].filter(Boolean);
  }

  /** Shows what all series have at a point of the first; null: nothing. */
  read(index) {
    const { box, place, width } = this.#laid;
    this.#index = index;
    this.#tip.hidden = index === null;
    this.#hair.replaceChildren();
    if (index === null) return;
    const places = this.#beside(index).map(place);
    const [x] = places[0];
    const dots = places.filter(([, y]) => Number.isFinite(y)).map(([cx, cy]) => draw('circle', { cx, cy, r: 3 }));
    this.#hair.append(draw('line', { x1: x, x2: x, y1: box.top, y2: box.bottom }), ...dots);
    this.#tip.replaceChildren(...this.#words(index).map((text) => make('span', { textContent: text })));
    const isRight = x > width / 2;
    this.#tip.style.left = isRight ? 'auto' : `${x + 8}px`;
    this.#tip.style.right = isRight ? `${width - x + 8}px` : 'auto';
  }

  /** The same by the reader, who is told of it. */
  #tell(index) {
    this.read(index);
    this.#speak(index ?? 0);
    this.#what.onread?.(index);
  }

  #speak(index) {
    this.element.setAttribute('aria-valuenow', index);
    this.element.setAttribute('aria-valuetext', this.#words(index).join(', '));
  }

  /** To who does not see it: a slider is what a reader of charts by keyboard moves along them. */
  #describe() {
    const { title, x, y } = this.#what;
    const range = ({ low, high }) => `from ${number(low)} to ${number(high)}`;
    const attributes = {
      role: 'slider',
      'aria-label': `${title}: ${y}, ${range(this.#laid.y)}, against ${x}, ${range(this.#laid.x)}`,
      'aria-valuemin': '0',
      'aria-valuemax': String(this.#series[0].points.length - 1),
    };
    for (const [name, text] of Object.entries(attributes)) this.element.setAttribute(name, text);
    this.#speak(0);
  }

  #follow() {
    const { element } = this;
    element.addEventListener('pointermove', (event) => {
      const { left, right } = this.#laid.box;
      const at = event.clientX - element.getBoundingClientRect().left;
      this.#tell(this.#nearest(this.#series[0], (at - left) / (right - left)));
    });
    // A finger leaves when it rests.
    element.addEventListener('pointerleave', (event) => event.pointerType !== 'touch' && this.#tell(null));
    element.addEventListener('blur', () => this.#tell(null));
    element.addEventListener('keydown', (event) => {
      const last = this.#series[0].points.length - 1;
      const page = Math.max(1, Math.round(last / 10));
      const arrows = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1 };
      const by = { ...arrows, PageDown: -page, PageUp: page, Home: -last, End: last }[event.key];
      const index = this.#index;
      if (event.key === 'Escape') this.#tell(null);
      else if (by && index === null && Math.abs(by) === 1) this.#tell(0);
      else if (by) this.#tell(Math.min(last, Math.max(0, (index ?? 0) + by)));
      else return;
      event.preventDefault();
    });
  }
}

/**
 * all: [{points: [[x, y], …], name, kind: 'line' | 'area' | 'points', fit: [[x, y], …], tone: 0 | 1 | 2,
 * of lines also 3 | 'dem'}]; those without a point are not shown, and where a y is NaN a line has a gap. what: {title,
 * x, y (with their units, in brackets), logX, logY, wholeX, zeroX, zeroY, topY: what y reaches at least, height, least:
 * steps of each axis at least, flags: [[x, y], …] places with a sign above them, note(index): a further word of a
 * reading, onread(index or null): what is told of it}. An index is that of a point of the first series, from the left.
 * Gives {figure, read(index or null)}; a reading by `read` is not told.
 */
export function plot(all, what) {
  const series = all
    .map((s, k) => ({ tone: k, ...s, points: [...s.points].sort((a, b) => a[0] - b[0]) }))
    .filter((s) => s.points.some((p) => Number.isFinite(p[1])));
  const figure = make('figure', {}, make('figcaption', { textContent: what.title }));
  if (!series.length) {
    figure.append(make('p', { className: 'hint', textContent: 'nothing to show' }));
    return { figure, read: (_index) => {} };
  }
  const drawn = new Plot(series, what);
  figure.append(drawn.element);
  return { figure, read: (index) => drawn.read(index) };
}

export const chart = (series, what) => plot(series, what).figure;

/** A number with the unit that a name has in brackets. */
function withUnit(value, name) {
  const [, unit] = name.match(/\[(.*)\]/) ?? [null, ''];
  return number(value) + (unit && !'%°'.includes(unit) ? '\u00a0' : '') + unit;
}
