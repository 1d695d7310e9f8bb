// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What is measured, on lands of formulas against slow and obvious reckonings.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { test } from 'node:test';
import { Land } from '../src/land.js';
import { slopes } from '../src/light.js';
import {
  along,
  catchment,
  courseAt,
  crossings,
  fallAt,
  networkOf,
  outline,
  riverOf,
  riverProfile,
  sectionAcross,
  sectionPoints,
  sums,
  traverse,
  valley,
  valueOfRiver,
  wkt,
} from '../src/survey.js';
import { landOfFormula, sceneOf, valleyLand } from './made_land.mjs';
import { near, randomNumbers } from './support.mjs';

const atan = (slope) => (Math.atan(slope) * 180) / Math.PI;
const random = randomNumbers(11);
const rough = (width, height) => {
  const z = Array.from({ length: width * height }, () => 9 * random());
  return sceneOf(
    landOfFormula({ width, height, z: (x, y) => 3 * x + 5 * y + z[Math.floor(y) * width + Math.floor(x)] }),
  );
};

test('heights along a line are bilinear between the values, its ends and even steps among them', () => {
  const { land } = rough(40, 30);
  const centre = (c, r) => land.z[Math.min(Math.max(r, 0), 29) * 40 + Math.min(Math.max(c, 0), 39)];
  const bilinear = (x, y) => {
    const [c, r] = [Math.floor(x - 0.5), Math.floor(y - 0.5)];
    const [f, g] = [x - 0.5 - c, y - 0.5 - r];
    return (
      centre(c, r) * (1 - f) * (1 - g) +
      centre(c + 1, r) * f * (1 - g) +
      centre(c, r + 1) * (1 - f) * g +
      centre(c + 1, r + 1) * f * g
    );
  };
  const line = [[0, 0], [13.3, 22.9], [39.7, 4.1], [40, 30]];
  const points = along(land, line);
  const length = Math.hypot(13.3, 22.9) + Math.hypot(26.4, 18.8) + Math.hypot(0.3, 25.9);
  near(points.at(-1).d, 30 * length, 1e-6);
  assert.deepEqual([points[0].x, points[0].y, points.at(-1).x, points.at(-1).y], [0, 0, 40, 30]);
  points.forEach(({ x, y, z, d }, i) => {
    near(z, bilinear(x, y), 1e-4);
    if (i) near(d - points[i - 1].d, points[1].d, 1e-6);
  });
  assert.ok(points[1].d <= 15);
});

test('on a plane lengths over the ground and slopes are exact, on a cone what is climbed and lost', () => {
  const plane = sceneOf(landOfFormula({ z: (x, y) => 9 * x + 12 * y })).land; // 0.3 and 0.4: 0.5 along the gradient
  const sum = sums(along(plane, [[20, 20], [50, 60]]));
  near(sum.length, 1500, 1e-6);
  near(sum.up, 750, 1e-2);
  assert.equal(sum.down, 0);
  near(sum.ground, Math.hypot(1500, 750), 1e-2);
  near(sum.steepest, atan(0.5), 1e-2);
  const cone = sceneOf(landOfFormula({ z: (x, y) => 1000 - 6 * Math.hypot(x - 100.5, y - 80.5) })).land;
  const over = sums(along(cone, [[40.5, 80.5], [140.5, 80.5]]));
  for (const [key, wanted] of [['up', 360], ['down', 240], ['high', 1000], ['low', 640], ['steepest', atan(0.2)]]) {
    near(over[key], wanted, 0.02, key);
  }
  const { dx, dy } = fallAt(cone, 130.5, 120.5, 3);
  near(dx, 0.6, 1e-3);
  near(dy, 0.8, 1e-3);
});

test('where there is no land a profile has a gap, and the sea is at its level', () => {
  const hole = landOfFormula({ width: 30, height: 20, z: (x) => (x > 10 && x < 20 ? NaN : x) });
  for (const [sea, wanted] of [[null, NaN], [{ level: -2, around: false }, -2]]) {
    const land = new Land(hole.data.grid, hole.data.heights, hole.heights, sea);
    const points = along(land, [[2, 10], [28, 10]]);
    const inside = points.filter(({ x }) => x > 11 && x < 19);
    assert.ok(inside.length > 10 && inside.every(({ z }) => Object.is(z, wanted)));
    assert.equal(sums(points).gaps, sea === null);
  }
});

