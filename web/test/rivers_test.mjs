// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Pruning and orders of the network, and the arc that is nearest to a place, against slow and obvious reckonings.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { ArcFinder, foot, Rivers } from '../src/rivers.js';
import { packLines } from './made_land.mjs';
import { forAll, near } from './support.mjs';

/** A network by the numbers of the arcs that follow, -1 for none, in any order. */
function network(downstream, survives, lines = downstream.map(() => [[0, 0], [1, 1]])) {
  const same = (value) => downstream.map(() => value);
  const arcs = {
    id: downstream.map((_, k) => 10 + k), ds: downstream.map((d) => (d < 0 ? 0 : 10 + d)), basin: same(1),
    strahler: same(1), shreve: same(1), hack: same(1), survives, length: same(1), z_up: same(0), z_down: same(0),
    us_area: same(1), ds_area: same(1), n: lines.map((line) => line.length),
  };
  return new Rivers({ arcs, step: 1 / 16, prune: 0 }, null, packLines(lines));
}

/** A tree: each arc flows into one of those before it; a stream survives as long as what flows into it. */
function randomNetwork(random, count) {
  const downstream = Array.from({ length: count }, (_, k) => (k === 0 ? -1 : Math.floor(k * random())));
  const survives = downstream.map(() => Math.ceil(20 * random()));
  for (let k = count - 1; k > 0; --k) {
    survives[downstream[k]] = Math.max(survives[downstream[k]], survives[k]);
  }
  return { downstream, survives };
}

/** Strahler's order by its definition. */
function orderOf(downstream, kept, arc) {
  const above = downstream.flatMap((d, k) => (d === arc && kept(k) ? [orderOf(downstream, kept, k)] : []));
  const highest = Math.max(0, ...above);
  return above.length === 0 ? 1 : highest + (above.filter((order) => order === highest).length > 1 ? 1 : 0);
}

test('a network without arcs has no orders, no paths and nothing near', () => {
  const rivers = network([], []);
  assert.deepEqual(rivers.kept(0), { kept: 0, orders: new Int32Array(0) });
  assert.equal(rivers.longest, 0);
  assert.equal(new ArcFinder(rivers, { width: 10, height: 10 }).nearest(5, 5, 100, new Int32Array(0)), -1);
});

test('an arc that is always kept has no length at which it goes', () => {
  const rivers = network([-1], [null]);
  assert.equal(rivers.longest, 0);
  assert.equal(rivers.kept(1e9).kept, 1);
});

test('orders of what is kept are those of Strahler, and a longer pruning length keeps no more', () =>
  forAll(20, (random) => {
    const { downstream, survives } = randomNetwork(random, 1 + Math.floor(30 * random()));
    const rivers = network(downstream, survives);
    let before = Infinity;
    for (const length of [0, 1, 5, 10, 19, 20, 21]) {
      const keeps = (k) => survives[k] >= length;
      const { kept, orders } = rivers.kept(length);
      assert.deepEqual(Array.from(orders), downstream.map((_, k) => (keeps(k) ? orderOf(downstream, keeps, k) : 0)));
      assert.equal(kept, orders.filter((order) => order > 0).length);
      assert.ok(kept <= before);
      before = kept;
    }
    assert.equal(rivers.longest, Math.max(...survives));
  }));

test('every arc comes after all that flow into it, and a path ends at the outlet', () =>
  forAll(10, (random) => {
    const { downstream, survives } = randomNetwork(random, 25);
    const rivers = network(downstream, survives);
    const place = new Map(rivers.upstreamFirst.map((arc, i) => [arc, i]));
    assert.equal(place.size, 25);
    downstream.forEach((d, k) => assert.ok(d < 0 || place.get(k) < place.get(d)));
    assert.equal(rivers.path(24).at(-1), 0);
  }));

test('the nearest kept arc is found as by trying each segment', () =>
  forAll(20, (random) => {
    const size = 200;
    const place = () => [Math.floor(16 * size * random()) / 16, Math.floor(16 * size * random()) / 16];
    const lines = Array.from({ length: 12 }, () => [place(), place(), place()]);
    const rivers = network(lines.map(() => -1), lines.map(() => 1), lines);
    const finder = new ArcFinder(rivers, { width: size, height: size });
    const orders = lines.map(() => (random() < 0.7 ? 1 : 0));
    for (let i = 0; i < 30; ++i) {
      const [x, y] = place();
      const reach = 40 * random();
      const away = lines.map((line, k) =>
        orders[k] ? Math.min(...[1, 2].map((j) => foot(x, y, ...line[j - 1], ...line[j]).d)) : Infinity,
      );
      const least = Math.min(...away);
      assert.equal(finder.nearest(x, y, reach, orders), least < reach ? away.indexOf(least) : -1);
    }
  }));

test('the foot of a place on a segment is nearer than any other place of it', () =>
  forAll(20, (random) => {
    const [x, y, ax, ay, bx, by] = Array.from({ length: 6 }, () => 10 * random());
    const found = foot(x, y, ax, ay, bx, by);
    near(found.d, Math.hypot(x - found.x, y - found.y), 1e-12);
    for (let t = 0; t <= 1; t += 0.01) {
      assert.ok(found.d <= Math.hypot(x - ax - t * (bx - ax), y - ay - t * (by - ay)) + 1e-12);
    }
  }));

test('a segment of no length is a place', () => {
  assert.deepEqual(foot(3, 4, 0, 0, 0, 0), { x: 0, y: 0, d: 5 });
});

test('the example of two sources and one outlet has orders 1, 1 and 2', () => {
  const rivers = network([2, 2, -1], [8, 3, 8]);
  assert.deepEqual(Array.from(rivers.kept(0).orders), [1, 1, 2]);
  assert.deepEqual(Array.from(rivers.kept(4).orders), [1, 0, 1]);
  assert.deepEqual(rivers.path(1), [1, 2]);
});
