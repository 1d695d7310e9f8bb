// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What is drawn, and the geometry that the page shows while one draws.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { bent, Drawing, inside, lengthOf, meeting, upTo } from '../src/drawing.js';
import { foot } from '../src/rivers.js';
import { forAll, near } from './support.mjs';

const grid = { width: 100, height: 80, cell_m: 10 };
const message = (parts = {}) => ({
  grid, kind: 'drawn', branching: false, revision: 1,
  rivers: [], coasts: [], lakes: [], masks: [], pins: [], ridges: [], ...parts,
});
const river = (...line) => ({ line, type: '', lambda: 0 });

test('an empty sheet has nothing near, nothing crossed and nothing downstream', () => {
  const drawing = new Drawing(message());
  assert.ok(drawing.empty);
  assert.equal(drawing.nearest({ x: 50, y: 40 }, 1000), null);
  assert.equal(drawing.crossed(0, 0, 100, 80, () => true), null);
  assert.equal(drawing.downstream.length, 0);
});

test('lines of one place or none have no length, and hold nothing', () => {
  assert.equal(lengthOf([]), 0);
  assert.equal(lengthOf([3, 4]), 0);
  assert.equal(inside(0, 0, []), false);
  assert.equal(inside(3, 4, [3, 4]), false);
  assert.deepEqual(bent([3, 4], 0, [5, 6], 10, false), [5, 6]);
});

test('parallel segments do not meet, nor do those of one line', () => {
  assert.equal(meeting(0, 0, 1, 0, 0, 1, 1, 1), -1);
  assert.equal(meeting(0, 0, 2, 0, 1, 0, 3, 0), -1);
});

test('where segments meet is on both, and ends count', () =>
  forAll(50, (random) => {
    const [ax, ay, bx, by, cx, cy, dx, dy] = Array.from({ length: 8 }, () => 10 * random());
    const t = meeting(ax, ay, bx, by, cx, cy, dx, dy);
    const sideOf = (x, y) => Math.sign((bx - ax) * (y - ay) - (by - ay) * (x - ax));
    const sideOfOther = (x, y) => Math.sign((dx - cx) * (y - cy) - (dy - cy) * (x - cx));
    const crosses = sideOf(cx, cy) !== sideOf(dx, dy) && sideOfOther(ax, ay) !== sideOfOther(bx, by);
    assert.equal(t >= 0, crosses);
    if (crosses) near(foot(ax + t * (bx - ax), ay + t * (by - ay), cx, cy, dx, dy).d, 0, 1e-9);
    near(meeting(ax, ay, bx, by, ax, ay, cx, cy), 0, 0);
  }));

test('a bend moves its vertex to the place, ends only where they are taken, and others less than it', () =>
  forAll(30, (random) => {
    const count = 3 + Math.floor(8 * random());
    const line = Array.from({ length: 2 * count }, () => 50 * random());
    const vertex = Math.floor(count * random());
    const to = [50 * random(), 50 * random()];
    const next = bent(line, vertex, to, 60, false);
    assert.deepEqual(next.slice(2 * vertex, 2 * vertex + 2), to);
    const moved = (k) => Math.hypot(next[2 * k] - line[2 * k], next[2 * k + 1] - line[2 * k + 1]);
    for (let k = 0; k < count; ++k) assert.ok(moved(k) <= moved(vertex) + 1e-9);
    for (const end of [0, count - 1]) if (end !== vertex) assert.equal(moved(end), 0);
    assert.deepEqual(bent(line, vertex, line.slice(2 * vertex, 2 * vertex + 2), 60, true), line);
  }));

test('a line cut at a place ends there and is no longer', () => {
  const line = [0, 0, 10, 0, 10, 10];
  assert.deepEqual(upTo(line, 2, { x: 10, y: 4 }), [0, 0, 10, 0, 10, 4]);
  assert.equal(lengthOf(upTo(line, 2, { x: 10, y: 4 })), 14);
});

test('the nearest object and the first that is crossed are those of trying every segment', () =>
  forAll(20, (random) => {
    const place = () => [100 * random(), 80 * random()];
    const rivers = Array.from({ length: 8 }, () => river(...place(), ...place(), ...place()));
    const drawing = new Drawing(message({ rivers }));
    const segments = drawing.rivers.flatMap(({ n, line }) => [2, 4].map((i) => [n, ...line.slice(i - 2, i + 2)]));
    const [x, y] = place();
    const away = segments.map(([, ...ends]) => foot(x, y, ...ends).d);
    const found = drawing.nearest({ x, y }, 30);
    const least = Math.min(...away);
    assert.equal(found?.object.n, least < 30 ? segments[away.indexOf(least)][0] : undefined);
    const [u, v] = place();
    const shares = segments.map(([, ...ends]) => meeting(x, y, u, v, ...ends)).filter((t) => t >= 0);
    assert.equal(drawing.crossed(x, y, u, v, () => true)?.t, shares.length ? Math.min(...shares) : undefined);
  }));

test('what is refused is not found, and what lies beside the grid is', () => {
  const drawing = new Drawing(message({ rivers: [river(-500, -500, -400, -500)], pins: [{ at: [5, 5], height: 1 }] }));
  assert.equal(drawing.nearest({ x: -450, y: -501 }, 5).object.kind, 'river');
  assert.equal(drawing.nearest({ x: 5, y: 5 }, 5, ({ kind }) => kind === 'river'), null);
  assert.equal(drawing.nearest({ x: 5, y: 5 }, 5).object.height, 1);
});

test('a river flows into the one that has its last vertex; of two that end together the later into the earlier', () => {
  const drawing = new Drawing(message({
    rivers: [river(0, 0, 50, 40, 99, 80), river(20, 70, 50, 40), river(90, 0, 99, 80), river(1, 1, 50, 41)],
  }));
  assert.deepEqual(Array.from(drawing.downstream), [-1, 0, 0, -1]);
  assert.deepEqual(drawing.above(drawing.rivers[0]).map(({ n }) => n), [0, 1, 2]);
  assert.deepEqual(drawing.above(drawing.rivers[3]).map(({ n }) => n), [3]);
});

test('an object is found again where its number changed, by its line, and else by what is most like it', () => {
  const before = new Drawing(message({ rivers: [river(0, 0, 10, 10), river(50, 0, 50, 60)] }));
  const after = new Drawing(message({ rivers: [river(50, 0, 50, 60.001)] }));
  assert.equal(after.same(before.rivers[0]), null);
  assert.equal(after.same(before.rivers[1]), after.rivers[0]);
  const moved = new Drawing(message({ rivers: [river(0, 0, 10, 10), river(51, 0, 50, 62)] }));
  assert.equal(moved.same(before.rivers[1]), null);
  assert.equal(moved.same(before.rivers[1], true), moved.rivers[1]);
});

test('a coast that ends where it begins is a ring, and so are lakes and masks', () => {
  const { coasts, lakes } = new Drawing(message({
    coasts: [[0, 0, 9, 0, 9, 9, 0, 0], [0, 5, 9, 5]], lakes: [{ ring: [1, 1, 5, 1, 5, 5], level: null }],
  }));
  assert.deepEqual(coasts.map(({ closed }) => closed), [true, false]);
  assert.deepEqual(coasts[0].line, [0, 0, 9, 0, 9, 9]);
  assert.deepEqual(lakes[0].outline, [1, 1, 5, 1, 5, 5, 1, 1]);
  assert.ok(inside(4, 2, lakes[0].line) && !inside(2, 4, lakes[0].line));
});
