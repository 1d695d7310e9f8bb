// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The drawing over the view: lines with the ways they run, shores, levels, masks, and what is being done to them.

export const ink = {
  river: '#1d6fd0',
  coast: '#0b6f79',
  lake: '#2b7ec8',
  mask: '#7b4bb5',
  pin: '#b3261e',
  ridge: '#7a4a1c',
};
export const red = '#d3122e';
export const orange = '#ff7800';
const casing = 'rgb(255 255 255 / 0.85)';
const shade = { held: 'rgb(18 22 30 / 0.42)', faint: 'rgb(18 22 30 / 0.2)' };

/** A line on the screen, as pieces where it is not behind the eye: [[x, y, …], …] [pixels]. */
function project(line, place, { thin, piece }) {
  const pieces = [];
  let now = null;
  const put = (x, y) => {
    const p = place(x, y);
    if (!p) now = null;
    else if (now) now.push(p.x, p.y);
    else pieces.push((now = [p.x, p.y]));
  };
  let [kx, ky] = [line[0], line[1]];
  put(kx, ky);
  for (let i = 2; i < line.length; i += 2) {
    const [x, y] = [line[i], line[i + 1]];
    const far = Math.hypot(x - kx, y - ky);
    if (far < thin && i + 2 < line.length) continue;
    for (let k = 1, parts = Math.ceil(far / piece); k < parts; ++k) {
      put(kx + (k / parts) * (x - kx), ky + (k / parts) * (y - ky));
    }
    put(x, y);
    [kx, ky] = [x, y];
  }
  return pieces;
}

function trace(pieces, closed, path = new Path2D()) {
  for (const piece of pieces) {
    path.moveTo(piece[0], piece[1]);
    for (let i = 2; i < piece.length; i += 2) path.lineTo(piece[i], piece[i + 1]);
    if (closed && pieces.length === 1) path.closePath();
  }
  return path;
}

const far = 10000; // pixels, beyond every screen

/** The part of x + t dx, y + t dy that lies within `far` of the view: [from, to] in t, from > to where none does. */
function within(x, y, dx, dy) {
  let [from, to] = [0, 1];
  for (const [v, d] of [[x, dx], [y, dy]]) {
    if (d === 0 && Math.abs(v) <= far) continue;
    const [a, b] = [(-far - v) / d, (far - v) / d];
    [from, to] = [Math.max(from, Math.min(a, b)), Math.min(to, Math.max(a, b))];
  }
  return from <= to ? [from, to] : [1, 0];
}

/** Places along a line, so many pixels apart: at(x, y, ux, uy: the way it runs there). */
function along(pieces, every, at) {
  for (const p of pieces) {
    let ahead = every / 2; // to the next place
    for (let i = 2; i < p.length; i += 2) {
      const [dx, dy] = [p[i] - p[i - 2], p[i + 1] - p[i - 1]];
      const length = Math.hypot(dx, dy);
      // A line that comes near the eye is as long as one likes: only what may be seen of it has places.
      const [from, to] = length > far ? within(p[i - 2], p[i - 1], dx, dy) : [0, 1];
      const skip = (until) => (ahead += Math.max(0, Math.ceil((until - ahead) / every)) * every);
      skip(from * length);
      for (; ahead <= to * length; ahead += every) {
        at(p[i - 2] + (ahead / length) * dx, p[i - 1] + (ahead / length) * dy, dx / length, dy / length);
      }
      skip(length);
      ahead = Number.isFinite(length) ? ahead - length : every / 2;
    }
  }
}

/** Heads of arrows along a line; turned: it runs the other way. */
function heads(pieces, every, turned, path = new Path2D()) {
  along(pieces, every, (x, y, dx, dy) => {
    const [ux, uy] = turned ? [-dx, -dy] : [dx, dy];
    path.moveTo(x - 3 * ux - 3.6 * uy, y - 3 * uy + 3.6 * ux);
    path.lineTo(x + 3 * ux, y + 3 * uy);
    path.lineTo(x - 3 * ux + 3.6 * uy, y - 3 * uy - 3.6 * ux);
  });
  return path;
}

/** Short strokes on the left of a line: land lies there. */
function ticks(pieces, path = new Path2D()) {
  along(pieces, 16, (x, y, ux, uy) => {
    path.moveTo(x, y);
    path.lineTo(x + 5 * uy, y - 5 * ux);
  });
  return path;
}

export function dot(pen, { x, y }, radius, { fill = '#fff', stroke = ink.river, width = 2 } = {}) {
  pen.beginPath();
  pen.arc(x, y, radius, 0, 2 * Math.PI);
  pen.fillStyle = fill;
  pen.strokeStyle = stroke;
  pen.lineWidth = width;
  pen.fill();
  pen.stroke();
}

