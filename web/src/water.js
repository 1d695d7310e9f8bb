// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Where water goes on the page's cells: D8 ways, drained areas, distances to the outlet and basins, made when first
// asked for.
import { bytesOf } from './unpack.js';

const stepX = [0, 1, 1, 0, -1, -1, -1, 0, 1];
const stepY = [0, 0, 1, 1, 1, 0, -1, -1, -1];

/** The way, counted from 1, down which the 16-bit heights fall most steeply; 0: nowhere (web/README.md). */
function steepest(q, width, height, c, r) {
  const here = q[r * width + c];
  let most = 0;
  let way = 0;
  for (let k = 1; k <= 8; ++k) {
    const x = c + stepX[k];
    const y = r + stepY[k];
    if (x < 0 || y < 0 || x >= width || y >= height) continue;
    const there = q[y * width + x];
    const drop = there > 0 && there < here ? here - there : 0;
    const steepness = drop * drop * (k % 2 === 1 ? 2 : 1);
    if (steepness > most) {
      most = steepness;
      way = k;
    }
  }
  return way;
}

export class Water {
  #base64;
  #bytes;
  #lakes;

  constructor(land, base64, hasLakes) {
    this.land = land;
    this.hasLakes = hasLakes;
    this.#base64 = base64.trim();
    this.known = this.#base64 !== '' && land.cells === 1 && !land.level;
  }

  get bytes() {
    this.#bytes ??= bytesOf(this.#base64);
    if (this.#bytes.length !== this.land.width * this.land.height) throw new Error('the water in this page is damaged');
    return this.#bytes;
  }

  /** 255 in lakes by value, or null without a lake. */
  get lakes() {
    if (!this.known || !this.hasLakes) return null;
    return (this.#lakes ??= Uint8Array.from(this.bytes, (b) => (b >= 16 ? 255 : 0)));
  }

  /** Receivers by value, -1 where water leaves. */
  get receivers() {
    if (this.to) return this.to;
    const { width, height, q } = this.land;
    const { bytes } = this;
    this.to = new Int32Array(width * height);
    for (let r = 0, i = 0; r < height; ++r) {
      for (let c = 0; c < width; ++c, ++i) {
        const way = (steepest(q, width, height, c, r) + (bytes[i] & 15)) % 9;
        this.to[i] = way ? i + stepX[way] + stepY[way] * width : -1;
      }
    }
    return this.to;
  }

  /** Values in an order in which every one comes before the value that takes its water. */
  get order() {
    if (this.downstream) return this.downstream;
    const to = this.receivers;
    const waiting = new Uint8Array(to.length);
    for (const t of to) if (t >= 0) ++waiting[t];
    const order = new Int32Array(to.length);
    let end = 0;
    for (let i = 0; i < to.length; ++i) if (waiting[i] === 0) order[end++] = i;
    for (let k = 0; k < end; ++k) {
      const t = to[order[k]];
      if (t >= 0 && --waiting[t] === 0) order[end++] = t;
    }
    this.downstream = order;
    return order;
  }

  /** Cells that drain through each, itself among them; 0 without a height. */
  get areas() {
    if (this.area) return this.area;
    const { receivers, order } = this;
    const { has } = this.land;
    this.area = Float32Array.from(receivers, (_, i) => (has && !has[i] ? 0 : 1));
    for (const i of order) if (receivers[i] >= 0) this.area[receivers[i]] += this.area[i];
    return this.area;
  }

  /** Distance along the water to where it leaves [cells]. */
  get distances() {
    if (this.away) return this.away;
    const { receivers, order } = this;
    const { width } = this.land;
    this.away = new Float32Array(receivers.length);
    for (let k = order.length - 1; k >= 0; --k) {
      const i = order[k];
      const t = receivers[i];
      if (t >= 0) this.away[i] = this.away[t] + ((i - t) % width === 0 || Math.abs(i - t) === 1 ? 1 : Math.SQRT2);
    }
    return this.away;
  }

  /** Basins by value, numbered from 1 by falling area; the smallest share 0, as do values without a height. */
  get basins() {
    if (this.basin) return this.basin;
    const { receivers, order, areas } = this;
    const outlets = [];
    for (let i = 0; i < receivers.length; ++i) if (receivers[i] < 0 && areas[i] > 0) outlets.push(i);
    outlets.sort((a, b) => areas[b] - areas[a]);
    const basin = new Int32Array(receivers.length);
    outlets.slice(0, 4096).forEach((i, k) => (basin[i] = k + 1));
    for (let k = order.length - 1; k >= 0; --k) {
      const i = order[k];
      if (receivers[i] >= 0) basin[i] = basin[receivers[i]];
    }
    this.basin = basin;
    return basin;
  }
}
