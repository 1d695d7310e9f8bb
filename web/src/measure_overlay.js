// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What is measured, drawn over the view.
import { lengthOf, spread } from './survey.js';

const ink = '#d95f02';
const paper = 'rgb(255 255 252 / 0.9)';

function dot(pen, at, radius, { isFilled = false } = {}) {
  if (!at) return;
  pen.beginPath();
  pen.arc(at.x, at.y, radius, 0, 7);
  Object.assign(pen, { fillStyle: isFilled ? ink : paper, strokeStyle: isFilled ? paper : ink, lineWidth: 2 });
  pen.fill();
  pen.stroke();
}

function letter(pen, at, text) {
  if (!at) return;
  const font = '600 12px system-ui, sans-serif';
  Object.assign(pen, { font, textAlign: 'center', textBaseline: 'middle' });
  Object.assign(pen, { strokeStyle: paper, fillStyle: ink, lineWidth: 3.5 });
  pen.strokeText(text, at.x, at.y - 14);
  pen.fillText(text, at.x, at.y - 14);
}

function cross(pen, at) {
  if (!at) return;
  pen.beginPath();
  for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
    pen.moveTo(at.x + 4 * dx, at.y + 4 * dy);
    pen.lineTo(at.x + 15 * dx, at.y + 15 * dy);
  }
  for (const [strokeStyle, lineWidth] of [[paper, 4.5], ['#1f2226', 1.8]]) {
    Object.assign(pen, { strokeStyle, lineWidth }).stroke();
  }
}

export class MeasureOverlay {
  #measuring;

  /** measuring: of measure.js */
  constructor(measuring) {
    this.#measuring = measuring;
  }

  paint(pen, place) {
    const { found, hair, isHeld, shape } = this.#measuring;
    if (shape && found) this.#shape(pen, place, shape, found);
    if (hair.at && isHeld) cross(pen, place(hair.at.x, hair.at.y));
  }

  #shape(pen, place, shape, { line }) {
    const { cursor, mark } = this.#measuring;
    const whole = shape.drawing && cursor ? [...line, cursor] : line;
    if (whole.length > 1) this.#line(pen, place, whole);
    const corners = shape.freehand ? [line[0], line.at(-1)] : shape.points;
    for (const [x, y] of corners ?? []) dot(pen, place(x, y), 3.5);
    if (shape.kind === 'section') this.#handles(pen, place, shape);
    else if (shape.kind === 'catchment' && line.length) dot(pen, place(...line[0]), 4.5, { isFilled: true });
    if (mark) dot(pen, place(mark.x, mark.y), 6);
  }

  #handles(pen, place, section) {
    dot(pen, place(section.x, section.y), 3.5);
    for (const [side, name] of [[-1, 'L'], [1, 'R']]) {
      const at = place(...endOf(section, side));
      dot(pen, at, 5.5, { isFilled: true });
      letter(pen, at, name);
    }
  }

  /** Whether a place of the land, on the view at (px, py), is behind what stands before it. */
  #isHidden(x, y, { x: px, y: py }) {
    const { view } = this.#measuring.page;
    const { clientWidth, clientHeight } = view.parent;
    const inSight = px >= 0 && py >= 0 && px <= clientWidth && py <= clientHeight;
    return !view.onmap && inSight && !view.project(x, y);
  }

  /** A line over the land; dotted where it is hidden. */
  #line(pen, place, line) {
    const { land, view } = this.#measuring.page;
    const places = spread(land, line, Math.max(1, lengthOf(line) / 160), 160).map(({ x, y }) => [x, y]);
    const corners = line.length <= 60 && view.onmap ? line : places; // on the map straight is straight
    const spots = corners.map(([x, y]) => {
      const at = place(x, y);
      return at && { ...at, isHidden: this.#isHidden(x, y, at) };
    });
    const trace = (behind) => {
      pen.beginPath();
      for (let i = 1; i < spots.length; ++i) {
        const [a, b] = [spots[i - 1], spots[i]];
        if (!a || !b || (a.isHidden && b.isHidden) !== behind) continue;
        pen.moveTo(a.x, a.y);
        pen.lineTo(b.x, b.y);
      }
    };
    trace(false);
    for (const [strokeStyle, lineWidth] of [[paper, 5], [ink, 2.4]]) {
      Object.assign(pen, { strokeStyle, lineWidth }).stroke();
    }
    trace(true);
    pen.setLineDash([1, 5]);
    Object.assign(pen, { strokeStyle: ink, lineWidth: 1.6 }).stroke();
    pen.setLineDash([]);
  }
}

/** The end of a section [cells]; side: -1 left, 1 right. */
export function endOf({ x, y, ux, uy, left, right }, side) {
  const far = side * (side < 0 ? left : right);
  return [x + far * ux, y + far * uy];
}
