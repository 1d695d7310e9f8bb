// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The tools that measure (tools.js says what a tool is): by clicks, by a line, across a valley.
import { widen } from './measure_controls.js';
import { endOf } from './measure_overlay.js';
import { courseAt, fallAt, leastReach, riverOf, sectionAcross } from './survey.js';

const isTouch = (event) => event?.pointerType === 'touch';

/** A click, or Enter at the cross-hair, measures at a place. */
class ClickTool {
  group = 9;
  cursor = 'crosshair';
  /** In the bar of tools. */
  button;

  /** measuring: of measure.js; about: {id, letter, title, icon, help: what to do with it}. */
  constructor(measuring, { id, letter, title, icon, help }) {
    this.measuring = measuring;
    this.id = id;
    this.letter = letter;
    this.title = title;
    this.icon = icon;
    this.help = help;
  }

  /** lack: why it measures nothing now; falsy: it does. */
  enable(lack) {
    const { button, letter, title } = this;
    button.disabled = Boolean(lack);
    button.title = lack ? `${title}: ${lack}` : `${title} (${letter.toUpperCase()})`;
  }

  /** The arc within so many pixels of a place, or -1. */
  riverAt([x, y], pixels) {
    const { finder, pruning } = this.measuring.page;
    return finder.nearest(x, y, this.measuring.cellsOf(pixels), pruning.orders);
  }

  /** Measures at a place [x, y]. */
  set(_at, _event) {}

  key(event) {
    return this.measuring.hair.key(event);
  }

  down(at, _event) {
    return at !== null;
  }

  up(at, event) {
    if (at) this.set([at.x, at.y], event);
  }

  hover(at) {
    const { hair, page, shape } = this.measuring;
    hair.at = null;
    this.measuring.cursor = at ? [at.x, at.y] : null;
    if (shape?.drawing) page.tools.draw();
  }

  taken() {
    this.measuring.show();
    this.measuring.focusView();
  }

  dropped() {
    if (this.measuring.shape?.drawing) this.measuring.finish();
    this.measuring.hair.at = null;
    queueMicrotask(() => this.measuring.show()); // when the next is held
  }
}

class CatchmentTool extends ClickTool {
  set(at, event) {
    this.measuring.begin({ kind: 'catchment', at, reach: this.measuring.cellsOf(isTouch(event) ? 16 : 8) });
  }
}

/** Sets points by clicks, or by Enter at the cross-hair; one more on the last ends the line. */
class LineTool extends ClickTool {
  #pressed = null; // {x, y [pixels], at, isFree: it draws}
  #renews = false; // with the next frame

  /** What its shape is; a profile is also drawn freely, a distance may be closed. */
  get kind() {
    return this.id;
  }

  get isDrawing() {
    const { shape } = this.measuring;
    return Boolean(shape?.drawing) && shape.kind === this.kind;
  }

  /** Whether a click measures something else than a line, and then does. */
  startsAt(_at, _event) {
    return false;
  }

  #begin(at) {
    this.measuring.begin({ kind: this.kind, points: [at], drawing: true, closed: false });
  }

  /** How far two places are from each other on the view [pixels]. */
  #apart([x, y], [u, v]) {
    const { view } = this.measuring.page;
    const [a, b] = [view.place(x, y), view.place(u, v)];
    return a && b ? Math.hypot(a.x - b.x, a.y - b.y) : Infinity;
  }

  set(at, event) {
    if (!this.isDrawing) {
      if (!this.startsAt(at, event)) this.#begin(at);
      return;
    }
    const near = event.type === 'keydown' ? 1.5 : isTouch(event) ? 18 : 8;
    const { shape } = this.measuring;
    const { points } = shape;
    shape.closed = this.kind === 'distance' && points.length > 2 && this.#apart(points[0], at) < near;
    if (shape.closed || this.#apart(points.at(-1), at) < near) {
      this.measuring.finish();
      return;
    }
    points.push(at);
    this.measuring.renew();
  }

  down(at, event) {
    if (!at) return false;
    this.#pressed = { x: event.clientX, y: event.clientY, at: [at.x, at.y], isFree: false };
    return true;
  }

  move(at, event) {
    const pressed = this.#pressed;
    if (!pressed || !at || this.kind !== 'profile') return;
    const moved = Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y);
    if (!pressed.isFree && moved < (isTouch(event) ? 10 : 5)) return;
    if (!pressed.isFree && !this.isDrawing) this.#begin(pressed.at);
    else if (pressed.isFree && moved < 4) return;
    Object.assign(pressed, { isFree: true, x: event.clientX, y: event.clientY });
    const { shape } = this.measuring;
    shape.points.push([at.x, at.y]);
    shape.freehand = true;
    this.#renewSoon();
  }

  /** Measures again with the next frame. */
  #renewSoon() {
    if (this.#renews) return;
    this.#renews = true;
    requestAnimationFrame(() => {
      this.#renews = false;
      if (this.measuring.shape?.drawing) this.measuring.renew(false);
    });
  }

  up(_, event) {
    const { isFree, at } = this.#pressed ?? {};
    this.#pressed = null;
    if (isFree) this.measuring.finish();
    else if (at) this.set(at, event);
  }

  cancel() {
    this.#pressed = null;
  }
}

