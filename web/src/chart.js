// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A small diagram in SVG: lines or points over labelled axes, with a reading under the pointer.

const space = 'http://www.w3.org/2000/svg';

export function number(value, digits = 4) {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  if (value !== 0 && (Math.abs(value) >= 1e9 || Math.abs(value) < 1e-4)) return value.toExponential(2);
  const decimals = Math.max(0, Math.min(6, digits - 1 - Math.floor(Math.log10(Math.abs(value) || 1))));
  return value.toLocaleString('en', { maximumFractionDigits: decimals }).replace(/,/g, '\u2009').replace('-', '\u2212');
}

function element(name, attributes = {}, text) {
  const e = document.createElementNS(space, name);
  for (const [key, value] of Object.entries(attributes)) e.setAttribute(key, value);
  if (text !== undefined) e.textContent = text;
  return e;
}

/** The largest of 1, 2, 5 times a power of ten that gives no fewer than `least` steps. */
function roundStep(span, least) {
  const power = 10 ** Math.floor(Math.log10(span / least));
  return [5, 2, 1].map((m) => m * power).find((step) => span / step >= least) ?? power;
}

function scale(values, log) {
  let low = Math.min(...values);
  let high = Math.max(...values);
  if (log) {
    low = 10 ** Math.floor(Math.log10(low) + 1e-9);
    high = 10 ** Math.ceil(Math.log10(high) - 1e-9);
    if (low === high) high *= 10;
    const ticks = [];
    for (let t = low; t <= high * 1.001; t *= 10) ticks.push(t);
    const decades = Math.log10(high) - Math.log10(low);
    return { low, high, ticks, share: (v) => (Math.log10(v) - Math.log10(low)) / decades };
  }
  if (!(high - low > 1e-9 * Math.max(Math.abs(low), Math.abs(high), 1e-9))) {
    const half = Math.max(0.5, Math.abs(high) * 0.01);
    low -= half;
    high += half;
  }
  const step = roundStep(high - low, 3);
  const ticks = [];
  for (let t = Math.ceil(low / step - 1e-9) * step; t <= high + 1e-9 * step; t += step) ticks.push(Math.abs(t) < 1e-9 * step ? 0 : t);
  return { low, high, ticks, share: (v) => (v - low) / (high - low) };
}

/**
 * series: [{points: [[x, y], …], name, kind: 'line' | 'area' | 'points', fit: [[x, y], [x, y]], tone: 0 | 1 | 2}]; those
 * without a point are not shown. what: {title, x, y, logX, logY, wholeX, zeroX, zeroY, legend}. Gives a figure.
 */
export function chart(all, what) {
  const series = all.filter((s) => s.points.length);
  const tone = (s, k) => s.tone ?? k;
  const width = 344;
  const height = what.height ?? 176;
  const box = { left: 52, top: 10, right: width - 12, bottom: height - 34 };
  const points = series.flatMap((s) => s.points.concat(s.fit ?? []));
  const figure = document.createElement('figure');
  const caption = document.createElement('figcaption');
  caption.textContent = what.title;
  figure.append(caption);
  if (points.length === 0) {
    figure.append(Object.assign(document.createElement('p'), { className: 'hint', textContent: 'nothing to show' }));
    return figure;
  }
  if (what.legend) figure.append(legend(series, tone));
  const x = scale(points.map((p) => p[0]).concat(what.zeroX ? [0] : []), what.logX);
  const y = scale(points.map((p) => p[1]).concat(what.zeroY ? [0] : []), what.logY);
  if (what.wholeX) {
    x.low -= 0.3;
    x.high += 0.3;
    x.ticks = x.ticks.filter(Number.isInteger);
    x.share = (v) => (v - x.low) / (x.high - x.low);
  }
  const place = ([a, b]) => [box.left + x.share(a) * (box.right - box.left), box.bottom - y.share(b) * (box.bottom - box.top)];
  const range = (s) => `from ${number(s.low)} to ${number(s.high)}`;
  const svg = element('svg', { viewBox: `0 0 ${width} ${height}`, role: 'img',
    'aria-label': `${what.title}: ${what.y}, ${range(y)}, against ${what.x}, ${range(x)}` });
  for (const t of y.ticks) {
    const at = place([x.low, t])[1];
    svg.append(element('line', { class: 'grid', x1: box.left, x2: box.right, y1: at, y2: at }));
    svg.append(element('text', { class: 'tick', x: box.left - 6, y: at + 3.5, 'text-anchor': 'end' }, number(t, 3)));
  }
  for (const t of x.ticks) {
    const at = place([t, y.low])[0];
    svg.append(element('line', { class: 'grid', x1: at, x2: at, y1: box.top, y2: box.bottom }));
    svg.append(element('text', { class: 'tick', x: at, y: box.bottom + 14, 'text-anchor': 'middle' }, number(t, 3)));
  }
  svg.append(element('text', { class: 'name', x: (box.left + box.right) / 2, y: height - 4, 'text-anchor': 'middle' }, what.x));
  svg.append(element('text', { class: 'name', x: 11, y: (box.top + box.bottom) / 2, 'text-anchor': 'middle',
    transform: `rotate(-90 11 ${(box.top + box.bottom) / 2})` }, what.y));
  series.forEach((s, k) => {
    const path = (list) => list.map((p, i) => `${i ? 'L' : 'M'}${place(p).map((v) => v.toFixed(1)).join(' ')}`).join('');
    if (s.kind === 'area') {
      const floor = y.low < 0 && y.high > 0 ? 0 : y.low;
      svg.append(element('path', { class: 'area', d: `${path(s.points)}L${place([s.points.at(-1)[0], floor]).join(' ')}L${place([s.points[0][0], floor]).join(' ')}Z` }));
    }
    if (s.fit) svg.append(element('path', { class: `fit s${tone(s, k)}`, d: path(s.fit) }));
    if (s.kind === 'points') s.points.forEach((p) => svg.append(element('circle', { class: `s${tone(s, k)}`, cx: place(p)[0], cy: place(p)[1], r: 3.5 })));
    else svg.append(element('path', { class: `line s${tone(s, k)}`, d: path(s.points) }));
  });
  figure.append(svg);
  figure.append(reading(svg, series, what, { x, place, box, width }));
  return figure;
}

