// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The two packed blocks of the page; README.md says how they are written.
import { unzlibSync } from 'fflate';

export function bytesOf(base64) {
  const text = atob(base64.trim());
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return unzlibSync(bytes);
}

/** Heights as their 16-bit numbers, 0 where there is none. */
export function unpackHeights(base64, width, height) {
  const bytes = bytesOf(base64);
  const cells = width * height;
  if (bytes.length !== height + 2 * cells) throw new Error('the heights in this page are damaged');
  const low = height;
  const high = height + cells;
  const q = new Uint16Array(cells);
  for (let r = 0, i = 0; r < height; ++r) {
    const predictor = bytes[r];
    for (let c = 0; c < width; ++c, ++i) {
      const a = c > 0 ? q[i - 1] : 0;
      const b = r > 0 ? q[i - width] : 0;
      const d = c > 0 && r > 0 ? q[i - width - 1] : 0;
      const predicted = predictor === 0 ? b : predictor === 1 ? a : predictor === 2 ? a + b - d : (a + b) >> 1;
      const zigzag = bytes[low + i] | (bytes[high + i] << 8);
      q[i] = predicted + ((zigzag >>> 1) ^ -(zigzag & 1)); // modulo 2^16 by the array's type
    }
  }
  return q;
}

/** Lines as flat arrays [x0, y0, x1, y1, ...] in cells from the north-west corner. */
export function unpackLines(base64, counts, step) {
  if (counts.length === 0) return [];
  const bytes = bytesOf(base64);
  let at = 0;
  const next = () => {
    let value = 0;
    let scale = 1; // not shifts: a delta may exceed 31 bits
    for (;;) {
      if (at >= bytes.length) throw new Error('the lines in this page are damaged');
      const byte = bytes[at++];
      value += (byte & 127) * scale;
      if (byte < 128) break;
      scale *= 128;
    }
    return value % 2 === 0 ? value / 2 : -(value + 1) / 2;
  };
  let x = 0;
  let y = 0;
  return counts.map((n) => {
    const line = new Float64Array(2 * n);
    for (let k = 0; k < n; ++k) {
      x += next();
      y += next();
      line[2 * k] = x * step;
      line[2 * k + 1] = y * step;
    }
    return line;
  });
}
