// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Lines as the ground's shader draws them: for each place of a raster the nearest segment, so that lines lie on the
// land at every zoom, as wide as their water, and join where they meet.

export const reach = 5; // [places] around a line in which it is known
const usual = 1024; // places along the longer side; of large grids one a cell, to twice as many
const columns = 1024; // of the tables of segments

export class LineField {
  constructor({ width, height }) {
    const longer = Math.max(width, height);
    this.cells = longer <= usual ? longer / usual : Math.max(1, longer / (2 * usual));
    this.width = Math.max(1, Math.round(width / this.cells));
    this.height = Math.max(1, Math.round(height / this.cells));
    this.nearest = new Float32Array(this.width * this.height); // number of a segment, from 1
    this.away = new Float32Array(this.width * this.height);
  }

  /**
   * groups: [{lines, half [places], pixels, share: [0, 1] of the colour, kind: 0 river, 1 ridge, 2 mark}], the later on
   * top.
   */
  build(groups) {
    const { cells, width, height, nearest, away } = this;
    nearest.fill(0);
    away.fill(Infinity);
    let count = 0;
    for (const { lines } of groups) for (const line of lines) count += Math.max(0, line.length / 2 - 1);
    this.rows = Math.max(1, Math.ceil(count / columns));
    const segments = (this.segments = new Float32Array(4 * columns * this.rows));
    const styles = (this.styles = new Float32Array(4 * columns * this.rows));
    let number = 0;
    for (const { lines, half, pixels, share, kind } of groups) {
      lines.forEach((line, l) => {
        const wide = typeof half === 'function' ? half(l) : half;
        const points = spaced(line, cells);
        for (let i = 2; i < points.length; i += 2) {
          const ax = points[i - 2];
          const ay = points[i - 1];
          const bx = points[i];
          const by = points[i + 1];
          const at = 4 * number++;
          segments[at] = ax;
          segments[at + 1] = ay;
          segments[at + 2] = bx;
          segments[at + 3] = by;
          styles[at] = Math.min(wide, reach - 1);
          styles[at + 1] = pixels;
          styles[at + 2] = share;
          styles[at + 3] = kind;
          const dx = bx - ax;
          const dy = by - ay;
          const square = dx * dx + dy * dy;
          const over = square > 0 ? 1 / square : 0;
          const c0 = Math.max(0, Math.floor(Math.min(ax, bx) - reach));
          const c1 = Math.min(width - 1, Math.ceil(Math.max(ax, bx) + reach));
          const r1 = Math.min(height - 1, Math.ceil(Math.max(ay, by) + reach));
          for (let r = Math.max(0, Math.floor(Math.min(ay, by) - reach)); r <= r1; ++r) {
            let k = r * width + c0;
            for (let c = c0; c <= c1; ++c, ++k) {
              let along = ((c - ax) * dx + (r - ay) * dy) * over;
              along = along < 0 ? 0 : along > 1 ? 1 : along;
              const ex = c - ax - along * dx;
              const ey = r - ay - along * dy;
              const d = ex * ex + ey * ey - 0.05 * kind;
              if (d < away[k] && d <= reach * reach) {
                away[k] = d;
                nearest[k] = number;
              }
            }
          }
        }
      });
    }
  }

  static get columns() {
    return columns;
  }
}

/** A line in places, no segment shorter than one: of shorter ones some would be nearest to no place, and missing. */
function spaced(line, cells) {
  const points = [line[0] / cells - 0.5, line[1] / cells - 0.5];
  for (let i = 2; i < line.length; i += 2) {
    const x = line[i] / cells - 0.5;
    const y = line[i + 1] / cells - 0.5;
    const near = (x - points.at(-2)) ** 2 + (y - points.at(-1)) ** 2 < 1;
    if (near && i + 2 < line.length) continue;
    if (near && points.length > 2) points.splice(-2);
    points.push(x, y);
  }
  return points;
}

/** Width of a river's water [m] from the area that it drains [m²]: bankfull width of Bieger et al. 2015. */
export function riverWidth(area) {
  return area > 0 ? 2.7 * (area / 1e6) ** 0.352 : 0;
}
