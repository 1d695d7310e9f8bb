// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Colours of land and rivers, the lines that the shader draws, and the places of labels.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { colourOf, css, forms, mix, modes, riverStyle } from '../src/colours.js';
import { contourPlaces } from '../src/labels.js';
import { slopes } from '../src/light.js';
import { LineField, reach, riverWidth } from '../src/riverfield.js';
import { foot } from '../src/rivers.js';
import { landOfFormula, sceneOf } from './made_land.mjs';
import { forAll, near } from './support.mjs';

const painted = (name, scene) =>
  modes[name].make({ ...scene, slope: slopes(scene.land), other: scene.land.z, metres: (z) => String(Math.round(z)) });
const hill = () =>
  sceneOf(landOfFormula({ width: 41, height: 41, cell: 30, z: (x, y) => 900 - 20 * Math.hypot(x - 20.5, y - 20.5) }));

test('a ramp of one colour is that colour, and beyond its ends a ramp is what its ends are', () => {
  assert.deepEqual(mix([[1, 2, 3]], 0.7), [1, 2, 3]);
  const ramp = [[0, 0, 0], [10, 20, 30], [40, 20, 30]];
  assert.deepEqual([-1, 0, 0.25, 0.5, 1, 2].map((share) => mix(ramp, share)),
    [[0, 0, 0], [0, 0, 0], [5, 10, 15], [10, 20, 30], [40, 20, 30], [40, 20, 30]]);
  assert.equal(css([0.4, 254.6, 30]), 'rgb(0 255 30)');
});

test('the higher the order, the wider a river, and the highest is as blue whatever it is', () => {
  for (const highest of [1, 2, 5, 9]) {
    const styles = Array.from({ length: highest }, (_, i) => riverStyle(i + 1, highest));
    styles.slice(1).forEach(({ width }, i) => assert.ok(width > styles[i].width));
    assert.deepEqual(styles.at(-1).colour, [10, 58, 146]);
    assert.ok(styles.at(-1).width <= 1.3 + 4.01);
  }
});

test('each way to colour the ground gives a value for every height, within its palette', () => {
  const scene = hill();
  for (const name of Object.keys(modes)) {
    const { values, low, high, palette } = painted(name, scene);
    assert.equal(palette.length, 1024);
    assert.ok(low <= high, name);
    if (!values) continue;
    assert.equal(values.length, scene.land.z.length);
    assert.ok(values.every((v) => Number.isFinite(v)), name);
  }
});

test('level land is painted too, and values beyond the range have the colours of its ends', () => {
  const flat = sceneOf(landOfFormula({ width: 5, height: 5, z: () => 3 }));
  for (const name of Object.keys(modes)) assert.ok(painted(name, flat).palette.length);
  const scale = { low: 10, high: 20, byClass: false };
  assert.deepEqual([9, 10, 15, 20, 21].map((value) => colourOf(scale, value)), [0, 0, 512, 1020, 1020]);
  assert.equal(colourOf({ low: 3, high: 3, byClass: false }, 3), 408);
  assert.equal(colourOf({ byClass: true }, 7), 28);
});

test('the landforms of a cone are a peak in its middle and slopes beside it, of a plane nothing but flat', () => {
  const name = (code) => forms[code][0];
  const { values } = painted('forms', hill());
  assert.equal(name(values[20 * 41 + 20]), 'peak');
  const plane = painted('forms', sceneOf(landOfFormula({ width: 9, height: 9, z: () => 1 })));
  assert.ok(plane.values.every((code) => name(code) === 'flat'));
});

test('a river that drains nothing has no width, and a larger one is wider', () => {
  assert.equal(riverWidth(0), 0);
  assert.equal(riverWidth(1e6), 2.7);
  for (let area = 1e4; area < 1e10; area *= 3) assert.ok(riverWidth(3 * area) > riverWidth(area));
});

test('a field without lines is empty, and with lines it has the nearest segment of each place in reach', () =>
  forAll(5, (random) => {
    const field = new LineField({ width: 40, height: 30 });
    field.build([]);
    assert.ok(field.nearest.every((number) => number === 0));
    const place = () => [40 * random(), 30 * random()];
    const lines = Array.from({ length: 4 }, () => [...place(), ...place()]);
    field.build([{ lines, half: 1, pixels: 1, share: 0, kind: 0 }]);
    const segment = (k) => Array.from(field.segments.subarray(4 * k, 4 * k + 4));
    for (let i = 0; i < field.nearest.length; i += 97) {
      const [c, r] = [i % field.width, Math.floor(i / field.width)];
      const away = lines.map((_, k) => foot(c, r, ...segment(k)).d);
      const least = Math.min(...away);
      if (Math.abs(least - reach) < 1e-3) continue;
      if (least > reach) assert.equal(field.nearest[i], 0);
      else near(away[field.nearest[i] - 1], least, 1e-4);
    }
  }));

test('level land and no interval have no contours to label; on a cone labels stand on contours, far apart', () => {
  const { land } = hill();
  assert.deepEqual(contourPlaces(land, 0, 9), []);
  assert.deepEqual(contourPlaces(sceneOf(landOfFormula({ width: 60, height: 60, z: () => 1 })).land, 5, 9), []);
  const places = contourPlaces(land, 50, 9);
  assert.ok(places.length > 0 && places.length <= 9);
  for (const { x, y, z } of places) {
    near(land.heightAt(x, y), z, 0.01);
    near(z % 50, 0, 1e-6);
  }
  places.forEach((p, i) => places.slice(i + 1).forEach((q) => assert.ok(Math.hypot(p.x - q.x, p.y - q.y) > 41 / 14)));
});