/** Bars side by side: by name one of each of the series [{name, values}]. Gives a figure. */
export function bars(names, series, what) {
  const width = 344;
  const left = 64;
  const bar = 6;
  const step = bar * series.length + 7;
  const top = 4;
  const height = top + names.length * step + 22;
  const x = scale(series.flatMap((s) => s.values).concat([0]));
  const place = (v) => left + x.share(v) * (width - 12 - left);
  const figure = document.createElement('figure');
  figure.append(Object.assign(document.createElement('figcaption'), { textContent: what.title }), legend(series, (s, k) => k));
  const told = names.map((name, i) => `${name} ${series.map((s) => `${s.name} ${number(s.values[i], 3)}`).join(', ')}`).join('; ');
  const svg = element('svg', { viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': `${what.title}, ${what.unit}: ${told}` });
  for (const t of x.ticks) {
    svg.append(element('line', { class: 'grid', x1: place(t), x2: place(t), y1: 0, y2: height - 20 }));
    svg.append(element('text', { class: 'tick', x: place(t), y: height - 8, 'text-anchor': 'middle' }, number(t, 3)));
  }
  svg.append(element('text', { class: 'name', x: 0, y: height - 8 }, what.unit));
  names.forEach((name, i) => {
    svg.append(element('text', { class: 'tick', x: left - 6, y: top + i * step + (step - 4) / 2 + 2, 'text-anchor': 'end' }, name));
    series.forEach((s, k) => svg.append(element('rect', { class: `bar s${k}`, x: left, y: top + i * step + k * bar,
      width: Math.max(place(s.values[i]) - left, 0).toFixed(1), height: bar - 1 })));
  });
  figure.append(svg);
  return figure;
}

/** Which mark is whose. */
function legend(series, tone) {
  const line = document.createElement('p');
  line.className = 'marks';
  series.forEach((s, k) => {
    const mark = element('svg', { viewBox: '0 0 10 10', 'aria-hidden': 'true' });
    mark.append(element('circle', { class: `s${tone(s, k)}`, cx: 5, cy: 5, r: 3.5 }));
    const words = document.createElement('span');
    words.append(mark, s.name);
    line.append(words);
  });
  return line;
}

/** What the series have where the pointer stands. */
function reading(svg, series, what, { x, place, box, width }) {
  const words = document.createElement('p');
  words.className = 'reading';
  words.textContent = '\u00a0';
  const hair = element('line', { class: 'hair', y1: box.top, y2: box.bottom, visibility: 'hidden' });
  svg.append(hair);
  svg.addEventListener('pointermove', (event) => {
    const frame = svg.getBoundingClientRect();
    const at = ((event.clientX - frame.left) / frame.width) * width;
    const wanted = (at - box.left) / (box.right - box.left);
    const off = (p) => Math.abs(x.share(p[0]) - wanted);
    const nearest = series.map((s) => s.points.reduce((best, p) => (off(p) < off(best) ? p : best)));
    const [px] = place(nearest[0]);
    hair.setAttribute('x1', px);
    hair.setAttribute('x2', px);
    hair.setAttribute('visibility', 'visible');
    words.textContent = `${what.x} ${number(nearest[0][0])}: ` +
      series.map((s, k) => `${s.name ?? what.y} ${number(nearest[k][1])}`).join(', ');
  });
  svg.addEventListener('pointerleave', () => {
    hair.setAttribute('visibility', 'hidden');
    words.textContent = '\u00a0';
  });
  return words;
}
