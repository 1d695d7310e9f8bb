// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The lands that a document may begin with: their words, and when they are offered unfolded.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { isFresh, sentence, titleOf } from '../src/presets.js';

test('names become titles, words become sentences', () => {
  assert.equal(titleOf('hills'), 'Hills');
  assert.equal(titleOf('basin-and-range'), 'Basin and range');
  assert.equal(sentence('a plain, 10 km wide'), 'A plain, 10 km wide.');
});

test('a document is fresh until something else than a preset is chosen, and while it names no file', () => {
  const files = [{ path: 'network.lines.path' }, { path: 'surface.mask' }];
  const document = (undo = '', redo = '', values = {}) => ({ undo, redo, values });
  assert.ok(isFresh(document(), files));
  assert.ok(isFresh(document('preset hills'), files));
  assert.ok(isFresh(document('', 'preset hills'), files));
  assert.ok(isFresh(document('', '', { 'network.lines.path': null, 'surface.mask': "''" }), files));
  assert.ok(!isFresh(document('seed = 8'), files));
  assert.ok(!isFresh(document('preset hills', 'seed = 8'), files));
  assert.ok(!isFresh(document('', '', { 'network.lines.path': "'inputs/1/rivers.gpkg'" }), files));
});