/** A pin with its foot at a place. */
export function peg(pen, { x, y }, colour, opacity = 1) {
  const path = new Path2D();
  path.moveTo(x, y);
  path.bezierCurveTo(x - 1.5, y - 5, x - 5.5, y - 7.5, x - 5.5, y - 12);
  path.arc(x, y - 12, 5.5, Math.PI, 2 * Math.PI);
  path.bezierCurveTo(x + 5.5, y - 7.5, x + 1.5, y - 5, x, y);
  path.closePath();
  const before = pen.globalAlpha;
  pen.globalAlpha = before * opacity;
  pen.strokeStyle = casing;
  pen.lineWidth = 3;
  pen.stroke(path);
  pen.fillStyle = colour;
  pen.fill(path);
  pen.beginPath();
  pen.arc(x, y - 12, 2.1, 0, 2 * Math.PI);
  pen.fillStyle = '#fff';
  pen.fill();
  pen.globalAlpha = before;
}

/** Small triangles on both sides of a line: the land falls there. */
function teeth(pieces, path = new Path2D()) {
  along(pieces, 22, (x, y, ux, uy) => {
    for (const side of [1, -1]) {
      path.moveTo(x - 3.2 * ux, y - 3.2 * uy);
      path.lineTo(x - 4 * side * uy, y + 4 * side * ux);
      path.lineTo(x + 3.2 * ux, y + 3.2 * uy);
    }
  });
  return path;
}

/** Words on the land, as labels are. */
export function write(pen, text, { x, y }, colour) {
  pen.font = "600 12px system-ui, 'DejaVu Sans', sans-serif";
  pen.textAlign = 'center';
  pen.textBaseline = 'middle';
  pen.lineWidth = 3.5;
  pen.strokeStyle = casing;
  pen.strokeText(text, x, y);
  pen.fillStyle = colour;
  pen.fillText(text, x, y);
}

export class Overlay {
  #paths = new Map(); // of what is chosen and hovered, as long as the view stands still
  #picture = null; // likewise of all else: {stamp, canvas}
  #drawing = null;
  #handles = null;

  constructor(desk) {
    this.desk = desk;
  }

  /** The view has moved, or shows another land. */
  stale() {
    this.#paths.clear();
    this.#handles = null;
    if (this.#picture) this.#picture.stamp = '';
  }

  pieces(line, place) {
    const { view } = this.desk;
    const by = view.cellsPerPixel;
    return project(line, place, {
      thin: 0.8 * by,
      piece: view.onmap ? Infinity : Math.max(8 * by, 0.5 * view.land.cells),
    });
  }

  #of(object, place) {
    let made = this.#paths.get(object);
    if (!made) {
      const pieces = this.pieces(object.outline, place);
      made = { pieces, path: trace(pieces, object.closed) };
      this.#paths.set(object, made);
    }
    return made;
  }

  /** held: whether a drawing tool is in the hand. */
  paint(pen, place, held) {
    const { desk } = this;
    if (document.documentElement.dataset.before === 'on') return;
    if (desk.fits) this.#drawn(pen, place, held);
    if (!desk.lies) return;
    for (const ghost of desk.ghosts) {
      const colour = ghost.state === 'refused' ? red : ink[ghost.kind];
      if (ghost.kind === 'pin') this.#pins(pen, place, [ghost], colour);
      else this.stroke(pen, place, ghost.line, { ...ghost, colour, width: 2.2 });
    }
  }

