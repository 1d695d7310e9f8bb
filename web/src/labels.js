// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Words and the scale bar over the view, on a canvas of their own. No label covers another.

import { roundBelow } from './chart.js';

const family = "system-ui, 'Segoe UI', Roboto, 'DejaVu Sans', 'Noto Sans CJK SC', sans-serif";

export class Labels {
  boxes = []; // of what is written: {text, kind, x0, y0, x1, y1} in pixels of the page

  constructor(parent) {
    this.canvas = document.createElement('canvas');
    this.canvas.className = 'labels';
    this.canvas.setAttribute('aria-hidden', 'true');
    parent.append(this.canvas);
    this.parent = parent;
    this.dark = false;
  }

  /**
   * Draws what fits, the first first. all: [{text, kind: 'summit' | 'outlet' | 'contour', x, y [pixels], angle [rad]}];
   * scale: metres a pixel, or null; marks: [[x, y]] of points to show.
   */
  draw(all, scale, marks, ratio, keepOut = []) {
    const { clientWidth: width, clientHeight: height } = this.parent;
    this.canvas.width = Math.round(width * ratio);
    this.canvas.height = Math.round(height * ratio);
    const pen = this.canvas.getContext('2d');
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    const ink = this.dark ? '#f2efe6' : '#1f2226';
    const halo = this.dark ? 'rgb(20 23 27 / 0.8)' : 'rgb(255 255 252 / 0.85)';
    pen.lineJoin = 'round';
    pen.textBaseline = 'middle';
    this.boxes = [];
    const taken = [...keepOut];
    const free = (b) => b.x0 >= 2 && b.y0 >= 2 && b.x1 <= width - 2 && b.y1 <= height - 2 &&
      !taken.some((o) => b.x0 < o.x1 && o.x0 < b.x1 && b.y0 < o.y1 && o.y0 < b.y1);
    if (scale) {
      const bar = this.#scale(pen, scale, height, ink, halo);
      taken.push(bar);
      this.boxes.push({ text: bar.text, ...bar });
    }
    for (const label of all) {
      const size = label.kind === 'contour' ? 10.5 : 12;
      pen.font = `${label.kind === 'summit' ? 'italic ' : ''}${size}px ${family}`;
      const wide = pen.measureText(label.text).width;
      if (label.kind === 'contour') {
        const [c, s] = [Math.abs(Math.cos(label.angle)), Math.abs(Math.sin(label.angle))];
        const [hx, hy] = [(wide * c + size * s) / 2 + 2, (wide * s + size * c) / 2 + 2];
        const box = {
          text: label.text,
          kind: label.kind,
          x0: label.x - hx,
          x1: label.x + hx,
          y0: label.y - hy,
          y1: label.y + hy,
        };
        if (!free(box)) continue;
        taken.push(box);
        this.boxes.push(box);
        pen.save();
        pen.translate(label.x, label.y);
        pen.rotate(label.angle);
        pen.textAlign = 'center';
        this.#write(pen, label.text, 0, 0, this.dark ? '#e8c9a8' : '#6b4423', halo, 2.5);
        pen.restore();
        continue;
      }
      // Right of the place, else left, above, below.
      const gap = 6;
      const tries = [[gap, -size / 2], [-gap - wide, -size / 2], [-wide / 2, -size - gap], [-wide / 2, gap]];
      const found = tries
        .map(([dx, dy]) => ({
          text: label.text,
          kind: label.kind,
          x0: label.x + dx - 1,
          x1: label.x + dx + wide + 1,
          y0: label.y + dy - 2,
          y1: label.y + dy + size + 2,
        }))
        .find(free);
      if (!found) continue;
      const dot = { x0: label.x - 4, x1: label.x + 4, y0: label.y - 4, y1: label.y + 4 };
      taken.push(found, dot);
      this.boxes.push(found);
      pen.beginPath();
      if (label.kind === 'summit') {
        pen.moveTo(label.x, label.y - 4);
        pen.lineTo(label.x + 3.6, label.y + 2.6);
        pen.lineTo(label.x - 3.6, label.y + 2.6);
        pen.closePath();
      } else {
        pen.arc(label.x, label.y, 2.8, 0, 7);
      }
      pen.lineWidth = 2.2;
      pen.strokeStyle = halo;
      pen.stroke();
      pen.fillStyle = label.kind === 'outlet' ? (this.dark ? '#8cc0f0' : '#1b5793') : ink;
      pen.fill();
      pen.textAlign = 'left';
      this.#write(
        pen,
        label.text,
        found.x0 + 1,
        (found.y0 + found.y1) / 2,
        label.kind === 'outlet' ? (this.dark ? '#a9d2f7' : '#164a80') : ink,
        halo,
        3.2,
      );
    }
    for (const [x, y] of marks) {
      pen.beginPath();
      pen.arc(x, y, 6, 0, 7);
      pen.lineWidth = 4.5;
      pen.strokeStyle = halo;
      pen.stroke();
      pen.lineWidth = 2;
      pen.strokeStyle = '#d95f02';
      pen.stroke();
    }
  }

  #write(pen, text, x, y, ink, halo, wide) {
    pen.lineWidth = wide;
    pen.strokeStyle = halo;
    pen.strokeText(text, x, y);
    pen.fillStyle = ink;
    pen.fillText(text, x, y);
  }

  #scale(pen, perPixel, height, ink, halo) {
    const metres = roundBelow(130 * perPixel);
    const long = metres / perPixel;
    const [x, y] = [16, height - 16];
    const text = metres >= 1000 ? `${metres / 1000} km` : `${metres} m`;
    pen.beginPath();
    pen.moveTo(x, y - 5);
    pen.lineTo(x, y);
    pen.lineTo(x + long, y);
    pen.lineTo(x + long, y - 5);
    for (const [colour, wide] of [[halo, 4.5], [ink, 1.6]]) {
      pen.strokeStyle = colour;
      pen.lineWidth = wide;
      pen.stroke();
    }
    pen.font = `12px ${family}`;
    pen.textAlign = 'center';
    this.#write(pen, text, x + long / 2, y - 11, ink, halo, 3.2);
    return { text, x0: x - 4, x1: x + long + 4, y0: y - 22, y1: y + 4 };
  }
}

