// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What is measured on the land: along lines, across valleys, upstream of a place. Places are [x, y] in cells from the
// north-west, lengths and heights in metres.
import { foot } from './rivers.js';

const degrees = (slope) => (Math.atan(slope) * 180) / Math.PI;
const most = 4000; // samples along a line
const side = (land) => land.grid.cell_m;

/** The height at a place, the sea's at sea; NaN where there is none. Bilinear between centres of the page's values. */
export function heightOf(land, x, y) {
  if (land.level || !land.inside(x, y)) return NaN;
  return land.known(x, y) ? land.heightAt(x, y) : (land.sea?.level ?? NaN);
}

/** The lowest value beside a place: rivers run between the centres of values, in the lowest of them. */
function lowestBeside(land, x, y) {
  const column = Math.min(Math.floor(x / land.cells), land.width - 1);
  const row = Math.min(Math.floor(y / land.cells), land.height - 1);
  let low = Infinity;
  for (let r = Math.max(0, row - 1); r <= Math.min(row + 1, land.height - 1); ++r) {
    for (let c = Math.max(0, column - 1); c <= Math.min(column + 1, land.width - 1); ++c) {
      const i = r * land.width + c;
      if (!land.has || land.has[i]) low = Math.min(low, land.z[i]);
    }
  }
  return low < Infinity ? low : heightOf(land, x, y);
}

/** Length of a line [cells]. */
export function lengthOf(line) {
  let length = 0;
  for (let i = 1; i < line.length; ++i) length += Math.hypot(line[i][0] - line[i - 1][0], line[i][1] - line[i - 1][1]);
  return length;
}

/** Places evenly along a line, both ends among them, at most `apart` [cells] from one to the next: [{d [m], x, y}]. */
export function spread(land, line, apart, limit = most) {
  const length = lengthOf(line);
  const n = Math.max(1, Math.min(limit, Math.ceil(length / apart - 1e-9)));
  const places = [];
  let leg = 0;
  let behind = 0; // length of the legs before
  for (let k = 0; k <= n; ++k) {
    const at = (length * k) / n;
    let long = 0;
    for (;; ++leg) {
      long = leg + 1 < line.length ? Math.hypot(line[leg + 1][0] - line[leg][0], line[leg + 1][1] - line[leg][1]) : 0;
      if (leg + 2 >= line.length || behind + long >= at) break;
      behind += long;
    }
    const share = long > 0 ? Math.min(1, (at - behind) / long) : 0;
    const [x, y] = line[leg];
    const [u, v] = line[Math.min(leg + 1, line.length - 1)];
    places.push({ d: at * side(land), x: x + share * (u - x), y: y + share * (v - y) });
  }
  return places;
}

/** Heights along a line, two a value: [{d, x, y, z}]. */
export function along(land, line) {
  return spread(land, line, land.cells / 2).map((p) => ({ ...p, z: heightOf(land, p.x, p.y) }));
}

/** Of heights along a line: length in plan and over the ground, what is climbed and lost, greatest slope [°]. */
export function sums(points) {
  const out = {
    length: points.at(-1).d - points[0].d,
    ground: 0,
    up: 0,
    down: 0,
    steepest: 0,
    low: Infinity,
    high: -Infinity,
    gaps: false,
  };
  points.forEach(({ d, z }, i) => {
    if (Number.isNaN(z)) out.gaps = true;
    else Object.assign(out, { low: Math.min(out.low, z), high: Math.max(out.high, z) });
    if (i === 0) return;
    const run = d - points[i - 1].d;
    const rise = z - points[i - 1].z;
    out.ground += Number.isNaN(rise) ? run : Math.hypot(run, rise);
    if (rise > 0) out.up += rise;
    else if (rise < 0) out.down -= rise;
    if (run > 0 && Math.abs(rise) / run > out.steepest) out.steepest = Math.abs(rise) / run;
  });
  return { ...out, steepest: degrees(out.steepest) };
}

/**
 * Rivers that a line crosses, from its beginning: [{d, x, y, arc, order, area [m2]}]. orders: as rivers.kept() gives
 * them.
 */
