// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What is drawn, as the program tells it, and the geometry of what the page shows while one draws. Places are cells of
// the grid. Nothing here decides: what the page calls a crossing the program judges again.
import { foot } from './rivers.js';

/** Where a–b meets c–d, as a share of a–b; -1: nowhere. */
export function meeting(ax, ay, bx, by, cx, cy, dx, dy) {
  const [ux, uy, vx, vy] = [bx - ax, by - ay, dx - cx, dy - cy];
  const turn = ux * vy - uy * vx;
  if (turn === 0) return -1;
  const t = ((cx - ax) * vy - (cy - ay) * vx) / turn;
  const s = ((cx - ax) * uy - (cy - ay) * ux) / turn;
  return t >= 0 && t <= 1 && s >= 0 && s <= 1 ? t : -1;
}

export function lengthOf(line) {
  let length = 0;
  for (let i = 2; i < line.length; i += 2) length += Math.hypot(line[i] - line[i - 2], line[i + 1] - line[i - 1]);
  return length;
}

export function inside(x, y, ring) {
  let is = false;
  for (let i = 0, j = ring.length - 2; i < ring.length; j = i, i += 2) {
    if (
      ring[i + 1] > y !== ring[j + 1] > y &&
      x < ring[i] + ((y - ring[i + 1]) / (ring[j + 1] - ring[i + 1])) * (ring[j] - ring[i])
    ) {
      is = !is;
    }
  }
  return is;
}

/**
 * A line whose vertex went to a place; its neighbours within reach [cells] along the line follow, the less the farther.
 */
export function bent(line, vertex, to, reach, closed) {
  const next = Array.from(line);
  const count = line.length / 2;
  const [x, y] = [to[0] - line[2 * vertex], to[1] - line[2 * vertex + 1]];
  next[2 * vertex] = to[0];
  next[2 * vertex + 1] = to[1];
  for (const step of [-1, 1]) {
    let along = 0;
    for (let k = vertex, i = 1; i < count; ++i) {
      const n = closed ? (k + step + count) % count : k + step;
      if (n < 0 || n >= count) break;
      along += Math.hypot(line[2 * n] - line[2 * k], line[2 * n + 1] - line[2 * k + 1]);
      if (along >= reach || (!closed && (n === 0 || n === count - 1))) break; // ends stay where they join
      const share = (1 - (along / reach) ** 2) ** 2;
      next[2 * n] += share * x;
      next[2 * n + 1] += share * y;
      k = n;
    }
  }
  return next;
}

/** A line cut at a place between the vertices i - 1 and i; gives its first part. */
export const upTo = (line, i, { x, y }) => [...line.slice(0, 2 * i), x, y];

/** Numbers of segments by square tiles. */
class Tiles {
  #tiles = new Map();

  constructor(side, columns, rows) {
    this.side = side;
    this.columns = columns;
    this.rows = rows;
  }

  /** What lies beside the grid, as masks and lakes of files may far, counts to the tiles at its edge. */
  *#over(x0, y0, x1, y1) {
    const within = (v, most) => Math.min(Math.max(Math.floor(v / this.side), 0), most - 1);
    const [r1, c0, c1] = [
      within(Math.max(y0, y1), this.rows),
      within(Math.min(x0, x1), this.columns),
      within(Math.max(x0, x1), this.columns),
    ];
    for (let r = within(Math.min(y0, y1), this.rows); r <= r1; ++r) {
      for (let c = c0; c <= c1; ++c) yield r * this.columns + c;
    }
  }

  add(object, i, line) {
    for (const key of this.#over(line[i - 2], line[i - 1], line[i], line[i + 1])) {
      if (!this.#tiles.has(key)) this.#tiles.set(key, []);
      this.#tiles.get(key).push(object, i);
    }
  }

  /** Segments about a box, some of them more than once: each(object, place of the second vertex in its outline). */
  about(x0, y0, x1, y1, each) {
    for (const key of this.#over(x0, y0, x1, y1)) {
      const list = this.#tiles.get(key) ?? [];
      for (let k = 0; k < list.length; k += 2) each(list[k], list[k + 1]);
    }
  }
}

/**
 * The program's message `drawing` as objects: {kind: 'river' | 'coast' | 'lake' | 'mask' | 'pin' | 'ridge', n: its
 * number, line: vertices, outline: the same, closed where it is a ring (a pin is a ring of one vertex), closed, and of
 * the message what else there is}.
 */
export class Drawing {
  #tiles = null;
  #downstream = null;

  constructor(message) {
    const { grid, kind, branching, revision, rivers, coasts, lakes, masks, pins, ridges } = message;
    this.message = message;
    this.grid = grid;
    this.kind = kind;
    this.branching = branching;
    this.revision = revision;
    const ring = (line) => ({ line, outline: [...line, line[0], line[1]], closed: true });
    const coast = (line) => {
      const closed = line.length > 6 && line[0] === line.at(-2) && line[1] === line.at(-1);
      return closed ? { line: line.slice(0, -2), outline: line, closed } : { line, outline: line, closed };
    };
    this.rivers = rivers.map(({ line, type, lambda }, n) => ({
      kind: 'river',
      n,
      line,
      outline: line,
      closed: false,
      type,
      lambda,
    }));
    this.coasts = coasts.map((line, n) => ({ kind: 'coast', n, ...coast(line) }));
    this.lakes = lakes.map((lake, n) => ({ kind: 'lake', n, ...ring(lake.ring), level: lake.level }));
    this.masks = masks.map((line, n) => ({ kind: 'mask', n, ...ring(line) }));
    this.pins = pins.map(({ at, height }, n) => ({ kind: 'pin', n, ...ring(at), height }));
    this.ridges = ridges.map(({ line, from, to }, n) => ({
      kind: 'ridge',
      n,
      line,
      outline: line,
      closed: false,
      from,
      to,
    }));
    this.objects = [...this.rivers, ...this.ridges, ...this.coasts, ...this.lakes, ...this.masks, ...this.pins];
  }