test('a V valley has its area, widths, slopes and depth', () => {
  const { land, rivers, orders } = sceneOf(valleyLand({ fall: 0 }));
  const section = sectionAcross(land, courseAt(riverOf({ rivers, orders }, 2).line, 102, 100, 5));
  assert.deepEqual([section.x, section.ux, Math.abs(section.uy)], [100.5, -1, 0]); // to the south, right is west
  const found = valley(land, sectionPoints(land, { ...section, left: 50, right: 40 }));
  near(found.depth, 0.25 * 50 * 30, 1e-2); // east is left: the gentler side
  near(found.left.slope, atan(0.25), 1e-3);
  near(found.right.slope, atan(0.4), 1e-3);
  const width = found.depth / 0.25 + found.depth / 0.4;
  for (const { share, width: got } of found.widths) near(got, share * width, 0.02);
  near(found.area, (width * found.depth) / 2, 20);
  assert.ok(found.area > 4e5);
});

test('a section is at right angles to the river, also where it bends, and reaches beyond both divides', () => {
  for (const turn of [0.3, 1.2, 2.9, 4.4]) {
    const [dx, dy] = [Math.cos(turn), Math.sin(turn)];
    const line = Array.from({ length: 61 }, (_, i) => [100 + (i - 30) * dx, 80 + (i - 30) * dy]);
    const across = sectionAcross(sceneOf(landOfFormula({ z: (x) => x })).land, courseAt(line, 100.4, 80.2, 5));
    near(across.ux * dx + across.uy * dy, 0, 1e-9);
    near(dx * across.uy - dy * across.ux, 1, 1e-9); // to the right
  }
  const circle = Array.from({ length: 100 }, (_, i) => [100 + 40 * Math.cos(i / 20), 80 + 40 * Math.sin(i / 20)]);
  const { x, y, dx, dy } = courseAt(circle, ...circle[50], 5);
  near((x - 100) * dx + (y - 80) * dy, 0, 0.01);
  // Ridges at 30 and 20 cells beside the axis.
  const ridges = sceneOf(
    landOfFormula({ z: (u) => (u < 100.5 ? 300 - 8 * Math.abs(u - 70.5) : 200 - 8 * Math.abs(u - 120.5)) }),
  ).land;
  const { left, right } = sectionAcross(ridges, { x: 100.5, y: 80, dx: 0, dy: -1 });
  assert.ok(left > 30 && left < 40, left);
  assert.ok(right > 20 && right < 30, right);
});

test('a catchment is every value whose water comes by, on rough land', () => {
  const { land, water } = rough(48, 36);
  const { receivers } = water;
  const slope = slopes(land);
  const comesBy = (from, value) => {
    let length = 0;
    for (let i = from; i >= 0; i = receivers[i]) {
      if (i === value) return length;
      length +=
        receivers[i] >= 0 && receivers[i] % 48 !== i % 48 && Math.floor(receivers[i] / 48) !== Math.floor(i / 48)
          ? Math.SQRT2
          : 1;
    }
    return null;
  };
  const values = [...receivers.keys()].sort((a, b) => water.areas[b] - water.areas[a]);
  for (const value of [values[0], values[3], values[20], values[200], values.at(-1)]) {
    const found = catchment(land, water, value, slope);
    const lengths = [...receivers.keys()].map((i) => comesBy(i, value));
    assert.deepEqual(Array.from(found.inside), lengths.map((l) => (l === null ? 0 : 255)));
    const those = [...receivers.keys()].filter((i) => lengths[i] !== null);
    const mean = (of) => those.reduce((sum, i) => sum + of(i), 0) / those.length;
    assert.equal(found.count, water.areas[value]);
    near(found.area, 900 * those.length, 1e-6);
    near(found.share, those.length / (48 * 36), 1e-12);
    near(found.mean, mean((i) => land.z[i]), 1e-6);
    near(found.slope, mean((i) => atan(Math.hypot(slope.east[i], slope.south[i]))), 1e-9);
    near(found.longest, 30 * Math.max(...those.map((i) => lengths[i])), 0.01);
    assert.equal(found.high, Math.max(...those.map((i) => land.z[i])));
    assert.equal(found.low, Math.min(...those.map((i) => land.z[i])));
  }
  assert.ok(water.areas[values[0]] > 100);
});

test('outlines enclose what is set and nothing else, and are valid', () => {
  const texts = [];
  for (const share of [0.3, 0.5, 0.7, 1]) {
    const [width, height] = [24, 17];
    const inside = Uint8Array.from({ length: width * height }, () => (random() < share ? 255 : 0));
    const polygons = outline({ width, height, cells: 1 }, inside);
    const rings = polygons.flatMap(({ outer, holes }) => [outer, ...holes]);
    for (let i = 0; i < inside.length; ++i) {
      const [x, y] = [(i % width) + 0.5, Math.floor(i / width) + 0.5];
      const cuts = rings
        .flatMap((ring) => ring.slice(1).map((b, k) => [ring[k], b]))
        .filter(([a, b]) => a[0] === b[0] && a[0] > x && Math.min(a[1], b[1]) < y && y < Math.max(a[1], b[1]));
      assert.equal(cuts.length % 2 === 1, inside[i] > 0);
    }
    texts.push(wkt(polygons, { west: 0, north: 0, cell_m: 2 }), String(4 * inside.filter(Boolean).length));
  }
  execFileSync('/usr/bin/python3', ['-c', `
import sys
from osgeo import ogr
ogr.UseExceptions()
for text, area in zip(sys.argv[1::2], sys.argv[2::2]):
  shape = ogr.CreateGeometryFromWkt(text)
  assert shape.IsValid()
  assert abs(shape.Area() - float(area)) < 1e-6, (shape.Area(), area)
`, ...texts]);
});