/**
 * Places for labels along index contours [{x, y [cells], z, dx, dy: direction of the contour}], far apart: where rows
 * and columns of the land cross a level, on gentle ground first.
 */
export function contourPlaces(land, interval, most) {
  const places = [];
  if (land.level || !(interval > 0)) return places;
  const stride = Math.max(4, Math.floor(Math.max(land.width, land.height) / 96));
  const side = land.cells * land.grid.cell_m;
  for (let r = stride; r + stride < land.height; r += stride) {
    for (let c = 2; c + 3 < land.width; ++c) {
      const i = r * land.width + c;
      if (land.has && !(land.has[i] && land.has[i + 1] && land.has[i - land.width] && land.has[i + land.width])) {
        continue;
      }
      const a = Math.floor(land.z[i] / interval);
      const b = Math.floor(land.z[i + 1] / interval);
      if (a === b) continue;
      const level = Math.max(a, b) * interval;
      const share = (level - land.z[i]) / (land.z[i + 1] - land.z[i]);
      const gx = (land.z[i + 2] - land.z[i - 1]) / 3;
      const gy = (land.z[i + land.width] - land.z[i - land.width]) / 2;
      const slope = Math.hypot(gx, gy) / side;
      places.push({ x: (c + 0.5 + share) * land.cells, y: (r + 0.5) * land.cells, z: level, dx: -gy, dy: gx, slope });
    }
  }
  places.sort((p, q) => p.slope - q.slope);
  const apart = Math.max(land.grid.width, land.grid.height) / 14;
  const chosen = [];
  for (const p of places) {
    if (chosen.length >= most) break;
    if (p.slope > 0 && chosen.every((o) => Math.hypot(o.x - p.x, o.y - p.y) > apart)) chosen.push(p);
  }
  return chosen;
}
