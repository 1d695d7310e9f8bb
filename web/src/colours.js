// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Colours of the land and its rivers: those of the printed map.

/** From the lowest to the highest: sage, straw, sand, clay, white, joined in OKLab. */
export const tints = [
  [126, 166, 136], [137, 173, 140], [148, 181, 143], [159, 189, 147], [170, 196, 150], [185, 202, 155], [199, 208, 159],
  [214, 214, 164], [231, 210, 166], [227, 201, 162], [222, 193, 160], [225, 201, 177], [228, 209, 194], [233, 218, 207],
  [238, 227, 219], [243, 237, 231], [248, 246, 243]];

export function tint(share) {
  const place = Math.min(Math.max(share, 0), 1) * (tints.length - 1);
  const k = Math.min(Math.floor(place), tints.length - 2);
  return tints[k].map((c, i) => c + (tints[k + 1][i] - c) * (place - k));
}

const shallow = [78, 142, 206];
const deep = [12, 56, 140];

/** The higher the order, the wider and the deeper blue. width in pixels. */
export function riverStyle(order, highest) {
  const share = highest > 1 ? (order - 1) / (highest - 1) : 1;
  return { width: 1.1 + Math.min(0.75, 4 / Math.max(1, highest - 1)) * (order - 1), colour: shallow.map((c, i) => Math.round(c + (deep[i] - c) * share)) };
}

export const css = ([r, g, b]) => `rgb(${Math.round(r)} ${Math.round(g)} ${Math.round(b)})`;
export const ridgeColour = [120, 74, 40];
export const markColour = [255, 120, 0];
