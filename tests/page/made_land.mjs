// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Lands of formulas as a page holds them (web/README.md), without the program.
import fs from 'node:fs';
import path from 'node:path';
import { deflateSync } from 'node:zlib';
import { web } from './browser.mjs';

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

/** A scene: {data, lines, water, heights, packed: heights as in the page}. z(x, y) [m] at centres of cells; arcs: [{line, ds, us_area, ds_area, …}]. */
export function landOfFormula({ width = 200, height = 160, cell = 30, z, arcs = [], cells = 1 }) {
  const [across, down] = [Math.ceil(width / cells), Math.ceil(height / cells)];
  const heights = Float32Array.from({ length: across * down }, (_, i) => z(((i % across) + 0.5) * cells, (Math.floor(i / across) + 0.5) * cells));
  const { about, base64 } = packHeights(heights, across, down);
  const column = (key, otherwise) => arcs.map((arc, k) => arc[key] ?? otherwise(arc, k));
  const length = ({ line }) => cell * line.slice(1).reduce((sum, [x, y], i) => sum + Math.hypot(x - line[i][0], y - line[i][1]), 0);
  const data = {
    version: '0.2.0', title: 'made land', seed: 1, command: '', recipe: '', grid: { width, height, cell_m: cell, west: 500000, north: 5000000, crs: 'EPSG:32631', crs_name: 'WGS 84 / UTM zone 31N' },
    heights: { ...about, cells }, contour_m: 50, ridges: null, sea: null, lakes: false, summits: [], profiles: [], curve: null, hypsometry: null,
    rivers: { step: 1 / 16, prune: 0, arcs: {
      id: column('id', (_, k) => k + 1), ds: column('ds', () => 0), basin: column('basin', () => 1), strahler: column('strahler', () => 1), shreve: column('shreve', () => 1),
      hack: column('hack', () => 1), survives: column('survives', () => null), length: column('length', length), z_up: column('z_up', () => 0), z_down: column('z_down', () => 0),
      us_area: column('us_area', () => 1e6), ds_area: column('ds_area', () => 2e6), n: arcs.map(({ line }) => line.length) } },
    laws: { rows: [], support: null, orders: [], dem_orders: [], hack: {}, concavity: {} }, relief: null, statistics: [], given: [], checks: [], timings: [],
    warnings: { count: 0, shown: [] }, repairs: { count: 0, shown: [] }, findings: { count: 0, shown: [] }, notes: [],
  };
  return { data, heights, packed: base64, lines: packLines(arcs.map(({ line }) => line)), water: cells === 1 ? packWater(across * down) : '' };
}

/** A comparison with a DEM as a page holds it. The cone is as good as this terrain in divides right; the TIN could not be measured in all. */
export function madeAgainst() {
  const row = (key, name, ...values) => ({ key, name, ...Object.fromEntries(['correlation', 'correlation_above_river', 'rmse_m', 'bias_m', 'same_reach', 'divides_found',
    'divides_right', 'slopes_difference', 'mean_slope_deg', 'hypsometric_integral'].map((figure, k) => [figure, values[k]])) });
  const rows = [
    row('terrain', 'this terrain', 0.9841, 0.7718, 65.007, -0.344, 0.80245, 0.5467, 0.5774, 0.0889, 21.06, 0.4594), row('cone', 'cone', 0.9805, 0.7445, 77.95, 28.07, 0.7882, 0.489, 0.5771, 0.381, 21.7502, 0.4684),
    row('tin', 'TIN', 0.9503, null, 174.9996, -1131.79, 0.3989, 0.2745, null, 0.7446, 7.264, 0.4983), row('dilation', 'dilation', 0.9806, 0.7184, 78.57, -30.47, 0.7662, 0.4862, 0.5379, 0.4893, 21.7534, 0.4785)];
  const names = ['DEM', ...rows.map(({ name }) => name)];
  const side = 64;
  return {
    dem: 'Big <b>Tujunga</b>.tif', cells: 740487, rows, real: { mean_slope_deg: 21.7528, hypsometric_integral: 0.4803 },
    slopes: names.map((name, k) => ({ name, shares_of_2_deg: Array.from({ length: 45 }, (_, i) => (i >= 2 * k && i < 2 * k + 20 ? 0.05 : 0)) })),
    hypsometry: names.map((name, k) => ({ name, points: Array.from({ length: 101 }, (_, i) => [i / 100, 2000 - 15 * i - 20 * k]) })),
    scatter: { low: 300, high: 2300, side, counts: Array.from({ length: side * side }, (_, i) => Math.floor(12000 * Math.exp(-(((i % side) - Math.floor(i / side) + 2) ** 2) / 4))) },
    difference: { limit_m: 120, width: 2, height: 2, image: 'data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAACCAIAAAD91JpzAAAAFUlEQVR42mNQTFvz/ft3BiDeJKENADjeB/N/P1YYAAAAAElFTkSuQmCC' },
  };
}

/** Writes a page of a scene and gives its path. */
export function writePage(folder, name, { data, packed: heights, lines, water }) {
  let html = fs.readFileSync(path.join(web, 'dist/report.html'), 'utf8');
  const blocks = { TITLE: data.title, DATA: JSON.stringify(data).replaceAll('<', '\\u003c'), HEIGHTS: heights, LINES: lines, WATER: water, STUDIO: '' };
  for (const [marker, text] of Object.entries(blocks)) html = html.replace(`@@${marker}@@`, () => text);
  const file = path.join(folder, `${name}.html`);
  fs.writeFileSync(file, html);
  return file;
}

/** A valley along x = middle that falls to the south: sides of a slope each, and a river with one tributary from the west. */
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
