// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers in words, scales of diagrams and of sliders, and what lists and profiles are made of.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { between, layOut, number, roundBelow } from '../src/chart.js';
import { isStandard, limits, plain, scale } from '../src/fields.js';
import { parts } from '../src/ledger.js';
import { knickpoints } from '../src/profile.js';
import { forAll, near } from './support.mjs';

test('what is no number is a dash', () => {
  for (const none of [null, undefined, NaN, Infinity, -Infinity]) assert.equal(number(none), '–');
  assert.equal(number(0), '0');
  assert.equal(between([NaN, 0]), '––0');
});

test('a number in words is the number, to so many digits', () =>
  forAll(50, (random) => {
    const value = (random() - 0.5) * 10 ** Math.floor(12 * random() - 3);
    const read = Number(number(value, 4).replace(/\u202f/g, '').replace('\u2212', '-'));
    near(read, value, 5.1e-4 * Math.abs(value) + 5e-7);
  }));

test('numbers have thin spaces, a true minus, and powers where they are far from one', () => {
  assert.equal(number(-1234567.8), '\u22121\u202f234\u202f568');
  assert.equal(number(0.012345, 3), '0.0123');
  assert.equal(number(2.5e10), '2.50e+10');
  assert.equal(between([0.5, 1200]), '0.5–1\u202f200');
});

test('a round length is not above the one that is asked for, and more than a third of it', () =>
  forAll(50, (random) => {
    const length = 10 ** (12 * random() - 6);
    const round = roundBelow(length);
    assert.ok(round <= length * (1 + 1e-9) && round > 0.39 * length);
    assert.match(round.toExponential(3), /^[125]\.000e/);
  }));

test('one place alone and places of one height have room in a diagram', () => {
  for (const points of [[[3, 7]], [[1, 7], [2, 7]], [[0, 0]]]) {
    const { place, box } = layOut([{ points }], {}, 300);
    for (const point of points) {
      const [x, y] = place(point);
      assert.ok(x >= box.left && x <= box.right && y >= box.top && y <= box.bottom);
    }
  }
});

test('everything that is drawn lies in the box, in its order, and so do ticks', () =>
  forAll(30, (random) => {
    const what = { logX: random() < 0.5, logY: random() < 0.5, zeroY: false };
    const points = Array.from({ length: 5 }, () => [10 ** (6 * random() - 2), 10 ** (4 * random())]);
    const { place, box, x, y } = layOut([{ points }], what, 340);
    const places = points.map(place);
    for (const [px, py] of places) {
      assert.ok(px >= box.left - 1e-6 && px <= box.right + 1e-6 && py >= box.top - 1e-6 && py <= box.bottom + 1e-6);
    }
    points.forEach((p, i) => points.forEach((q, k) => p[0] < q[0] && assert.ok(places[i][0] < places[k][0])));
    assert.ok(x.ticks.length && x.ticks.every((t) => t >= x.low && t <= x.high * (1 + 1e-9)));
    assert.ok(y.ticks.length && y.ticks.every((t) => t >= y.low && t <= y.high * (1 + 1e-9)));
  }));

test('a value of a recipe is read without its quotes, and numbers as short as they are', () => {
  assert.deepEqual([undefined, '', "''", '"dla"', '1_0', '20.0', "'20.50'", '-0.0e3'].map((text) => plain(text)),
    ['', '', '', 'dla', '1_0', '20', '20.5', '0']);
});

test('a value is the default where it reads the same, also of defaults in words and of lists', () => {
  const words = { type: 'number', standard: '20 for dla and forest, else 0' };
  assert.deepEqual(['20', '20.0', '0', '19'].map((value) => isStandard(words, value)), [true, true, true, false]);
  const pair = { type: 'two numbers', standard: '[1, 2]' };
  assert.deepEqual(['[1.0, 2]', '[1, 3]'].map((value) => isStandard(pair, value)), [true, false]);
  assert.equal(limits({ range: '0 to 9', unit: 'm', standard: '4.0' }), '0 to 9 m; default 4');
  assert.equal(limits({ range: '', unit: '', standard: "''" }), '');
});

test('a key without two limits, or of another type, has no slider', () => {
  const key = { type: 'number', low: 0, high: 10, standard: '2' };
  for (const other of [{ low: null }, { high: null }, { high: 0 }, { type: 'text' }]) {
    assert.equal(scale({ ...key, ...other }), null);
  }
});

test('steps of a slider are 1, 2 or 5 times a power of ten', () => {
  const { toValue, toPlace } = scale({ type: 'number', low: 0, high: 10, standard: '2' });
  assert.deepEqual([0, 4, 5, 6, 500, 1000].map(toValue), [0, 0.05, 0.05, 0.05, 5, 10]);
  assert.equal(toPlace(2.5), 250);
});

test('a slider ascends within its limits, and finds its place again', () => {
  for (const key of [
    { type: 'number', low: 0, high: 10, standard: '2' },
    { type: 'integer', low: 1, high: 100000, standard: '20' },
    { type: 'number', low: -5, high: 5, standard: '0' },
    { type: 'number', low: 0, high: 1e7, standard: '20 for dla, else 0' },
  ]) {
    const { toValue, toPlace } = scale(key);
    let before = -Infinity;
    for (let place = 0; place <= 1000; place += 5) {
      const value = toValue(place);
      assert.ok(value >= before && value >= key.low && value <= key.high);
      near(toValue(toPlace(value)), value, 0.06 * Math.abs(value) + 1e-9, JSON.stringify(key));
      before = value;
    }
  }
});

test('lengths of rivers: none, then the network first and what was left out by length, without coastlines', () => {
  assert.deepEqual(parts([]), [{ name: 'in the network', length: 0 }]);
  const given = [
    ['read', 9, 'km'],
    ['left out: short', 1, 'km'],
    ['left out: coastlines', 4, 'km'],
    ['left out: far', 2, 'km'],
    ['in the network', 6, 'km'],
  ];
  assert.deepEqual(
    parts(given).map(({ name, length }) => [name, length]),
    [['in the network', 6], ['far', 2], ['short', 1]],
  );
});

test('an even or a level river has no knickpoint, a step has one at its lip', () => {
  const profile = (z) => Array.from({ length: 201 }, (_, i) => [10 * i, z(10 * i)]);
  assert.deepEqual(knickpoints(profile(() => 5)), []);
  assert.deepEqual(knickpoints(profile((d) => 0.01 * d)), []);
  const [lip, ...others] = knickpoints(profile((d) => 0.01 * d + Math.min(Math.max(d - 1000, 0), 60)));
  assert.equal(others.length, 0);
  near(10 * lip.index, 1060, 10);
});
