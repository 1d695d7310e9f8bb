// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the tests of the page's functions share.
import assert from 'node:assert/strict';

export const near = (got, wanted, within, what = '') =>
  assert.ok(Math.abs(got - wanted) <= within, `${what} ${got} for ${wanted}`);

/** Numbers in [0, 1), the same from a seed every time. */
export function randomNumbers(seed) {
  let state = seed;
  return () => {
    state = (state * 48271) % 2147483647;
    return state / 2147483647;
  };
}

/** Runs a property with numbers of its own, so many times. */
export function forAll(times, property) {
  for (let seed = 1; seed <= times; ++seed) property(randomNumbers(9973 * seed));
}