export function crossings(land, line, { rivers, orders, finder }) {
  const found = [];
  const seen = new Set();
  let behind = 0;
  for (let leg = 1; leg < line.length; ++leg) {
    const [[ax, ay], [bx, by]] = [line[leg - 1], line[leg]];
    const long = Math.hypot(bx - ax, by - ay);
    for (const [arc, i] of finder.between(ax, ay, bx, by)) {
      if (orders[arc] === 0) continue;
      const river = rivers.lines[arc];
      const [px, py, qx, qy] = [river[i - 2], river[i - 1], river[i], river[i + 1]];
      const across = (bx - ax) * (qy - py) - (by - ay) * (qx - px);
      if (across === 0) continue;
      const t = ((px - ax) * (qy - py) - (py - ay) * (qx - px)) / across;
      const s = ((px - ax) * (by - ay) - (py - ay) * (bx - ax)) / across;
      const lastLeg = leg + 1 === line.length;
      const lastPart = i + 2 === river.length;
      if (t < 0 || s < 0 || t > 1 || s > 1 || (t === 1 && !lastLeg) || (s === 1 && !lastPart)) continue;
      const key = `${leg} ${arc} ${i}`;
      if (seen.has(key)) continue;
      seen.add(key);
      found.push({
        d: (behind + t * long) * side(land),
        x: ax + t * (bx - ax),
        y: ay + t * (by - ay),
        arc,
        order: orders[arc],
        area: areaAt(rivers, arc, i, s),
      });
    }
    behind += long;
  }
  return found.sort((a, b) => a.d - b.d);
}

/** The area that an arc drains within one of its segments: between those of its ends, by length. */
function areaAt({ arcs, lines }, arc, segment, share) {
  const line = lines[arc];
  let before = 0;
  let whole = 0;
  for (let i = 2; i < line.length; i += 2) {
    const long = Math.hypot(line[i] - line[i - 2], line[i + 1] - line[i - 1]);
    whole += long;
    if (i < segment) before += long;
    else if (i === segment) before += share * long;
  }
  return arcs.us_area[arc] + (whole > 0 ? before / whole : 1) * (arcs.ds_area[arc] - arcs.us_area[arc]);
}

/** Kept arcs that flow into one. */
function inflows(rivers, orders, arc) {
  const all = [];
  rivers.downstream.forEach((d, k) => d === arc && orders[k] > 0 && all.push(k));
  return all;
}

/**
 * The river of an arc, from its farthest source by drained area to its outlet: {line, arcs, joins: [{x, y, arc, order,
 * area}]}.
 */
export function riverOf({ rivers, orders }, arc) {
  const largest = (list) =>
    list.reduce((best, k) => (best < 0 || rivers.arcs.ds_area[k] > rivers.arcs.ds_area[best] ? k : best), -1);
  let head = arc;
  for (let above = arc; above >= 0; above = largest(inflows(rivers, orders, above))) head = above;
  const arcs = rivers.path(head);
  const line = [];
  const joins = [];
  for (const k of arcs) {
    const part = rivers.lines[k];
    for (let i = 0; i < part.length; i += 2) {
      if (line.length === 0 || part[i] !== line.at(-1)[0] || part[i + 1] !== line.at(-1)[1]) {
        line.push([part[i], part[i + 1]]);
      }
    }
    const { 0: x, 1: y } = part;
    for (const other of inflows(rivers, orders, k)) {
      if (!arcs.includes(other)) {
        joins.push({ x, y, arc: other, order: orders[other], area: rivers.arcs.ds_area[other] });
      }
    }
  }
  return { line, arcs, joins };
}

/** The place of a line that is nearest to another: {x, y, part: number of the segment, d: distance}. */
export function nearestOn(line, x, y) {
  let best = { x: line[0][0], y: line[0][1], part: 0, d: Infinity };
  for (let i = 1; i < line.length; ++i) {
    const near = foot(x, y, ...line[i - 1], ...line[i]);
    if (near.d < best.d) best = { part: i, ...near };
  }
  return best;
}

