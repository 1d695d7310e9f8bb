// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Pages of lands that web/test/made_land.mjs makes, without the program.
import fs from 'node:fs';
import path from 'node:path';
import { web } from './browser.mjs';

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
