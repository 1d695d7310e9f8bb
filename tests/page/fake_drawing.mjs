// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What `thalweg studio` does with the verbs of drawing, by rules that are simple enough for tests of the page alone.
import path from 'node:path';
import { pathToFileURL } from 'node:url';
import { web } from './browser.mjs';

const { bent, meeting } = await import(pathToFileURL(path.join(web, 'src/drawing.js')));
const { foot } = await import(pathToFileURL(path.join(web, 'src/rivers.js')));

export const sheet = (more) => ({ kind: 'drawn', branching: false, rivers: [], coasts: [], lakes: [], masks: [], pins: [], ridges: [], ...more });
export const river = (...line) => ({ line, type: '', lambda: 0 });

class Refusal extends Error {
  constructor(text, at) {
    super(text);
    this.at = at;
  }
}

const reach = 2; // cells within which an end joins
const off = (ax, ay, bx, by) => Math.hypot(ax - bx, ay - by);

/** The river that an end meets: {n, i, x, y}; i: it lies before this vertex. */
function joined(rivers, x, y, except = -1) {
  let best = null;
  rivers.forEach(({ line }, n) => {
    for (let i = 2; n !== except && i < line.length; i += 2) {
      const at = foot(x, y, line[i - 2], line[i - 1], line[i], line[i + 1]);
      if (at.d < (best?.d ?? reach)) best = { n, i: i / 2, ...at };
    }
  });
  return best;
}

/** Makes the place a vertex of the river that it meets, unless it is one. */
function meet(rivers, { n, i, x, y }) {
  const { line } = rivers[n];
  const k = [i - 1, i].find((v) => off(line[2 * v], line[2 * v + 1], x, y) < 1e-9);
  if (k === undefined) rivers[n] = { ...rivers[n], line: [...line.slice(0, 2 * i), x, y, ...line.slice(2 * i)] };
  return k === undefined ? [x, y] : [line[2 * k], line[2 * k + 1]];
}

function refuseCrossings(rivers, line) {
  const length = line.length;
  for (let i = 2; i < length; i += 2) {
    for (const { line: other } of rivers) {
      for (let k = 2; k < other.length; k += 2) {
        const t = meeting(line[i - 2], line[i - 1], line[i], line[i + 1], other[k - 2], other[k - 1], other[k], other[k + 1]);
        const at = [line[i - 2] + t * (line[i] - line[i - 2]), line[i - 1] + t * (line[i + 1] - line[i - 1])];
        if (t >= 0 && off(...at, line[0], line[1]) > reach && off(...at, ...line.slice(-2)) > reach) throw new Refusal('the river would cross another one here', at);
      }
    }
  }
}

const reversed = (line) => line.reduce((all, _, i) => (i % 2 ? all : [line[i], line[i + 1], ...all]), []);
const copy = (drawing) => ({ ...structuredClone(drawing), kind: 'drawn' });
const below = ({ rivers }, n) => rivers.findIndex(({ line }, k) => k !== n && line.some((v, i) => i % 2 === 0 && v === rivers[n].line.at(-2) && line[i + 1] === rivers[n].line.at(-1)));