/**
 * Heights along a river from its outlet up: [{d from the outlet, x, y, z}]. The height of a place is the lowest beside
 * it, and none is above those upstream.
 */
export function riverProfile(land, line) {
  const places = spread(land, line, land.cells / 2);
  const whole = places.at(-1).d;
  let low = Infinity;
  const points = places.map(({ d, x, y }) => {
    const z = lowestBeside(land, x, y);
    if (z < low) low = z;
    return { d: whole - d, x, y, z: Number.isNaN(z) ? z : low };
  });
  return points.reverse();
}

/**
 * Direction downstream of a line about a place, by the chord of `reach` [cells] up and down along it: {x, y, dx, dy}.
 */
export function courseAt(line, x, y, reach) {
  const here = nearestOn(line, x, y);
  const walk = (from, step) => {
    let [px, py] = [here.x, here.y];
    let left = reach;
    for (let i = from; i >= 0 && i < line.length && left > 0; i += step) {
      const long = Math.hypot(line[i][0] - px, line[i][1] - py);
      const share = long > left ? left / long : 1;
      [px, py] = [px + share * (line[i][0] - px), py + share * (line[i][1] - py)];
      left -= long;
    }
    return [px, py];
  };
  const up = walk(here.part - 1, -1);
  const down = walk(here.part, 1);
  const long = Math.hypot(down[0] - up[0], down[1] - up[1]) || 1;
  return { x: here.x, y: here.y, dx: (down[0] - up[0]) / long, dy: (down[1] - up[1]) / long };
}

/**
 * Direction in which the land about a place falls most steeply, over `reach` [cells]; to the south where it is level.
 */
export function fallAt(land, x, y, reach) {
  const z = (u, v) => land.heightAt(u, v);
  const dx = z(x - reach, y) - z(x + reach, y);
  const dy = z(x, y - reach) - z(x, y + reach);
  const long = Math.hypot(dx, dy);
  return long > 0 ? { x, y, dx: dx / long, dy: dy / long } : { x, y, dx: 0, dy: 1 };
}

/** How far a ray stays on the grid [cells]. */
export function room({ grid }, x, y, ux, uy) {
  const toward = (at, u, end) => (u > 1e-12 ? (end - at) / u : u < -1e-12 ? -at / u : Infinity);
  return Math.max(0, Math.min(toward(x, ux, grid.width), toward(y, uy, grid.height)));
}

/**
 * How far from a place the divide on one side is seen [cells]: the highest ground before it falls by a quarter of what
 * it rose and by a 50th of the land's range, but not before `look`; a sixth more, no farther than 0.3 of the grid's
 * longer side.
 */
function reachTo(land, { x, y, ux, uy }, sign, look) {
  const { width, height } = land.grid;
  const step = land.cells / 2;
  const least = (land.max - land.min) / 50;
  const end = Math.min(0.3 * Math.max(width, height), room(land, x, y, sign * ux, sign * uy));
  const floor = heightOf(land, x, y);
  let top = -Infinity;
  let topAt = 0;
  let d = 0;
  for (; d <= end; d += step) {
    const z = heightOf(land, x + sign * d * ux, y + sign * d * uy);
    if (Number.isNaN(z)) break;
    if (z > top) [top, topAt] = [z, d];
    else if (d > look && top - z > Math.max((top - floor) / 4, least)) {
      return Math.min(end, Math.max(topAt + 4 * step, (7 / 6) * topAt));
    }
  }
  return Math.max(step, Math.min(d - step, end));
}

/** How far the divides of a river are at least: spurs in its bends are nearer. area: what it drains [m2]. */
export function leastReach(land, area) {
  return Math.max(10 * land.cells, (0.12 * Math.sqrt(area)) / side(land));
}

/** A section at right angles to a course: {x, y, ux, uy to the right of who looks downstream, left, right [cells]}. */
export function sectionAcross(land, { x, y, dx, dy }, look = 0) {
  const across = { x, y, ux: -dy, uy: dx };
  return { ...across, left: reachTo(land, across, -1, look), right: reachTo(land, across, 1, look) };
}