class ProfileTool extends LineTool {
  startsAt(at, event) {
    const reach = isTouch(event) ? 14 : 7; // as the page names what is under the pointer
    if (event?.shiftKey || this.riverAt(at, reach) < 0) return false;
    this.measuring.begin({ kind: 'river', at, reach: this.measuring.cellsOf(reach) });
    return true;
  }
}

/** Sections across a valley, or down the fall of the land; their ends can be drawn. */
class SectionTool extends ClickTool {
  #handle = null; // the end that is drawn: -1 left, 1 right

  set(at, event) {
    const { land, rivers } = this.measuring.page;
    const arc = this.riverAt(at, isTouch(event) ? 22 : 12);
    const isRiver = arc >= 0;
    const reach = 5 * land.cells;
    const [x, y] = at;
    const course = isRiver
      ? courseAt(riverOf(this.measuring.context, arc).line, x, y, reach)
      : fallAt(land, x, y, reach);
    const look = leastReach(land, isRiver ? rivers.arcs.ds_area[arc] : 0);
    this.measuring.begin({ kind: 'section', ...sectionAcross(land, course, look), river: isRiver });
  }

  /** The end of the section under the pointer, or null. */
  #handleAt(event) {
    const { page, shape } = this.measuring;
    if (shape?.kind !== 'section') return null;
    const { view } = page;
    const frame = view.canvas.getBoundingClientRect();
    const reach = isTouch(event) ? 24 : 11;
    const isNear = (side) => {
      const p = view.place(...endOf(shape, side));
      return p !== null && Math.hypot(p.x - event.clientX + frame.left, p.y - event.clientY + frame.top) < reach;
    };
    return [-1, 1].find(isNear) ?? null;
  }

  down(at, event) {
    if (!at) return false;
    this.#handle = this.#handleAt(event);
    return true;
  }

  move(at) {
    if (!this.#handle || !at) return;
    const { shape } = this.measuring;
    const out = this.#handle * ((at.x - shape.x) * shape.ux + (at.y - shape.y) * shape.uy);
    widen(this.measuring, this.#handle < 0 ? out : shape.left, this.#handle > 0 ? out : shape.right);
  }

  up(at, event) {
    if (!this.#handle) super.up(at, event);
    this.#handle = null;
  }

  cancel() {
    this.#handle = null;
  }
}

/** The tools in their order. */
export function measuringTools(measuring) {
  return [
    new ProfileTool(measuring, {
      id: 'profile',
      letter: 'l',
      title: 'Profile',
      help: 'Draw a line, or click its points. A click on a river gives its profile (with Shift: a point).',
      icon: 'M2 15l4-7 4 4 4-8 4 6M2 18h16',
    }),
    new SectionTool(measuring, {
      id: 'section',
      letter: 'x',
      title: 'Cross-section',
      help: 'Click a river for the section across its valley. Drag its ends to change the width.',
      icon: 'M2 5l4 2 3 8h2l3-8 4-2M9 18h2',
    }),
    new CatchmentTool(measuring, {
      id: 'catchment',
      letter: 'c',
      title: 'Catchment',
      help: 'Click a place, or a river, for all land that drains through it.',
      icon: 'M10 18c0-4-7-5-7-10 0-4 3-6 7-6s7 2 7 6c0 5-7 6-7 10zM10 18v-7M10 11L7 7M10 11l3-4',
    }),
    new LineTool(measuring, {
      id: 'distance',
      letter: 'd',
      title: 'Distance and height',
      help: 'Click the points of a way; its beginning once more closes it.',
      icon: 'M2 14L14 2l4 4L6 18zM6 10l2 2M9 7l2 2M12 4l2 2',
    }),
  ];
}
