// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Heights, water and light on the page's raster, against slow and obvious reckonings.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Land } from '../src/land.js';
import { distanceInside, skyView, slopes, sunlight } from '../src/light.js';
import { Water } from '../src/water.js';
import { landOfFormula, packHeights, packWater, sceneOf } from './made_land.mjs';
import { forAll, near } from './support.mjs';

const gridOf = (width, height) => ({ width, height, cell_m: 10, west: 0, north: 0, crs: '', crs_name: '' });

/** Land of random heights, some of them missing. */
function randomLand(random, missing = 0) {
  const [width, height] = [2 + Math.floor(7 * random()), 2 + Math.floor(7 * random())];
  const heights = Float32Array.from({ length: width * height }, (_, i) =>
    i && random() < missing ? NaN : 500 * random(),
  );
  const { about, base64 } = packHeights(heights, width, height);
  return { heights, about, base64, width, height, land: new Land(gridOf(width, height), about, heights, null) };
}

test('land without a surface is level, of no height and no slope', () => {
  const land = new Land(gridOf(300, 100), null);
  assert.ok(land.level);
  assert.equal(land.heightAt(150, 50), 0);
  assert.equal(land.known(150, 50), false);
  assert.equal(land.steepness(), 0);
  assert.equal(new Water(land, '', false).known, false);
});

test('a land of one cell has its height everywhere, and its water leaves', () => {
  const { land, water } = sceneOf(landOfFormula({ width: 1, height: 1, z: () => 7 }));
  for (const place of [[0, 0], [0.5, 0.5], [1, 1]]) assert.equal(land.heightAt(...place), 7);
  assert.deepEqual([...water.receivers, ...water.areas, ...water.distances, ...water.basins], [-1, 1, 0, 1]);
});

test('heights as packed are those of the values, to a part of 65534 of their range', () =>
  forAll(20, (random) => {
    const { heights, about, base64, width, height, land } = randomLand(random, 0.2);
    const packed = new Land(gridOf(width, height), about, base64, null);
    const step = (about.max - about.min) / 65534;
    heights.forEach((z, i) => {
      if (Number.isNaN(z)) assert.equal(packed.has[i], 0);
      else near(packed.z[i], z, 0.51 * step + 1e-4);
    });
    assert.deepEqual(packed.q, land.q);
  }));

test('holes have heights of the land about them, and are none', () =>
  forAll(20, (random) => {
    const { heights, land } = randomLand(random, 0.5);
    const given = new Set(heights);
    land.z.forEach((z) => assert.ok(given.has(z)));
    heights.forEach((z, i) => land.has && assert.equal(land.has[i] > 0, !Number.isNaN(z)));
  }));

test('on a plane the height is exact between centres, and slopes everywhere', () => {
  const { land } = sceneOf(landOfFormula({ width: 12, height: 9, cell: 10, z: (x, y) => 100 + 3 * x - 2 * y }));
  for (const [x, y] of [[0.5, 0.5], [3.25, 7.75], [11.5, 8.5]]) near(land.heightAt(x, y), 100 + 3 * x - 2 * y, 1e-4);
  const { east, south } = slopes(land);
  for (let i = 0; i < east.length; ++i) {
    near(east[i], 0.3, 1e-5);
    near(south[i], -0.2, 1e-5);
  }
  near(land.steepness(), Math.hypot(0.3, 0.2), 1e-5);
});

/** The receiver of a value by the rule of README.md. */
function steepestReceiver(q, width, height, i) {
  const ways = [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1]];
  const drops = ways.map(([dx, dy], k) => {
    const [x, y] = [(i % width) + dx, Math.floor(i / width) + dy];
    const there = x < 0 || y < 0 || x >= width || y >= height ? 0 : q[y * width + x];
    return there > 0 && there < q[i] ? (q[i] - there) ** 2 * (k % 2 ? 1 : 2) : 0;
  });
  const most = Math.max(...drops);
  if (most === 0) return -1;
  const [dx, dy] = ways[drops.indexOf(most)];
  return i + dx + dy * width;
}

