// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The network: which arcs a pruning length keeps, and the orders of those.
import { unpackLines } from './unpack.js';

export class Rivers {
  constructor(about, ridges, base64) {
    const arcs = about.arcs;
    this.arcs = arcs;
    this.count = arcs.id.length;
    this.prune = about.prune;
    const counts = arcs.n.concat(ridges ? ridges.n : []);
    const lines = unpackLines(base64, counts, about.step);
    this.lines = lines.slice(0, this.count);
    this.ridges = lines.slice(this.count);
    this.survives = Float64Array.from(arcs.survives, (s) => (s === null ? Infinity : s));
    const place = new Map(arcs.id.map((id, k) => [id, k]));
    this.downstream = Int32Array.from(arcs.ds, (ds) => (ds === 0 ? -1 : place.get(ds)));
    this.upstreamFirst = this.#sorted();
    this.strahler = Int32Array.from(arcs.strahler);
    this.highest = Math.max(0, ...this.strahler);
  }

  /** Arc numbers, every arc after all that flow into it. */
  #sorted() {
    const waiting = new Int32Array(this.count);
    for (const d of this.downstream) if (d >= 0) ++waiting[d];
    const order = [];
    for (let k = 0; k < this.count; ++k) if (waiting[k] === 0) order.push(k);
    for (let i = 0; i < order.length; ++i) {
      const d = this.downstream[order[i]];
      if (d >= 0 && --waiting[d] === 0) order.push(d);
    }
    return order;
  }

  /** The largest length at which something goes, of arcs that may go at all. */
  get longest() {
    let longest = 0;
    for (const s of this.survives) if (Number.isFinite(s)) longest = Math.max(longest, s);
    return longest;
  }

  /** Arcs kept when streams shorter than L cells are pruned, and their Strahler orders (0 = gone). */
  kept(L) {
    const keeps = (k) => this.survives[k] >= L;
    const orders = new Int32Array(this.count);
    const best = new Int32Array(this.count); // highest order that flows in
    const twice = new Uint8Array(this.count);
    let kept = 0;
    for (const k of this.upstreamFirst) {
      if (!keeps(k)) continue;
      ++kept;
      orders[k] = best[k] === 0 ? 1 : best[k] + twice[k];
      const d = this.downstream[k];
      if (d < 0) continue;
      if (orders[k] > best[d]) {
        best[d] = orders[k];
        twice[d] = 0;
      } else if (orders[k] === best[d]) {
        twice[d] = 1;
      }
    }
    return { kept, orders };
  }

  /** Arcs from one down to the outlet. */
  path(arc) {
    const path = [];
    for (let k = arc; k >= 0; k = this.downstream[k]) path.push(k);
    return path;
  }
}

/** Finds the kept arc nearest to a place: segments in square tiles. */
export class ArcFinder {
  constructor(rivers, grid) {
    this.rivers = rivers;
    this.tile = Math.max(8, Math.max(grid.width, grid.height) / 128);
    this.columns = Math.ceil(grid.width / this.tile) + 1;
    this.tiles = new Map();
    rivers.lines.forEach((line, k) => {
      for (let i = 2; i < line.length; i += 2) {
        const c0 = Math.floor(Math.min(line[i - 2], line[i]) / this.tile);
        const c1 = Math.floor(Math.max(line[i - 2], line[i]) / this.tile);
        const r0 = Math.floor(Math.min(line[i - 1], line[i + 1]) / this.tile);
        const r1 = Math.floor(Math.max(line[i - 1], line[i + 1]) / this.tile);
        for (let r = r0; r <= r1; ++r) {
          for (let c = c0; c <= c1; ++c) {
            const key = r * this.columns + c;
            if (!this.tiles.has(key)) this.tiles.set(key, []);
            this.tiles.get(key).push(k, i);
          }
        }
      }
    });
  }

  /** Segments about a straight line, some of them more than once: [arc, index of its end in the arc's line]. */
  * between(ax, ay, bx, by) {
    const [c0, c1, r0, r1] = [Math.min(ax, bx), Math.max(ax, bx), Math.min(ay, by), Math.max(ay, by)].map((v) =>
      Math.floor(v / this.tile),
    );
    for (let r = r0; r <= r1; ++r) {
      for (let c = c0; c <= c1; ++c) {
        const list = this.tiles.get(r * this.columns + c) ?? [];
        for (let j = 0; j < list.length; j += 2) yield [list[j], list[j + 1]];
      }
    }
  }

  /** Arc number within reach [cells], or -1. orders: as kept() gives them. */
  nearest(x, y, reach, orders) {
    let found = -1;
    let least = reach;
    const span = Math.ceil(reach / this.tile);
    const column = Math.floor(x / this.tile);
    const row = Math.floor(y / this.tile);
    for (let r = row - span; r <= row + span; ++r) {
      for (let c = column - span; c <= column + span; ++c) {
        const list = this.tiles.get(r * this.columns + c) ?? [];
        for (let j = 0; j < list.length; j += 2) {
          if (orders[list[j]] === 0) continue;
          const line = this.rivers.lines[list[j]];
          const i = list[j + 1];
          const { d } = foot(x, y, line[i - 2], line[i - 1], line[i], line[i + 1]);
          if (d < least) {
            least = d;
            found = list[j];
          }
        }
      }
    }
    return found;
  }
}

/** The place of a segment that is nearest to another place: {x, y, d: distance}. */
export function foot(x, y, ax, ay, bx, by) {
  const [dx, dy] = [bx - ax, by - ay];
  const along = dx || dy ? Math.min(1, Math.max(0, ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy))) : 0;
  const [fx, fy] = [ax + along * dx, ay + along * dy];
  return { x: fx, y: fy, d: Math.hypot(x - fx, y - fy) };
}
