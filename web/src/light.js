// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Light on the land, by value of its raster: slopes, how much of the sky is seen, and the sun's soft shadow.

/** Slopes [m/m] to the east and to the south, central differences. */
export function slopes(land) {
  const { width, height, z } = land;
  const side = land.cells * land.grid.cell_m;
  const east = new Float32Array(z.length);
  const south = new Float32Array(z.length);
  for (let r = 0, i = 0; r < height; ++r) {
    const up = r > 0 ? width : 0;
    const down = r + 1 < height ? width : 0;
    const tall = side * ((up > 0 ? 1 : 0) + (down > 0 ? 1 : 0) || 1);
    for (let c = 0; c < width; ++c, ++i) {
      const left = c > 0 ? 1 : 0;
      const right = c + 1 < width ? 1 : 0;
      east[i] = (z[i + right] - z[i - left]) / (side * (left + right || 1));
      south[i] = (z[i + down] - z[i - up]) / tall;
    }
  }
  return { east, south };
}

/**
 * Share of the sky seen from each point of a coarser raster, by the horizon in eight directions.
 * lift: vertical exaggeration; longest: side of that raster. Gives {width, height, seen: [0, 1]}.
 */
export function skyView(land, lift, longest) {
  const stride = Math.max(1, Math.ceil(Math.max(land.width, land.height) / longest));
  const width = Math.ceil(land.width / stride);
  const height = Math.ceil(land.height / stride);
  const z = new Float32Array(width * height);
  for (let r = 0, i = 0; r < height; ++r) {
    const row = Math.min(r * stride + (stride >> 1), land.height - 1) * land.width;
    for (let c = 0; c < width; ++c, ++i) z[i] = land.z[row + Math.min(c * stride + (stride >> 1), land.width - 1)];
  }
  const scale = lift / (stride * land.cells * land.grid.cell_m);
  const far = [1, 2, 4, 7, 12, 20];
  const ways = [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1]];
  const seen = new Float32Array(z.length);
  for (const [dx, dy] of ways) {
    const unit = Math.hypot(dx, dy);
    for (let r = 0, i = 0; r < height; ++r) {
      for (let c = 0; c < width; ++c, ++i) {
        let steepest = 0;
        for (const n of far) {
          const x = c + n * dx;
          const y = r + n * dy;
          if (x < 0 || y < 0 || x >= width || y >= height) break;
          const rise = ((z[y * width + x] - z[i]) * scale) / (n * unit);
          if (rise > steepest) steepest = rise;
        }
        seen[i] += 1 / (8 * (1 + steepest * steepest)); // cos² of the horizon
      }
    }
  }
  return { width, height, seen };
}

/**
 * The sun's light that reaches each value, 0 to 255, with shadows that soften away from what casts them.
 * azimuth [rad] clockwise from the north, altitude [rad], lift: vertical exaggeration.
 */
export function sunlight(land, azimuth, altitude, lift) {
  const { width, height, z } = land;
  const light = new Uint8Array(z.length).fill(255);
  const towards = [Math.sin(azimuth), -Math.cos(azimuth)]; // to the sun, x to the east and y to the south
  const alongRows = Math.abs(towards[0]) > Math.abs(towards[1]); // sweep over columns instead of rows
  const main = alongRows ? towards[0] : towards[1];
  const shift = (alongRows ? towards[1] : towards[0]) / Math.abs(main);
  const sweep = alongRows ? width : height;
  const across = alongRows ? height : width;
  const stride = alongRows ? 1 : width;
  const beside = alongRows ? width : 1;
  const pace = Math.hypot(1, shift) * land.cells * land.grid.cell_m;
  const fall = (Math.tan(altitude) / lift) * pace;
  const blur = (0.06 / lift) * pace;
  let roof = new Float32Array(across).fill(-Infinity); // of the shadow, and how far from its caster
  let away = new Float32Array(across);
  let nextRoof = new Float32Array(across);
  let nextAway = new Float32Array(across);
  const whole = Math.floor(shift);
  const part = shift - whole;
  for (let s = 1; s < sweep; ++s) {
    const here = (main > 0 ? sweep - 1 - s : s) * stride;
    const before = here + (main > 0 ? stride : -stride);
    for (let a = 0; a < across; ++a) {
      const from = a + whole;
      const i = here + a * beside;
      if (from < 0 || from + (part > 0 ? 1 : 0) >= across) {
        nextRoof[a] = -Infinity;
        nextAway[a] = 0;
        continue;
      }
      const j = before + from * beside;
      const to = part > 0 ? 1 : 0;
      const ground = z[j] * (1 - part) + z[j + to * beside] * part;
      let top = roof[from];
      let far = away[from];
      if (to && roof[from + 1] > -Infinity) {
        top = top > -Infinity ? top * (1 - part) + roof[from + 1] * part : roof[from + 1];
        far = far * (1 - part) + away[from + 1] * part;
      }
      if (ground >= top) {
        top = ground;
        far = 0;
      }
      top -= fall;
      far += 1;
      nextRoof[a] = top;
      nextAway[a] = far;
      const soft = blur * (far + 1);
      const lit = 0.5 + (z[i] - top) / (2 * soft);
      if (lit < 1) light[i] = lit <= 0 ? 0 : Math.round(255 * lit * lit * (3 - 2 * lit));
    }
    [roof, nextRoof, away, nextAway] = [nextRoof, roof, nextAway, away];
  }
  return light;
}

/** Distance to the nearest value that is not set [values], by two sweeps; far from any: at most `most`. */
export function distanceInside(set, width, height, most) {
  const d = new Float32Array(set.length);
  for (let i = 0; i < d.length; ++i) d[i] = set[i] ? most : 0;
  const diagonal = Math.SQRT2;
  for (let r = 0, i = 0; r < height; ++r) {
    for (let c = 0; c < width; ++c, ++i) {
      let least = d[i];
      if (least === 0) continue;
      if (c > 0) least = Math.min(least, d[i - 1] + 1);
      if (r > 0) {
        least = Math.min(least, d[i - width] + 1);
        if (c > 0) least = Math.min(least, d[i - width - 1] + diagonal);
        if (c + 1 < width) least = Math.min(least, d[i - width + 1] + diagonal);
      }
      d[i] = least;
    }
  }
  for (let r = height - 1, i = width * height - 1; r >= 0; --r) {
    for (let c = width - 1; c >= 0; --c, --i) {
      let least = d[i];
      if (least === 0) continue;
      if (c + 1 < width) least = Math.min(least, d[i + 1] + 1);
      if (r + 1 < height) {
        least = Math.min(least, d[i + width] + 1);
        if (c + 1 < width) least = Math.min(least, d[i + width + 1] + diagonal);
        if (c > 0) least = Math.min(least, d[i + width - 1] + diagonal);
      }
      d[i] = least;
    }
  }
  return d;
}