const verbs = {
  river(now, { points, type, lambda }, said) {
    if (points.length < 4) throw new Refusal('a river needs two places', points);
    refuseCrossings(now.rivers, points);
    let line = points;
    const [a, b] = [joined(now.rivers, line[0], line[1]), joined(now.rivers, ...line.slice(-2))];
    if (a && !b) {
      line = reversed(line);
      said.push(`the river was turned: it ends at river ${a.n + 1}`);
    }
    const end = b ?? a;
    if (end) line = [...line.slice(0, -2), ...meet(now.rivers, end)];
    now.rivers.push({ line, type, lambda });
  },
  list: (now, of) => {
    const [kind, n] = Object.entries(of)[0];
    const where = now[`${kind}s`];
    const name = { river: 'line', ridge: 'line', lake: 'ring', pin: 'at' }[kind];
    const line = name ? where[n][name] : where[n];
    const put = (next) => (where[n] = name ? { ...where[n], [name]: next } : next);
    return { line, put, kind, n };
  },
  move(now, { of, vertex, to, reach: soft }) {
    const { line, put, kind, n } = verbs.list(now, of);
    let next = bent(line, vertex, to, soft, kind === 'lake' || kind === 'mask');
    const end = kind === 'river' && vertex === line.length / 2 - 1 && joined(now.rivers, ...to, n);
    if (end) next = [...next.slice(0, -2), ...meet(now.rivers, end)];
    put(next);
  },
  insert(now, { of, vertex, at }) {
    const { line, put } = verbs.list(now, of);
    put([...line.slice(0, 2 * vertex), ...at, ...line.slice(2 * vertex)]);
  },
  remove(now, { of, vertex }) {
    const { line, put } = verbs.list(now, of);
    put([...line.slice(0, 2 * vertex), ...line.slice(2 * vertex + 2)]);
  },
  cut(now, { river: n, at }) {
    const { line } = now.rivers[n];
    const { i, x, y } = joined([now.rivers[n]], ...at);
    now.rivers[n] = { ...now.rivers[n], line: [x, y, ...line.slice(2 * i)] };
    now.rivers.push({ ...now.rivers[n], line: [...line.slice(0, 2 * i), x + 3 * (line[2 * i - 2] - x) / off(line[2 * i - 2], line[2 * i - 1], x, y), y + 3 * (line[2 * i - 1] - y) / off(line[2 * i - 2], line[2 * i - 1], x, y)] });
  },
  join(now, { river: n, end, at }) {
    const met = joined(now.rivers, ...at, n);
    if (!met) throw new Refusal('there is no river here', at);
    const to = meet(now.rivers, met);
    const { line } = now.rivers[n];
    now.rivers[n] = { ...now.rivers[n], line: end === 'outlet' ? [...line, ...to] : [...reversed(line), ...to] };
  },
  reverse(now, { river: n }) {
    now.rivers[n] = { ...now.rivers[n], line: reversed(now.rivers[n].line) };
  },
  erase(now, { verb: _, alone, ...of }) {
    const [kind, n] = Object.entries(of)[0];
    const gone = new Set([n]);
    if (kind === 'river' && !alone) for (let grew = true; grew;) grew = now.rivers.some((_, k) => !gone.has(k) && gone.has(below(now, k)) && gone.add(k));
    now[`${kind}s`] = now[`${kind}s`].filter((_, k) => !gone.has(k));
  },
  type: (now, { rivers, type }) => rivers.forEach((n) => (now.rivers[n].type = type)),
  lambda: (now, { rivers, lambda }) => rivers.forEach((n) => (now.rivers[n].lambda = lambda)),
  branching: (now, { on }) => (now.branching = on),
  coast(now, { points }) {
    const closed = off(points[0], points[1], ...points.slice(-2)) < 4;
    now.coasts.push(closed && off(points[0], points[1], ...points.slice(-2)) > 0 ? [...points, points[0], points[1]] : points);
  },
  swap: (now, { coast }) => (now.coasts[coast] = reversed(now.coasts[coast])),
  lake: (now, { points, level }) => now.lakes.push({ ring: points, level }),
  level: (now, { lake, level }) => (now.lakes[lake].level = level),
  mask: (now, { points }) => now.masks.push(points),
  pin(now, { at, height }) {
    if (joined(now.rivers, ...at)?.d < 0.75) throw new Refusal('a river runs here, and its height decides: set the pin beside it', at);
    now.pins.push({ at, height });
  },
  height: (now, { pin, height }) => (now.pins[pin] = { ...now.pins[pin], height }),
  ridge(now, { points }) {
    refuseCrossings(now.rivers, points);
    now.ridges.push({ line: points, from: null, to: null });
  },
  heights: (now, { ridge, from, to }) => (now.ridges[ridge] = { ...now.ridges[ridge], from, to }),
  clear: (now) => Object.assign(now, { rivers: [], coasts: [], lakes: [], masks: [], pins: [], ridges: [] }),
};

/** The drawing after a verb, and what there is to say of it; throws what is refused, with a place. */
export function drawnBy(drawing, what) {
  const next = copy(drawing);
  const said = [];
  if (!verbs[what.verb]) throw new Refusal(`unknown verb '${what.verb}'`);
  verbs[what.verb](next, what, said);
  return { next, said };
}