test('rivers that a line crosses are found once, with what they drain there', () => {
  const here = sceneOf(valleyLand());
  const area = 200 * 160 * 900;
  const at = crossings(here.land, [[20, 80], [180, 80]], here);
  assert.deepEqual(at.map(({ arc, order }) => [arc, order]), [[2, 2]]);
  near(at[0].d, 80.5 * 30, 1e-6);
  near(at[0].area, area * (0.45 + 0.2 * 0.55), 1);
  assert.deepEqual(crossings(here.land, [[20, 50], [70, 50], [180, 50]], here).map(({ arc }) => arc), [1, 0]);
  // A vertex of the line on the river counts once.
  assert.equal(crossings(here.land, [[90, 100], [100.5, 110], [110, 110]], here).length, 1);
  // Against every segment, on a net of random lines.
  const arcs = Array.from({ length: 40 }, (_, k) => ({
    id: k + 1,
    line: Array.from({ length: 5 }, () => [Math.round(16 * 200 * random()) / 16, Math.round(16 * 160 * random()) / 16]),
  }));
  const net = sceneOf(landOfFormula({ z: (x) => x, arcs }));
  const line = [[3, 150], [60.3, 20.2], [190.1, 140.7]];
  const side = ([ax, ay], [bx, by], [x, y]) => Math.sign((bx - ax) * (y - ay) - (by - ay) * (x - ax));
  let wanted = 0;
  for (const { line: river } of arcs) {
    for (let i = 1; i < river.length; ++i) {
      for (let k = 1; k < line.length; ++k) {
        wanted +=
          side(line[k - 1], line[k], river[i - 1]) !== side(line[k - 1], line[k], river[i]) &&
          side(river[i - 1], river[i], line[k - 1]) !== side(river[i - 1], river[i], line[k]);
      }
    }
  }
  assert.equal(crossings(net.land, line, net).length, wanted);
  assert.ok(wanted > 20);
});

test('a river goes from its farthest source to its outlet and never climbs', () => {
  const here = sceneOf(valleyLand());
  for (const arc of [0, 2]) {
    const { line, arcs, joins } = riverOf(here, arc);
    assert.deepEqual(arcs, [0, 2]);
    assert.deepEqual([line[0], line.at(-1)], [[100.5, 20], [100.5, 160]]);
    assert.deepEqual(joins.map(({ arc: k, order }) => [k, order]), [[1, 1]]);
  }
  assert.deepEqual(riverOf(here, 1).arcs, [1, 2]);
  const points = riverProfile(here.land, riverOf(here, 0).line);
  assert.ok(points.every(({ d, z }, i) => i === 0 || (d > points[i - 1].d && z >= points[i - 1].z)));
  near(points.at(-1).d, 140 * 30, 1e-6);
  // The axis lies in the middle of a column; the lowest beside it is a row farther down.
  const row = (y) => Math.min(159.5, Math.floor(y) + 1.5);
  points.forEach(({ y, z }) => near(z, 0.6 * (160 - row(y)), 0.65));
  assert.deepEqual(networkOf(here, { inside: null }, 2), { arcs: 3, sources: 2, order: 2 });
  assert.deepEqual(networkOf(here, { inside: null }, 0), { arcs: 1, sources: 1, order: 1 });
  // Beside the axis the value of the river is the one on it.
  assert.equal(valueOfRiver(here.land, here.water, here.rivers, 2, 101.3, 100.5) % 200, 100);
});

test('legs have lengths, bearings and slopes, and a closed way an area', () => {
  const { land } = sceneOf(landOfFormula({ z: (x) => 9 * x }));
  const found = traverse(land, [[20, 20], [60, 20], [60, 50], [20, 50]], true);
  assert.deepEqual(found.legs.map(({ length }) => Math.round(length)), [1200, 900, 1200, 900]);
  assert.deepEqual(found.legs.map(({ bearing }) => bearing), [90, 180, 270, 0]);
  found.legs.forEach(({ slope }, i) => near(slope, [atan(0.3), 0, -atan(0.3), 0][i], 1e-3));
  near(found.area, 40 * 30 * 900, 1e-6);
  near(found.length, 4200, 1e-6);
  near(found.ground, 1800 + 2 * Math.hypot(1200, 360), 0.01);
  near(found.rise, 0, 1e-9);
  assert.equal(traverse(land, [[20, 20], [60, 20]], false).area, null);
});