  #drawn(pen, place, held) {
    const { desk } = this;
    const { drawing } = desk;
    if (drawing !== this.#drawing) this.stale();
    this.#drawing = drawing;
    const hidden = new Set(desk.ghosts.filter((one) => one.state === 'sent').flatMap((one) => one.hides ?? []));
    const { clientWidth, clientHeight } = desk.view.parent;
    if (held || drawing.objects.length > drawing.rivers.length) {
      pen.drawImage(this.#still(place, held, hidden), 0, 0, clientWidth, clientHeight);
    }
    if (held) this.#choice(pen, place, hidden);
  }

  /** What stays as it is while only the pointer moves, as a picture. */
  #still(place, held, hidden) {
    const { parent } = this.desk.view;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const [width, height] = [Math.round(parent.clientWidth * ratio), Math.round(parent.clientHeight * ratio)];
    const { chosen } = this.desk;
    const stamp = [
      held,
      this.desk.bends(),
      width,
      height,
      ratio,
      chosen?.height,
      chosen?.from,
      chosen?.to,
      ...Array.from(hidden, ({ kind, n }) => kind + n),
    ].join(' ');
    if (this.#picture?.stamp === stamp) return this.#picture.canvas;
    const canvas = this.#picture?.canvas ?? document.createElement('canvas');
    Object.assign(canvas, { width, height });
    const pen = canvas.getContext('2d', { willReadFrequently: true });
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.lineJoin = pen.lineCap = 'round';
    pen.globalAlpha = held ? 1 : 0.6;
    const { drawing } = this.desk;
    const seen = (objects) => objects.filter((one) => !hidden.has(one));
    this.#masks(pen, place, seen(drawing.masks), held);
    // The land shows its coasts and lakes itself, and hides what lies behind it.
    if (held || this.desk.view.land.level) {
      for (const lake of seen(drawing.lakes)) this.#lake(pen, place, lake, held);
      this.#lines(pen, place, seen(drawing.coasts), 1.8, held && ticks);
    }
    if (held || this.desk.view.onmap) {
      this.#lines(pen, place, seen(drawing.ridges), 1.6, teeth);
      this.#pins(pen, place, seen(drawing.pins));
      if (held) this.#heights(pen, place, seen(drawing.pins), seen(drawing.ridges));
    }
    if (held && drawing.kind === 'drawn') {
      // Beside rivers that meander about them these lines are no rivers themselves.
      const dash = this.desk.bends() ? [7, 5] : [];
      this.#lines(pen, place, seen(drawing.rivers), 1.5, (pieces, path) => heads(pieces, 90, false, path), dash);
    }
    this.#picture = { stamp, canvas };
    return canvas;
  }

  #masks(pen, place, masks, held) {
    if (masks.length === 0) return;
    const { clientWidth, clientHeight } = this.desk.view.parent;
    const land = this.desk.drawing.grid;
    const sheet = trace(
      this.pieces([0, 0, land.width, 0, land.width, land.height, 0, land.height, 0, 0], place),
      true,
    );
    pen.save();
    pen.clip(sheet);
    pen.fillStyle = held ? shade.held : shade.faint;
    pen.fillRect(0, 0, clientWidth, clientHeight);
    pen.globalAlpha = 1;
    pen.globalCompositeOperation = 'destination-out'; // masks may lie over one another
    for (const mask of masks) pen.fill(trace(this.pieces(mask.outline, place), true), 'evenodd');
    pen.restore();
    this.#lines(pen, place, masks, 1.6);
  }