/** Heights along a section, d negative to the left; one sample at its middle and one at each end. */
export function sectionPoints(land, { x, y, ux, uy, left, right }) {
  const half = (far, sign) => {
    const n = Math.max(1, Math.min(most / 2, Math.ceil((2 * far) / land.cells - 1e-9)));
    return Array.from({ length: n }, (_, k) => (sign * far * (k + 1)) / n);
  };
  return [...half(left, -1).reverse(), 0, ...half(right, 1)].map((d) => {
    const [u, v] = [x + d * ux, y + d * uy];
    return { d: d * side(land), x: u, y: v, z: heightOf(land, u, v) };
  });
}

/** Where the ground first reaches a height, from one index outwards: distance, or null. */
function reaches(points, from, step, level) {
  for (let i = from; points[i + step] && !Number.isNaN(points[i + step].z); i += step) {
    const [a, b] = [points[i], points[i + step]];
    if (b.z >= level) return a.d + (b.z > a.z ? Math.max(0, (level - a.z) / (b.z - a.z)) : 0) * (b.d - a.d);
  }
  return null;
}

/** Area between the ground and a level, from one distance to another. */
function areaBelow(points, level, from, to) {
  let area = 0;
  for (let i = 1; i < points.length; ++i) {
    const [a, b] = [points[i - 1], points[i]];
    const [d0, d1] = [Math.max(a.d, from), Math.min(b.d, to)];
    if (!(d1 > d0)) continue;
    const depth = (d) => Math.max(0, level - (a.z + ((d - a.d) / (b.d - a.d)) * (b.z - a.z)));
    area += ((depth(d0) + depth(d1)) / 2) * (d1 - d0);
  }
  return area;
}

/**
 * Of a section: floor (the lowest ground within three values of the middle), crests of both sides {d, z, rise, slope:
 * mean from the floor [°]}, depth below the lower crest, widths [{share of the depth, height, width}] and area [m2] at
 * that depth.
 */
export function valley(land, points) {
  const near = 3 * land.cells * side(land);
  const lowest = (best, p, i) => (Math.abs(p.d) <= near && p.z < (points[best]?.z ?? Infinity) ? i : best);
  const at = points.reduce(lowest, -1);
  if (at < 0) return null;
  const floor = points[at];
  const crest = (step) => {
    let top = floor;
    for (let i = at; points[i] && !Number.isNaN(points[i].z); i += step) if (points[i].z > top.z) top = points[i];
    const rise = top.z - floor.z;
    return {
      d: top.d,
      x: top.x,
      y: top.y,
      z: top.z,
      rise,
      slope: rise > 0 ? degrees(rise / Math.abs(top.d - floor.d)) : 0,
    };
  };
  const [left, right] = [crest(-1), crest(1)];
  const depth = Math.min(left.rise, right.rise);
  const level = (share) => (share === 1 ? Math.min(left.z, right.z) : floor.z + share * depth);
  const ends = (share) => [-1, 1].map((step) => reaches(points, at, step, level(share)));
  const widths = depth > 0 ? [0.25, 0.5, 0.75, 1].map((share) => {
    const [from, to] = ends(share);
    return { share, height: share * depth, width: to - from };
  }) : [];
  return { floor, left, right, depth, widths, area: depth > 0 ? areaBelow(points, level(1), ...ends(1)) : 0 };
}

/**
 * The value of a river near a place on it: of the nine about it the one that drains most nearly what the river does
 * there.
 */
