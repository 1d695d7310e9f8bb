// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The map without WebGL: shaded and tinted land, contours and rivers on a plain canvas.
import { colourOf, css, markColour, orderColours, ridgeColour } from './colours.js';
import { contourPlaces, Labels } from './labels.js';
import { distanceInside } from './light.js';

export class View2d {
  mode = '2d';
  onmap = true;
  /** Only the view in 3-D has one. @type {any} */
  ground = null;
  /** What is shaded and painted. @type {HTMLCanvasElement | undefined} */
  picture;
  /** The view has been drawn, turned by an angle. @type {((turn: number) => void) | undefined} */
  ondraw;
  /** Gives the boxes that labels keep out of. @type {(() => object[]) | undefined} */
  keepOut;
  /** The graphics device was lost. @type {(() => void) | undefined} */
  onlost;
  /** It is there again. @type {(() => void) | undefined} */
  onfound;
  names = [];
  places = [];

  constructor(parent, land, rivers, options) {
    this.parent = parent;
    this.canvas = document.createElement('canvas');
    parent.append(this.canvas);
    this.labels = new Labels(parent);
    this.#hold(land, rivers, options);
    this.groups = [];
    this.marked = [];
    this.marks = []; // places [cells] shown by a ring
    this.zoom = 1;
    this.centre = [land.grid.width / 2, land.grid.height / 2];
    this.paper = [255, 255, 255];
    this.#listen();
  }

  /** Shows other land or rivers, as in view3d.js. */
  replace(land, rivers, options) {
    if (land === this.land && options.lakes === this.lakes) this.rivers = rivers;
    else {
      this.#hold(land, rivers, options);
      this.relief = this.contour = this.painted = undefined; // look() and paint() shade and trace it
    }
  }