  get empty() {
    return this.objects.length === 0;
  }

  get tiles() {
    if (this.#tiles) return this.#tiles;
    const side = Math.max(8, Math.max(this.grid.width, this.grid.height) / 128);
    this.#tiles = new Tiles(side, Math.ceil(this.grid.width / side) + 2, Math.ceil(this.grid.height / side) + 2);
    for (const object of this.objects) {
      for (let i = 2; i < object.outline.length; i += 2) this.#tiles.add(object, i, object.outline);
    }
    return this.#tiles;
  }

  /**
   * The nearest place of an object that is accepted, within reach [cells]: {object, i: vertex after it, x, y, d}, or
   * null.
   */
  nearest({ x, y }, reach, accept = (_object) => true) {
    let found = null;
    this.tiles.about(x - reach, y - reach, x + reach, y + reach, (object, i) => {
      if (!accept(object)) return;
      const line = object.outline;
      const at = foot(x, y, line[i - 2], line[i - 1], line[i], line[i + 1]);
      if (at.d < (found?.d ?? reach)) found = { object, i: i / 2, ...at };
    });
    return found;
  }

  /** The first place where a–b meets an object that is accepted: {object, x, y, t}, or null. */
  crossed(ax, ay, bx, by, accept) {
    let found = null;
    this.tiles.about(ax, ay, bx, by, (object, i) => {
      if (!accept(object)) return;
      const line = object.outline;
      const t = meeting(ax, ay, bx, by, line[i - 2], line[i - 1], line[i], line[i + 1]);
      if (t >= 0 && t < (found?.t ?? 2)) found = { object, t, x: ax + t * (bx - ax), y: ay + t * (by - ay) };
    });
    return found;
  }

  /** By river the number of the one that it flows into, or -1: the last vertex of one is a vertex of the other. */
  get downstream() {
    if (this.#downstream) return this.#downstream;
    const below = (this.#downstream = new Int32Array(this.rivers.length).fill(-1));
    const ends = new Map(); // by x, as numbers of rivers
    for (const { n, line } of this.rivers) {
      const x = line.at(-2);
      if (ends.has(x)) ends.get(x).push(n);
      else ends.set(x, [n]);
    }
    for (const { n: other, line } of this.rivers) {
      for (let i = 0; i < line.length; i += 2) {
        for (const n of ends.get(line[i]) ?? []) {
          // Where two rivers end together, the later one flows into the earlier one.
          const joins = this.rivers[n].line.at(-1) === line[i + 1] && n !== other && (i < line.length - 2 || other < n);
          if (joins && below[n] < 0) below[n] = other;
        }
      }
    }
    return below;
  }

  /** A river with all that drain into it. */
  above(river) {
    const into = this.rivers.map(() => []);
    this.downstream.forEach((below, n) => into[below]?.push(this.rivers[n]));
    const all = new Set([river]);
    for (const one of all) for (const next of into[one.n]) all.add(next);
    return [...all];
  }

  /** An object with another line, as it will be. */
  like(object, line) {
    return { ...object, line, outline: object.closed ? [...line, line[0], line[1]] : line };
  }

  /**
   * What an object of an older drawing is in this one: the same line, or where asked for the one most like it; null: it
   * is gone.
   */
  same(object, alike = false) {
    const all = this[`${object.kind}s`];
    // What the page made of a step differs from what the program made by less than it rounds.
    const { line } = object;
    const exact = [all[object.n], ...all].find(
      (one) => one && one.line.length === line.length && one.line.every((v, i) => Math.abs(v - line[i]) < 2e-3),
    );
    if (exact || !alike) return exact ?? null;
    const spots = (ends) => [ends.slice(0, 2), ends.slice(2 * Math.floor(ends.length / 4)), ends.slice(-2)];
    const off = (some, others) =>
      some.reduce((sum, [x, y], i) => sum + Math.hypot(x - others[i][0], y - others[i][1]), 0);
    const wanted = spots(object.line);
    const unlike = (one) => Math.min(off(spots(one.line), wanted), off(spots(one.line).reverse(), wanted));
    const best = all.reduce((least, one) => (unlike(one) < (least ? unlike(least) : Infinity) ? one : least), null);
    if (best && unlike(best) < 0.15 * (lengthOf(object.line) + 10)) return best;
    // It may be a piece of a longer one now.
    const middle = 2 * Math.floor(object.line.length / 4);
    return (
      this.nearest({ x: object.line[middle], y: object.line[middle + 1] }, 1, ({ kind }) => kind === object.kind)
        ?.object ?? null
    );
  }
}