export function valueOfRiver(land, water, rivers, arc, x, y) {
  const line = Array.from({ length: rivers.lines[arc].length / 2 }, (_, i) => [
    rivers.lines[arc][2 * i],
    rivers.lines[arc][2 * i + 1],
  ]);
  const here = nearestOn(line, x, y);
  const [[ax, ay], [bx, by]] = [line[here.part - 1], line[here.part]];
  const share = Math.hypot(here.x - ax, here.y - ay) / (Math.hypot(bx - ax, by - ay) || 1);
  const wanted = Math.max(1, areaAt(rivers, arc, 2 * here.part, share) / (land.cells * side(land)) ** 2);
  const column = Math.min(Math.floor(here.x / land.cells), land.width - 1);
  const row = Math.min(Math.floor(here.y / land.cells), land.height - 1);
  let best = row * land.width + column;
  const off = (i) => (water.areas[i] > 0 ? Math.abs(Math.log(water.areas[i] / wanted)) : Infinity);
  for (let r = Math.max(0, row - 1); r <= Math.min(row + 1, land.height - 1); ++r) {
    for (let c = Math.max(0, column - 1); c <= Math.min(column + 1, land.width - 1); ++c) {
      if (off(r * land.width + c) < off(best)) best = r * land.width + c;
    }
  }
  return best;
}

/** All values whose water passes one, itself among them, with 255; and what they are like. */
export function catchment(land, water, value, { east, south }) {
  const { receivers, order, distances } = water;
  const inside = new Uint8Array(receivers.length);
  inside[value] = 255;
  const out = { inside, value, count: 0, mean: 0, slope: 0, low: Infinity, high: -Infinity, longest: 0 };
  let known = 0;
  for (let k = order.length - 1; k >= 0; --k) {
    const i = order[k];
    if (land.has && !land.has[i]) continue;
    ++known;
    if (receivers[i] >= 0 && inside[receivers[i]]) inside[i] = 255;
    if (!inside[i]) continue;
    ++out.count;
    out.mean += land.z[i];
    out.slope += degrees(Math.hypot(east[i], south[i]));
    out.low = Math.min(out.low, land.z[i]);
    out.high = Math.max(out.high, land.z[i]);
    out.longest = Math.max(out.longest, distances[i] - distances[value]);
  }
  const cell = land.cells * side(land);
  return {
    ...out,
    area: out.count * cell * cell,
    share: out.count / known,
    mean: out.mean / out.count,
    slope: out.slope / out.count,
    longest: out.longest * cell,
  };
}

/**
 * The network in a catchment: {arcs, sources, order: highest}, by an arc and those above it, else by where arcs lie.
 */
export function networkOf({ land, rivers, orders }, { inside }, arc) {
  const within = new Uint8Array(rivers.count);
  if (arc >= 0) {
    within[arc] = 1;
    for (const k of [...rivers.upstreamFirst].reverse()) {
      if (rivers.downstream[k] >= 0 && within[rivers.downstream[k]]) within[k] = 1;
    }
  } else {
    rivers.lines.forEach((line, k) => {
      const i = 2 * Math.floor(line.length / 4);
      const column = Math.min(Math.floor(line[i] / land.cells), land.width - 1);
      within[k] = inside[Math.min(Math.floor(line[i + 1] / land.cells), land.height - 1) * land.width + column] ? 1 : 0;
    });
  }
  const kept = [...within.keys()].filter((k) => within[k] && orders[k] > 0);
  const fed = new Set(rivers.downstream.filter((_, k) => orders[k] > 0));
  return {
    arcs: kept.length,
    sources: kept.filter((k) => !fed.has(k)).length,
    order: kept.reduce((most_, k) => Math.max(most_, orders[k]), 0),
  };
}

const headings = [[1, 0], [0, 1], [-1, 0], [0, -1]]; // east, south, west, north

/**
 * Outlines of the values that are set, along their edges: [{outer: [[x, y], …], holes: [likewise]}] in cells, rings
 * closed. Values that only touch by corners are polygons of their own, as OGC's simple features want it.
 */
