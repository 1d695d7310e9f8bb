// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The packed blocks of a page, against packers that follow README.md word by word.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { deflateSync } from 'node:zlib';
import { bytesOf, unpackHeights, unpackLines } from '../src/unpack.js';
import { packLines } from './made_land.mjs';
import { forAll } from './support.mjs';

const base64 = (bytes) => deflateSync(Buffer.from(bytes)).toString('base64');

/** 16-bit heights, each row by a predictor of its own. */
function packed(q, width, predictors) {
  const at = (c, r) => (c < 0 || r < 0 ? 0 : q[r * width + c]);
  const residuals = Array.from(q, (value, i) => {
    const [c, r] = [i % width, Math.floor(i / width)];
    const [a, b, d] = [at(c - 1, r), at(c, r - 1), at(c - 1, r - 1)];
    const predicted = [b, a, a + b - d, Math.floor((a + b) / 2)][predictors[r]];
    const residual = ((value - predicted) << 16) >> 16;
    return residual < 0 ? -2 * residual - 1 : 2 * residual;
  });
  return base64([...predictors, ...residuals.map((v) => v & 255), ...residuals.map((v) => v >> 8)]);
}

test('an empty raster and no lines are empty', () => {
  assert.equal(unpackHeights(base64([]), 0, 0).length, 0);
  assert.deepEqual(unpackLines('', [], 1), []);
  assert.deepEqual(unpackLines(base64([]), [0], 1), [new Float64Array(0)]);
});

test('what is cut short or no zlib stream is refused', () => {
  assert.throws(() => bytesOf('AAAA'));
  assert.throws(() => unpackHeights(base64([0, 0]), 1, 1), /heights in this page are damaged/);
  assert.throws(() => unpackHeights(base64([0, 0, 0, 0]), 1, 1), /heights in this page are damaged/);
  assert.throws(() => unpackLines(base64([2]), [1], 1), /lines in this page are damaged/);
  assert.throws(() => unpackLines(base64([2, 128]), [1], 1), /lines in this page are damaged/);
});

test('heights come back bit for bit by each predictor, over the whole range of 16 bits', () =>
  forAll(20, (random) => {
    const [width, height] = [1 + Math.floor(9 * random()), 1 + Math.floor(9 * random())];
    const q = Uint16Array.from({ length: width * height }, () => Math.floor(65536 * random()));
    const predictors = Array.from({ length: height }, () => Math.floor(4 * random()));
    assert.deepEqual(unpackHeights(packed(q, width, predictors), width, height), q);
  }));

test('lines come back as they were, each from where the one before ended', () =>
  forAll(20, (random) => {
    const place = () => [Math.floor(1e6 * random()) / 16 - 3e4, Math.floor(1e6 * random()) / 16];
    const lines = Array.from({ length: 4 }, () => Array.from({ length: 1 + Math.floor(5 * random()) }, place));
    const unpacked = unpackLines(packLines(lines), lines.map((line) => line.length), 1 / 16);
    assert.deepEqual(unpacked.map((line) => Array.from(line)), lines.map((line) => line.flat()));
  }));

test('a difference beyond 31 bits is whole', () => {
  assert.deepEqual(unpackLines(packLines([[[0, 0], [2 ** 33, -(2 ** 34)]]]), [2], 1 / 16)[0][2], 2 ** 33);
});

test('the example of two rows and one line reads as by hand', () => {
  // Row 1 by its left: 5, 7; row 2 by what is above: 4, 9. Residuals 5, 2, -1, 2.
  assert.deepEqual(Array.from(unpackHeights(base64([1, 0, 10, 4, 1, 4, 0, 0, 0, 0]), 2, 2)), [5, 7, 4, 9]);
  assert.deepEqual(Array.from(unpackLines(base64([4, 1, 2, 172, 2]), [2], 0.5)[0]), [1, -0.5, 1.5, 74.5]);
});
