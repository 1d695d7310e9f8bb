// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The land as the page holds it: heights [m] on a raster of `cells` grid cells a side, NaN-free, with a mask of holes.
import { unpackHeights } from './unpack.js';

export class Land {
  #numbers;
  /** Whether it is coarse land of which all is to come. */
  draft = false;
  /** Of every slope [m/m], the one that nine in ten do not exceed, once it is known. @type {number | undefined} */
  steepest;

  /** heights: as packed in the page, or float32 values [m] with NaN where there is none. */
  constructor(grid, about, heights, sea) {
    this.grid = grid;
    this.sea = sea;
    if (about === null) { // rivers without a surface lie on level ground
      this.level = true;
      this.cells = Math.max(grid.width, grid.height) / 64;
      this.width = Math.max(1, Math.round(grid.width / this.cells));
      this.height = Math.max(1, Math.round(grid.height / this.cells));
      this.min = this.max = 0;
      this.holes = 0;
      this.z = new Float32Array(this.width * this.height);
      this.has = null;
      return;
    }
    this.level = false;
    this.cells = about.cells;
    this.width = about.width;
    this.height = about.height;
    this.min = about.min;
    this.max = about.max;
    this.holes = about.nodata;
    this.has = about.nodata > 0 ? new Uint8Array(about.width * about.height) : null;
    if (typeof heights === 'string') this.#unpack(heights);
    else this.#take(heights);
    const { has, z } = this;
    if (has && sea) z.forEach((_, i) => has[i] || (z[i] = sea.level));
    else if (this.has) this.#fillHoles();
  }

  #unpack(base64) {
    const q = (this.#numbers = unpackHeights(base64, this.width, this.height));
    const scale = (this.max - this.min) / 65534;
    this.z = new Float32Array(q.length);
    for (let i = 0; i < q.length; ++i) {
      this.z[i] = q[i] === 0 ? this.min : this.min + (q[i] - 1) * scale;
      if (this.has) this.has[i] = q[i] === 0 ? 0 : 255;
    }
  }

  #take(values) {
    this.z = Float32Array.from(values);
    for (let i = 0; this.has && i < values.length; ++i) {
      this.has[i] = Number.isNaN(values[i]) ? 0 : 255;
      if (!this.has[i]) this.z[i] = this.min;
    }
  }

  /** The heights as 16-bit numbers, 0 where there is none (web/README.md). */
  get q() {
    const range = this.max - this.min;
    this.#numbers ??= Uint16Array.from(this.z, (z, i) =>
      (this.has && !this.has[i] ? 0 : 1 + Math.floor((range > 0 ? (z - this.min) / range : 0) * 65534 + 0.5)));
    return this.#numbers;
  }

  /** Gives holes the heights beside them, so that the land does not fall into them: they are not drawn. */
  #fillHoles() {
    const { width, height, z } = this;
    const known = this.has.slice();
    const take = (i, j) => {
      if (known[i] || !known[j]) return;
      z[i] = z[j];
      known[i] = 1;
    };
    for (let r = 0, i = 0; r < height; ++r) {
      for (let c = 0; c < width; ++c, ++i) {
        if (c > 0) take(i, i - 1);
        if (r > 0) take(i, i - width);
      }
    }
    for (let r = height - 1, i = width * height - 1; r >= 0; --r) {
      for (let c = width - 1; c >= 0; --c, --i) {
        if (c + 1 < width) take(i, i + 1);
        if (r + 1 < height) take(i, i + width);
      }
    }
  }

  /** Height at a place [cells from the north-west corner], bilinear between centres of values. */
  heightAt(x, y) {
    const u = Math.min(Math.max(x / this.cells - 0.5, 0), this.width - 1);
    const v = Math.min(Math.max(y / this.cells - 0.5, 0), this.height - 1);
    const c = Math.min(Math.floor(u), Math.max(0, this.width - 2));
    const r = Math.min(Math.floor(v), Math.max(0, this.height - 2));
    const e = Math.min(c + 1, this.width - 1) - c;
    const s = (Math.min(r + 1, this.height - 1) - r) * this.width;
    const i = r * this.width + c;
    const fx = u - c;
    const fy = v - r;
    return (
      (this.z[i] * (1 - fx) + this.z[i + e] * fx) * (1 - fy) + (this.z[i + s] * (1 - fx) + this.z[i + e + s] * fx) * fy
    );
  }

  inside(x, y) {
    return x >= 0 && y >= 0 && x <= this.grid.width && y <= this.grid.height;
  }

  /** Whether the value at a place is a height. */
  known(x, y) {
    if (this.level) return false;
    if (!this.has) return true;
    const c = Math.min(Math.floor(x / this.cells), this.width - 1);
    const r = Math.min(Math.floor(y / this.cells), this.height - 1);
    return this.has[r * this.width + c] > 0;
  }

  /** Of every slope [m/m], the one that nine in ten do not exceed. */
  steepness() {
    return (this.steepest ??= this.#steepness());
  }

  #steepness() {
    if (this.level || this.width < 2 || this.height < 2) return 0;
    const slopes = [];
    const side = this.cells * this.grid.cell_m;
    const stride = Math.max(1, Math.floor(Math.sqrt((this.width * this.height) / 20000)));
    for (let r = 1; r < this.height; r += stride) {
      for (let c = 1; c < this.width; c += stride) {
        const i = r * this.width + c;
        if (this.has && !(this.has[i] && this.has[i - 1] && this.has[i - this.width])) continue;
        slopes.push(Math.hypot(this.z[i] - this.z[i - 1], this.z[i] - this.z[i - this.width]) / side);
      }
    }
    slopes.sort((a, b) => a - b);
    return slopes.length ? slopes[Math.floor(0.9 * (slopes.length - 1))] : 0;
  }
}
