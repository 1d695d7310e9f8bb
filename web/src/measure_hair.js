// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The cross-hair by which the keyboard measures: arrows move it, Enter is a click there.
import { high } from './measurements.js';

const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

export class CrossHair {
  /** Where it is, {x, y} [cells], or null. */
  at = null;
  #measuring;

  /** measuring: of measure.js */
  constructor(measuring) {
    this.#measuring = measuring;
  }

  get #page() {
    return this.#measuring.page;
  }

  /** Puts it in the middle of the view, unless it is somewhere. */
  #aim() {
    const { data, view } = this.#page;
    const { clientWidth, clientHeight } = view.parent;
    const { width, height } = data.grid;
    this.at ??= view.under(clientWidth / 2, clientHeight / 2) ?? { x: width / 2, y: height / 2 };
  }

  /** Moves it by an arrow, as the view is turned, unless it left the view. isFar: by ten times as much. */
  #step(key, isFar) {
    const { data, view } = this.#page;
    const turn = view.controls?.getAzimuthalAngle() ?? 0;
    const by = 4 * (isFar ? 10 : 1) * view.cellsPerPixel;
    const [right, up] = arrows[key].map((v) => v * by);
    const x = this.at.x + right * Math.cos(turn) - up * Math.sin(turn);
    const y = this.at.y - right * Math.sin(turn) - up * Math.cos(turn);
    const next = {
      x: Math.min(Math.max(x, 0), data.grid.width),
      y: Math.min(Math.max(y, 0), data.grid.height),
    };
    const seen = view.place(next.x, next.y);
    const { clientWidth, clientHeight } = view.parent;
    if (seen && seen.x >= 0 && seen.y >= 0 && seen.x <= clientWidth && seen.y <= clientHeight) this.at = next;
  }

  #move(event) {
    const { land } = this.#page;
    if (this.at) this.#step(event.key, event.shiftKey);
    else this.#aim();
    const { x, y } = this.at;
    this.#measuring.cursor = [x, y];
    const height = land.known(x, y) ? `, ${high(land.heightAt(x, y))}` : '';
    this.#measuring.card.speak(`cell ${Math.floor(x)}, ${Math.floor(y)}${height}`);
  }

  #enter(event) {
    const { tools } = this.#page;
    if (this.at) tools.held.set([this.at.x, this.at.y], event);
    else if (this.#measuring.shape?.drawing) this.#measuring.finish();
    else this.#aim();
  }

  /** Ends the line that is drawn, or puts away what is measured; false: there is nothing. */
  #escape() {
    const { shape } = this.#measuring;
    if (shape?.drawing) this.#measuring.finish();
    else if (shape) this.#measuring.drop();
    return Boolean(shape);
  }

  /** A key while a tool is held; true where it was for the tool. */
  key(event) {
    const { tools, view } = this.#page;
    if (event.key === 'Escape' && !event.target.closest?.('dialog')) return this.#escape();
    if (event.target !== view.canvas) return false;
    if (event.key.startsWith('Arrow')) this.#move(event);
    else if (event.key === 'Enter') this.#enter(event);
    else if (event.key === 'Backspace') this.#measuring.takeBack();
    else return false;
    tools.draw();
    return true;
  }
}
