// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Lands of formulas as a page holds them (README.md), without the program.
import { deflateSync } from 'node:zlib';
import { Land } from '../src/land.js';
import { ArcFinder, Rivers } from '../src/rivers.js';
import { Water } from '../src/water.js';

const packed = (bytes) => deflateSync(Buffer.from(bytes)).toString('base64');
const zigzag = (v) => (v < 0 ? -2 * v - 1 : 2 * v);

/** Heights [m], NaN for none, as their 16-bit numbers, each predicted by the one at its left. */
export function packHeights(heights, width, height) {
  const known = heights.filter((z) => !Number.isNaN(z));
  const [min, max] = [Math.min(...known), Math.max(...known)];
  const q = Array.from(heights, (z) => (Number.isNaN(z) ? 0 : 1 + Math.round(((z - min) / (max - min || 1)) * 65534)));
  const residuals = q.map((v, i) => zigzag(((v - (i % width ? q[i - 1] : 0)) << 16) >> 16));
  const bytes = [...Array(height).fill(1), ...residuals.map((v) => v & 255), ...residuals.map((v) => v >> 8)];
  return { about: { width, height, cells: 1, min, max, nodata: heights.length - known.length }, base64: packed(bytes) };
}

/** Lines [[[x, y], …], …] in sixteenths of a cell. */
export function packLines(lines) {
  const bytes = [];
  let before = [0, 0];
  const put = (v) => {
    let left = zigzag(v);
    for (; left > 127; left = Math.floor(left / 128)) bytes.push(128 | (left & 127));
    bytes.push(left);
  };
  for (const point of lines.flat()) {
    const now = point.map((v) => Math.round(16 * v));
    now.forEach((v, k) => put(v - before[k]));
    before = now;
  }
  return packed(bytes);
}

/** Ways of water that all are the steepest. */
export const packWater = (values) => packed(new Uint8Array(values));

/**
 * A scene: {data, lines, water, heights, packed: heights as in the page}. z(x, y) [m] at centres of cells;
 * arcs: [{line, ds, us_area, ds_area, …}].
 */
export function landOfFormula({ width = 200, height = 160, cell = 30, z, arcs = [], cells = 1 }) {
  const [across, down] = [Math.ceil(width / cells), Math.ceil(height / cells)];
  const heights = Float32Array.from({ length: across * down }, (_, i) =>
    z(((i % across) + 0.5) * cells, (Math.floor(i / across) + 0.5) * cells),
  );
  const { about, base64 } = packHeights(heights, across, down);
  const column = (key, otherwise) => arcs.map((arc, k) => arc[key] ?? otherwise(arc, k));
  const length = ({ line }) =>
    cell * line.slice(1).reduce((sum, [x, y], i) => sum + Math.hypot(x - line[i][0], y - line[i][1]), 0);
  const data = {
    version: '0.2.0',
    title: 'made land',
    seed: 1,
    command: '',
    recipe: '',
    grid: {
      width,
      height,
      cell_m: cell,
      west: 500000,
      north: 5000000,
      crs: 'EPSG:32631',
      crs_name: 'WGS 84 / UTM zone 31N',
    },
    heights: { ...about, cells },
    contour_m: 50,
    ridges: null,
    sea: null,
    lakes: false,
    summits: [],
    profiles: [],
    curve: null,
    hypsometry: null,
    rivers: {
      step: 1 / 16,
      prune: 0,
      arcs: {
        id: column('id', (_, k) => k + 1),
        ds: column('ds', () => 0),
        basin: column('basin', () => 1),
        strahler: column('strahler', () => 1),
        shreve: column('shreve', () => 1),
        hack: column('hack', () => 1),
        survives: column('survives', () => null),
        length: column('length', length),
        z_up: column('z_up', () => 0),
        z_down: column('z_down', () => 0),
        us_area: column('us_area', () => 1e6),
        ds_area: column('ds_area', () => 2e6),
        n: arcs.map(({ line }) => line.length),
      },
    },
    laws: { rows: [], support: null, orders: [], dem_orders: [], hack: {}, concavity: {} },
    relief: null,
    statistics: [],
    given: [],
    checks: [],
    timings: [],
    warnings: { count: 0, shown: [] },
    repairs: { count: 0, shown: [] },
    findings: { count: 0, shown: [] },
    notes: [],
  };
  return {
    data,
    heights,
    packed: base64,
    lines: packLines(arcs.map(({ line }) => line)),
    water: cells === 1 ? packWater(across * down) : '',
  };
}

/**
 * A valley along x = middle that falls to the south: sides of a slope each, and a river with one tributary from the
 * west.
 */
export function valleyLand({ left = 0.4, right = 0.25, fall = 0.02, lift = 0, cells = 1 } = {}) {
  const [width, height, cell, middle] = [200, 160, 30, 100.5];
  const areas = (share) => share * width * height * cell * cell;
  return landOfFormula({
    width, height, cell, cells,
    z: (x, y) => lift + fall * cell * (height - y) + cell * (x < middle ? left * (middle - x) : right * (x - middle)),
    arcs: [
      { line: [[middle, 20], [middle, 60]], ds: 3, us_area: areas(0.1), ds_area: areas(0.4) },
      { line: [[60.5, 40], [middle, 60]], ds: 3, us_area: areas(0.01), ds_area: areas(0.05), hack: 2, survives: 30 },
      { line: [[middle, 60], [middle, 160]], strahler: 2, shreve: 2, us_area: areas(0.45), ds_area: areas(1) },
    ],
  });
}

/** What the page makes of a scene, of heights that are not rounded. */
export function sceneOf(made) {
  const { data, heights } = made;
  const land = new Land(data.grid, data.heights, heights, null);
  const rivers = new Rivers(data.rivers, null, made.lines);
  const water = new Water(land, made.water, false);
  return { data, land, rivers, water, orders: rivers.kept(0).orders, finder: new ArcFinder(rivers, data.grid) };
}