  #hold(land, rivers, { lakes, sea }) {
    this.land = land;
    this.rivers = rivers;
    this.lakes = lakes;
    this.part = null;
    const { width, height } = land;
    this.shores = [];
    if (sea && land.has) {
      const wet = land.has.map((h) => (h ? 0 : 1));
      this.shores.push({
        wet,
        away: distanceInside(wet, width, height, 64),
        deep: 11,
        shallow: [168, 205, 214],
        bed: [92, 134, 172],
      });
    }
    if (lakes) {
      this.shores.push({
        wet: lakes,
        away: distanceInside(lakes, width, height, 64),
        deep: 4,
        shallow: [150, 194, 214],
        bed: [96, 148, 184],
      });
    }
  }

  #listen() {
    const held = new Map();
    this.canvas.addEventListener('pointerdown', (event) => {
      held.set(event.pointerId, [event.offsetX, event.offsetY]);
      this.canvas.setPointerCapture(event.pointerId);
    });
    this.canvas.addEventListener('pointermove', (event) => {
      const from = held.get(event.pointerId);
      if (!from) return;
      if (held.size === 1) {
        this.centre[0] -= (event.offsetX - from[0]) * this.cellsPerPixel;
        this.centre[1] -= (event.offsetY - from[1]) * this.cellsPerPixel;
      } else {
        const [other] = [...held].find(([id]) => id !== event.pointerId).slice(1);
        const apart = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]) || 1;
        this.zoom *= apart([event.offsetX, event.offsetY]) / apart(from);
      }
      held.set(event.pointerId, [event.offsetX, event.offsetY]);
      this.redraw();
    });
    const letGo = ({ pointerId }) => held.delete(pointerId);
    this.canvas.addEventListener('pointerup', letGo);
    this.canvas.addEventListener('pointercancel', letGo);
    this.canvas.addEventListener('wheel', (event) => {
      event.preventDefault();
      const [dx, dy] = [event.offsetX - this.parent.clientWidth / 2, event.offsetY - this.parent.clientHeight / 2];
      const before = this.cellsPerPixel;
      this.zoom = Math.min(60, Math.max(0.5, this.zoom * Math.exp(-event.deltaY * 0.0015)));
      this.centre[0] += dx * (before - this.cellsPerPixel);
      this.centre[1] += dy * (before - this.cellsPerPixel);
      this.redraw();
    }, { passive: false });
    this.canvas.style.touchAction = 'none';
  }

  get cellsPerPixel() {
    const { width, height } = this.land.grid;
    return (1.04 * Math.max(width / this.parent.clientWidth, height / this.parent.clientHeight)) / this.zoom;
  }

  home() {
    this.zoom = 1;
    this.centre = [this.land.grid.width / 2, this.land.grid.height / 2];
    this.resize();
  }

  map() {
    this.home();
  }

  resize() {
    this.ratio = Math.min(window.devicePixelRatio || 1, 2);
    this.canvas.width = Math.round(this.parent.clientWidth * this.ratio);
    this.canvas.height = Math.round(this.parent.clientHeight * this.ratio);
    this.draw();
  }

  look(how) {
    const relief = JSON.stringify([how.azimuth, how.altitude, how.shadeGain]);
    if (relief !== this.relief) {
      this.relief = relief;
      this.how = how;
      if (this.painted) this.#shade(how);
    }
    if (how.contour !== this.contour) {
      this.contour = how.contour;
      this.#trace(how.contour);
      this.places = contourPlaces(this.land, 5 * how.contour, 40);
    }
    this.redraw();
  }

  paint(painted) {
    this.painted = painted;
    if (this.how) this.#shade(this.how);
    this.redraw();
  }

  /** Shows a part of the land, as in view3d.js. */
  emphasize(inside) {
    this.part = null;
    this.redraw();
    if (!inside) return;
    const { width, height } = this.land;
    const picture = new ImageData(width, height);
    inside.forEach((set, i) => {
      if (!set) return;
      const c = i % width;
      const within = c > 0 && c + 1 < width && [i - 1, i + 1, i - width, i + width].every((k) => inside[k]);
      picture.data.set([...markColour, within ? 56 : 230], 4 * i);
    });
    this.part = Object.assign(document.createElement('canvas'), { width, height });
    this.part.getContext('2d').putImageData(picture, 0, 0);
  }

  #shade({ azimuth, altitude, shadeGain }) {
    const { land } = this;
    const { width, height, z } = land;
    const picture = new ImageData(width, height);
    const a = (azimuth * Math.PI) / 180;
    const h = (altitude * Math.PI) / 180;
    const sun = [Math.sin(a) * Math.cos(h), Math.cos(a) * Math.cos(h), Math.sin(h)];
    const scale = shadeGain / (2 * land.cells * land.grid.cell_m);
    const { values, palette } = this.painted;
    for (let r = 0, i = 0; r < height; ++r) {
      const up = r > 0 ? width : 0;
      const down = r + 1 < height ? width : 0;
      for (let c = 0; c < width; ++c, ++i) {
        if (land.level || (land.has && !land.has[i])) {
          picture.data.set(land.level ? [222, 219, 209, 255] : [0, 0, 0, 0], 4 * i);
          continue;
        }
        const dx = (z[c + 1 < width ? i + 1 : i] - z[c > 0 ? i - 1 : i]) * scale;
        const dy = (z[i + down] - z[i - up]) * scale;
        const light = (-dx * sun[0] + dy * sun[1] + sun[2]) / Math.hypot(dx, dy, 1) - sun[2];
        const at = colourOf(this.painted, (values ?? z)[i]);
        const ground = palette.subarray(at, at + 3);
        const share =
          light < 0
            ? Math.min(1, -light / Math.max(sun[2], 0.2))
            : 0.55 * Math.min(1, light / Math.max(1 - sun[2], 0.2));
        for (let k = 0; k < 3; ++k) {
          const end = light < 0 ? ground[k] * [0.26, 0.29, 0.4][k] : [255, 255, 245][k];
          picture.data[4 * i + k] = ground[k] + (end - ground[k]) * share;
        }
        picture.data[4 * i + 3] = 255;
      }
    }
    for (const { wet, away, deep, shallow, bed } of this.shores) {
      for (let i = 0; i < wet.length; ++i) {
        if (!wet[i]) continue;
        const share = 1 - Math.exp(-away[i] / deep);
        for (let k = 0; k < 3; ++k) picture.data[4 * i + k] = shallow[k] + (bed[k] - shallow[k]) * share;
        picture.data[4 * i + 3] = 255;
      }
    }
    this.picture ??= document.createElement('canvas');
    this.picture.width = width;
    this.picture.height = height;
    this.picture.getContext('2d').putImageData(picture, 0, 0);
  }

  /** Contours by marching squares, as segments in cells. */
  #trace(interval) {
    this.contours = new Map();
    const { land } = this;
    if (!(interval > 0) || land.level) return;
    const step = Math.max(1, Math.ceil(Math.max(land.width, land.height) / 700));
    const add = (level, x0, y0, x1, y1) => {
      if (!this.contours.has(level)) this.contours.set(level, []);
      this.contours.get(level).push(x0, y0, x1, y1);
    };
    for (let r = 0; r + step < land.height; r += step) {
      for (let c = 0; c + step < land.width; c += step) {
        const corners = [[c, r], [c + step, r], [c + step, r + step], [c, r + step]];
        const at = corners.map(([i, j]) => j * land.width + i);
        if (land.has && at.some((i) => !land.has[i])) continue;
        const z = at.map((i) => land.z[i]);
        const first = Math.floor(Math.min(...z) / interval) + 1;
        const last = Math.floor(Math.max(...z) / interval);
        for (let level = first; level <= last && level < first + 50; ++level) {
          const cuts = [];
          for (let k = 0; k < 4; ++k) {
            const [p, q] = [z[k], z[(k + 1) % 4]];
            const wanted = level * interval;
            if (p < wanted !== q < wanted) {
              const share = (wanted - p) / (q - p);
              const [a, b] = [corners[k], corners[(k + 1) % 4]];
              cuts.push(
                (a[0] + (b[0] - a[0]) * share + 0.5) * land.cells,
                (a[1] + (b[1] - a[1]) * share + 0.5) * land.cells,
              );
            }
          }
          for (let k = 0; k + 3 < cuts.length; k += 4) add(level, ...cuts.slice(k, k + 4));
        }
      }
    }
  }

  showLines({ orders, styles, ridges, marked, byClass, colours = orderColours }) {
    this.groups = styles.map(({ width, colour, share }) => ({
      lines: [],
      width,
      colour: byClass ? colours[share] : colour,
    }));
    orders.forEach(
      (order, k) => order > 0 && this.groups[Math.min(order, styles.length) - 1].lines.push(this.rivers.lines[k]),
    );
    this.marked = marked;
    this.showsRidges = ridges;
    this.redraw();
  }

  theme(name) {
    this.paper = name === 'dark' ? [38, 44, 52] : [226, 232, 236];
    this.labels.dark = false;
    this.redraw();
  }

  fly(x, y) {
    this.centre = [x, y];
    this.zoom = Math.max(this.zoom, 4);
    this.redraw();
  }

  project(x, y) {
    return {
      x: this.parent.clientWidth / 2 + (x - this.centre[0]) / this.cellsPerPixel,
      y: this.parent.clientHeight / 2 + (y - this.centre[1]) / this.cellsPerPixel,
    };
  }

  place(x, y) {
    return this.project(x, y);
  }

  redraw() {
    this.waiting ??= requestAnimationFrame(() => this.draw());
  }

  draw() {
    if (this.waiting) cancelAnimationFrame(this.waiting);
    this.waiting = undefined;
    const pen = this.canvas.getContext('2d');
    const scale = this.ratio / this.cellsPerPixel;
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.fillStyle = css(this.paper);
    pen.fillRect(0, 0, this.canvas.width, this.canvas.height);
    pen.setTransform(
      scale,
      0,
      0,
      scale,
      this.canvas.width / 2 - this.centre[0] * scale,
      this.canvas.height / 2 - this.centre[1] * scale,
    );
    if (this.picture) {
      pen.imageSmoothingEnabled = true;
      pen.imageSmoothingQuality = 'high';
      pen.save();
      pen.beginPath();
      pen.rect(0, 0, this.land.grid.width, this.land.grid.height);
      pen.clip();
      for (const layer of [this.picture, this.part]) {
        if (layer) pen.drawImage(layer, 0, 0, this.land.width * this.land.cells, this.land.height * this.land.cells);
      }
      pen.restore();
    }
    const px = this.ratio / scale;
    pen.lineJoin = pen.lineCap = 'round';
    for (const [level, segments] of this.contours ?? []) {
      pen.beginPath();
      for (let i = 0; i < segments.length; i += 4) {
        pen.moveTo(segments[i], segments[i + 1]);
        pen.lineTo(segments[i + 2], segments[i + 3]);
      }
      pen.lineWidth = (level % 5 === 0 ? 1.1 : 0.5) * px;
      pen.strokeStyle = `rgb(112 69 36 / ${level % 5 === 0 ? 0.6 : 0.45})`;
      pen.stroke();
    }
    const stroke = (lines, width, colour) => {
      pen.beginPath();
      for (const line of lines) {
        pen.moveTo(line[0], line[1]);
        for (let i = 2; i < line.length; i += 2) pen.lineTo(line[i], line[i + 1]);
      }
      pen.lineWidth = width * px;
      pen.strokeStyle = css(colour);
      pen.stroke();
    };
    if (this.showsRidges) stroke(this.rivers.ridges, 1.2, ridgeColour);
    for (const { lines, width, colour } of this.groups) stroke(lines, width + 0.3, colour);
    stroke(this.marked, 2.4, markColour);
    this.#write();
    this.ondraw?.(0);
  }

  #write() {
    /** @type {object[]} */
    const labels = this.names.map(({ x, y, text, kind }) => ({ text, kind, ...this.project(x, y) }));
    if (this.contour > 0) {
      for (const { x, y, z, dx, dy } of this.places) {
        const turn = Math.atan(dy / (dx || 1e-9));
        labels.push({ text: String(Math.round(z * 1000) / 1000), kind: 'contour', angle: turn, ...this.project(x, y) });
      }
    }
    const marks = this.marks.map(([x, y]) => this.project(x, y)).map(({ x, y }) => [x, y]);
    this.labels.draw(labels, this.cellsPerPixel * this.land.grid.cell_m, marks, this.ratio, this.keepOut?.() ?? []);
  }

  under(px, py) {
    const x = this.centre[0] + (px - this.parent.clientWidth / 2) * this.cellsPerPixel;
    const y = this.centre[1] + (py - this.parent.clientHeight / 2) * this.cellsPerPixel;
    return this.land.inside(x, y) ? { x, y } : null;
  }

  move({ turn = 0, tip = 0, right = 0, up = 0, zoom = 1 }) {
    this.zoom = Math.min(60, Math.max(0.5, this.zoom * zoom));
    const reach = this.cellsPerPixel * this.parent.clientHeight;
    this.centre[0] += (right + turn) * reach;
    this.centre[1] -= (up - tip) * reach;
    this.redraw();
  }
}
