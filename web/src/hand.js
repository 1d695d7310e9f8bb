// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What all drawing tools do: the cursor of the keyboard, and words for who does not see.
export const apart = (p, q) => Math.hypot(p.x - q.x, p.y - q.y);
export const round = (v) => Math.round(1000 * v) / 1000;
export const near = 12; // pixels within which a line meets what is there
const arrows = { ArrowLeft: [-4, 0], ArrowRight: [4, 0], ArrowUp: [0, 4], ArrowDown: [0, -4] };

export class Tool {
  cursor = 'crosshair';

  /** about: what tools.js says of a tool, {id, title, letter, icon, group, help: what to do with it}. */
  constructor(desk, overlay, about) {
    this.desk = desk;
    this.overlay = overlay;
    this.id = about.id;
    this.title = about.title;
    this.letter = about.letter;
    this.icon = about.icon;
    this.group = about.group;
    this.help = about.help;
  }

  /** Ends a gesture that was begun. */
  cancel() {}

  /** Forgets what was begun. */
  clear() {}

  /** The cursor is at a place {x, y}. */
  point(_at) {}

  /** A key presses at a place. */
  press(_at, _key) {}

  get view() {
    return this.desk.view;
  }

  taken() {
    if (this.id !== 'select') this.desk.choose(null);
    this.view.canvas.focus({ preventScroll: true });
    this.desk.hold(this);
    this.desk.speak(`${this.title}. ${this.help}`);
  }

  dropped() {
    this.cancel();
    this.clear();
    Object.assign(this.desk, { cursor: null, hovered: null });
    this.desk.quiet();
    this.desk.hold(null);
  }

  /** A key that moves the cursor over the land, or presses there; true where it did. */
  steps(event) {
    const { desk } = this;
    if (event.target !== this.view.canvas) return false;
    const by = arrows[event.key]?.map((v) => v * (event.shiftKey ? 10 : 1));
    if (by) this.point(desk.step(by[0], by[1]));
    else if (event.key === ' ' || event.key === 'Enter') return this.#pressed(event);
    else return false;
    return true;
  }

  /** The space bar is the view's own while no cursor is shown: with the left button it moves the view. */
  #pressed({ key, repeat }) {
    const { desk } = this;
    if (!desk.cursor && key === ' ') return false;
    if (!desk.cursor) this.point(desk.step(0, 0));
    else if (!repeat) this.press(desk.cursor, key);
    return true;
  }

  key(event) {
    return this.steps(event);
  }

  draw(pen, place) {
    this.overlay.cross(pen, place, this.desk.cursor);
  }
}