test('water goes down the steepest way, and all of it leaves', () =>
  forAll(20, (random) => {
    const { land, width, height } = randomLand(random);
    const water = new Water(land, packWater(width * height), false);
    land.z.forEach((_, i) => assert.equal(water.receivers[i], steepestReceiver(land.q, width, height, i)));
    const outlets = [...water.receivers.keys()].filter((i) => water.receivers[i] < 0);
    assert.equal(outlets.reduce((sum, i) => sum + water.areas[i], 0), width * height);
    const place = new Map(Array.from(water.order, (i, k) => [i, k]));
    water.receivers.forEach((to, i) => {
      if (to < 0) return;
      assert.ok(place.get(i) < place.get(to) && water.areas[i] < water.areas[to]);
      assert.ok(water.distances[i] > water.distances[to] && water.basins[i] === water.basins[to]);
    });
    const largest = Math.max(...outlets.map((i) => water.areas[i]));
    assert.equal(water.areas[outlets.find((i) => water.basins[i] === 1)], largest);
  }));

test('ways that are not the steepest are taken, lakes are told apart, and what is cut short is refused', () => {
  const made = landOfFormula({ width: 3, height: 1, z: (x) => 10 - x });
  const { land } = sceneOf(made);
  // West is the fifth way, the steepest is the first: 4 more; 16 more in a lake.
  const water = new Water(land, packWater([4, 16, 0]), true);
  assert.deepEqual(Array.from(water.receivers), [-1, 2, -1]);
  assert.deepEqual(Array.from(water.lakes), [0, 255, 0]);
  // The last of nine is the one before the steepest: nowhere.
  assert.deepEqual(Array.from(new Water(land, packWater([8, 8, 0]), false).receivers), [-1, -1, -1]);
  assert.throws(() => new Water(land, packWater(2), true).lakes, /water in this page is damaged/);
});

test('distances to what is not set are at least straight and at most by steps', () =>
  forAll(20, (random) => {
    const [width, height, most] = [9, 7, 64];
    const set = Uint8Array.from({ length: width * height }, () => (random() < 0.7 ? 255 : 0));
    const found = distanceInside(set, width, height, most);
    found.forEach((d, i) => {
      const away = [...set.keys()].filter((k) => !set[k])
        .map((k) => [Math.abs((k % width) - (i % width)), Math.abs(Math.floor(k / width) - Math.floor(i / width))]);
      const straight = Math.min(most, ...away.map(([x, y]) => Math.hypot(x, y)));
      const steps = Math.min(most, ...away.map(([x, y]) => Math.max(x, y) + (Math.SQRT2 - 1) * Math.min(x, y)));
      assert.ok(d >= straight - 1e-4 && d <= steps + 1e-4);
    });
  }));

test('flat land sees the whole sky and all of the sun, a pit less of the sky, and behind a wall lies shadow', () => {
  const flat = sceneOf(landOfFormula({ width: 9, height: 9, z: () => 5 })).land;
  assert.ok(skyView(flat, 1, 9).seen.every((share) => Math.abs(share - 1) < 1e-6));
  assert.ok(sunlight(flat, 1, 0.7, 1).every((light) => light === 255));
  const pit = sceneOf(
    landOfFormula({ width: 9, height: 9, cell: 10, z: (x, y) => 20 * Math.hypot(x - 4.5, y - 4.5) }),
  ).land;
  assert.ok(skyView(pit, 1, 9).seen[40] < 0.5);
  const wall = sceneOf(landOfFormula({ width: 20, height: 5, cell: 10, z: (x) => (x > 15 ? 100 : 0) })).land;
  const light = sunlight(wall, Math.PI / 2, Math.PI / 6, 1); // low in the east: a shadow of 173 m
  assert.equal(light[2 * 20 + 12], 0);
  assert.equal(light[2 * 20 + 18], 255);
});