  #lake(pen, place, lake, held) {
    pen.fillStyle = 'rgb(52 136 206 / 0.32)';
    pen.fill(trace(this.pieces(lake.outline, place), true));
    this.#lines(pen, place, [lake], 1.6);
    if (!held || lake.level === null) return;
    const { line } = lake;
    const n = line.length / 2;
    const [x, y] = [0, 1].map((k) => line.reduce((sum, v, i) => sum + (i % 2 === k ? v : 0), 0) / n);
    const at = place(x, y);
    if (at) write(pen, `${lake.level} m`, at, '#10508c');
  }

  #pins(pen, place, pins, colour = ink.pin) {
    for (const { line } of pins) {
      const p = line.length && place(line[0], line[1]);
      if (p) peg(pen, p, colour);
    }
  }

  /** Heights of pins and of the ends of ridges; where they are crowded, not each is written. */
  #heights(pen, place, pins, ridges) {
    const taken = new Set();
    const all = [
      ...pins.map(({ line, height }) => [height, line, ink.pin]),
      ...ridges.flatMap(({ line, from, to }) => [[from, line, ink.ridge], [to, line.slice(-2), ink.ridge]]),
    ];
    for (const [height, [x, y], colour] of all) {
      const p = height !== null && place(x, y);
      if (!p) continue;
      const [column, row] = [Math.floor(p.x / 30), Math.floor(p.y / 15)];
      if ([-1, 0, 1].some((c) => [-1, 0, 1].some((r) => taken.has(`${column + c} ${row + r}`)))) continue;
      taken.add(`${column} ${row}`);
      write(pen, `${height} m`, { x: p.x, y: p.y + 10 }, colour);
    }
  }

  /** Lines of one kind at once; marks: (pieces, path) adds what stands along them. */
  #lines(pen, place, objects, width, marks = null, dash = []) {
    if (objects.length === 0) return;
    const [lines, beside] = [new Path2D(), new Path2D()];
    for (const { outline, closed } of objects) {
      const pieces = this.pieces(outline, place);
      trace(pieces, closed, lines);
      if (marks) marks(pieces, beside);
    }
    for (const [style, more] of [[casing, 2.2], [ink[objects[0].kind], 0]]) {
      pen.strokeStyle = style;
      pen.lineWidth = width + more;
      pen.setLineDash(dash);
      pen.stroke(lines);
      pen.setLineDash([]);
      pen.lineWidth = 1.5 + more;
      pen.stroke(beside);
      if (objects[0].kind !== 'ridge') continue;
      pen.fillStyle = style;
      pen.fill(beside);
    }
  }

  /** What is under the pointer and what is chosen, with the way it runs. */
  #choice(pen, place, hidden) {
    const { chosen, hovered } = this.desk;
    for (const object of new Set([hovered?.object, chosen].filter((one) => one && !hidden.has(one)))) {
      if (object.kind === 'pin') {
        this.#pins(pen, place, [object], object === chosen ? orange : ink.pin);
        continue;
      }
      const { path, pieces } = this.#of(object, place);
      const colour = object === chosen ? orange : ink[object.kind];
      const marks =
        object.kind === 'river'
          ? heads(pieces, object === chosen ? 110 : 60)
          : object.kind === 'ridge'
            ? teeth(pieces)
            : null;
      for (const [style, width] of [[casing, 5.4], [colour, 2.8]]) {
        pen.strokeStyle = style;
        pen.lineWidth = width;
        pen.stroke(path);
        pen.lineWidth = width - 0.8;
        if (marks) pen.stroke(marks);
      }
      if (object.kind !== 'river') continue;
      const [source, outlet] = [place(object.line[0], object.line[1]), place(...object.line.slice(-2))];
      if (source) dot(pen, source, 4.5, { stroke: colour });
      if (outlet) dot(pen, outlet, 4.5, { fill: colour, stroke: '#fff', width: 1.5 });
    }
  }

  /** A line that is being drawn; from wrong.i on it is red. turned: it runs from its end to its begin. */
  stroke(
    pen,
    place,
    line,
    { closed = false, colour = ink.river, width = 2.4, dashed = false, arrows = false, turned = false, wrong = null },
  ) {
    if (line.length < 4) return;
    const good = wrong
      ? [...line.slice(0, 2 * wrong.i), wrong.x, wrong.y]
      : closed
        ? [...line, line[0], line[1]]
        : line;
    const parts = [[good, colour]];
    if (wrong) parts.push([[wrong.x, wrong.y, ...line.slice(2 * wrong.i)], red]);
    for (const [part, tone] of parts) {
      const pieces = this.pieces(part, place);
      const path = trace(pieces, false);
      if (arrows) heads(pieces, 48, turned, path);
      pen.strokeStyle = casing;
      pen.lineWidth = width + 2.6;
      pen.stroke(path);
      pen.setLineDash(dashed ? [1, 5] : []);
      pen.strokeStyle = tone;
      pen.lineWidth = width;
      pen.stroke(path);
      pen.setLineDash([]);
    }
  }

  /** The ring around what a line will meet. */
  ring(pen, place, target) {
    const at = target && place(target.x, target.y);
    if (!at) return;
    pen.beginPath();
    pen.arc(at.x, at.y, 8, 0, 2 * Math.PI);
    for (const [style, width] of [[casing, 5], [orange, 2.4]]) {
      pen.strokeStyle = style;
      pen.lineWidth = width;
      pen.stroke();
    }
  }

  cross(pen, place, at) {
    const p = at && place(at.x, at.y);
    if (!p) return;
    pen.beginPath();
    for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
      pen.moveTo(p.x + 3 * dx, p.y + 3 * dy);
      pen.lineTo(p.x + 12 * dx, p.y + 12 * dy);
    }
    for (const [style, width] of [[casing, 4], ['#16191d', 1.8]]) {
      pen.strokeStyle = style;
      pen.lineWidth = width;
      pen.stroke();
    }
  }

  /** Vertices that can be taken; closer ones than 20 pixels stand for their neighbours: [{i, x, y}]. */
  handles(object) {
    if (this.#handles?.object !== object) this.#handles = { object, all: this.#thinned(object) };
    return this.#handles.all;
  }

  #thinned({ line, closed }) {
    const count = line.length / 2;
    const at = (i) => this.desk.view.place(line[2 * i], line[2 * i + 1]);
    const all = [];
    const end = at(closed ? 0 : count - 1);
    const room = (p, q) => !q || Math.hypot(p.x - q.x, p.y - q.y) >= 20;
    for (let i = 0; i < count; ++i) {
      const p = at(i);
      const first = i === 0 || (!closed && i === count - 1);
      if (p && (first || (room(p, all.at(-1)) && room(p, end)))) all.push({ i, x: p.x, y: p.y });
    }
    return all;
  }
}