export function outline({ width, height, cells }, inside) {
  const set = (c, r) => c >= 0 && r >= 0 && c < width && r < height && inside[r * width + c] > 0;
  // An edge has what is set at its right hand.
  const edge = ([x, y], h) =>
    [[x, y, x, y - 1], [x - 1, y, x, y], [x - 1, y - 1, x - 1, y], [x, y - 1, x - 1, y - 1]][h];
  const runs = (at, h) => {
    const [c, r, oc, or] = edge(at, h);
    return set(c, r) && !set(oc, or);
  };
  const done = new Uint8Array(width * height); // edges at the north of values
  const outers = [];
  const holes = [];
  /** A ring that meets no corner twice. */
  function take(ring) {
    const closed = [...ring, ring[0]];
    const doubled = ring.reduce((sum, [x, y], i) => sum + x * closed[i + 1][1] - closed[i + 1][0] * y, 0);
    const east = ring.findIndex(([x], i) => closed[i + 1][0] > x);
    const one = { ring: closed, area: Math.abs(doubled), without: [ring[east][0] + 0.5, ring[east][1] - 0.5] };
    (doubled > 0 ? outers : holes).push(one);
  }
  for (let r = 0; r < height; ++r) {
    for (let c = 0; c < width; ++c) {
      if (done[r * width + c] || !runs([c, r], 0)) continue;
      const ring = [];
      let at = [c, r];
      let h = 0;
      do {
        if (h === 0) done[at[1] * width + at[0]] = 1;
        at = [at[0] + headings[h][0], at[1] + headings[h][1]];
        const ways = [h + 1, h, h + 3].map((k) => k % 4).filter((k) => runs(at, k)); // to the right first
        if (ways[0] !== h) {
          const met = ways.length > 1 ? ring.findLastIndex(([x, y]) => x === at[0] && y === at[1]) : -1;
          if (met >= 0) take(ring.splice(met)); // what lies between the two is a ring of its own
          ring.push(at);
        }
        [h] = ways;
      } while (at[0] !== c || at[1] !== r || h !== 0);
      take(ring);
    }
  }
  outers.sort((a, b) => a.area - b.area);
  for (const { ring, without } of holes) {
    const around = outers.find((outer) => encloses(outer.ring, without));
    (around.holes ??= []).push(ring);
  }
  const scaled = (ring) => ring.map(([x, y]) => [x * cells, y * cells]);
  return outers.map((outer) => ({ outer: scaled(outer.ring), holes: (outer.holes ?? []).map(scaled) }));
}

function encloses(ring, [x, y]) {
  let odd = false;
  for (let i = 1; i < ring.length; ++i) {
    const [[ax, ay], [bx, by]] = [ring[i - 1], ring[i]];
    if (ay > y !== by > y && x < ax + ((y - ay) / (by - ay)) * (bx - ax)) odd = !odd;
  }
  return odd;
}

/** Polygons in the grid's coordinates as WKT. */
export function wkt(polygons, { west, north, cell_m: cell }) {
  const ring = (points) => `(${points.map(([x, y]) => `${west + x * cell} ${north - y * cell}`).join(', ')})`;
  const polygon = ({ outer, holes }) => `(${[outer, ...holes].map(ring).join(', ')})`;
  return `MULTIPOLYGON (${polygons.map(polygon).join(', ')})`;
}

/**
 * From point to point: legs {length, ground, rise, bearing [° from grid north], slope [°]}, their sums, and area [m2]
 * if closed.
 */
export function traverse(land, points, closed) {
  const corners = closed ? [...points, points[0]] : points;
  const legs = corners.slice(1).map(([x, y], i) => {
    const [px, py] = corners[i];
    const samples = along(land, [[px, py], [x, y]]);
    const { length, ground } = sums(samples);
    const rise = samples.at(-1).z - samples[0].z;
    return {
      length,
      ground,
      rise,
      bearing: ((Math.atan2(x - px, py - y) * 180) / Math.PI + 360) % 360,
      slope: length > 0 ? degrees(rise / length) : NaN,
    };
  });
  const sum = (key) => legs.reduce((total, leg) => total + leg[key], 0);
  const doubled = corners.slice(1).reduce((total, [x, y], i) => total + corners[i][0] * y - corners[i][1] * x, 0);
  return {
    legs,
    length: sum('length'),
    ground: sum('ground'),
    rise: sum('rise'),
    area: closed ? (Math.abs(doubled) / 2) * side(land) ** 2 : null,
  };
}
