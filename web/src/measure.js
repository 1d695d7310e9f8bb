// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Measuring on the land: what is held, what was found of it, and what the tools, the card and the drawing share.
import { typing } from './keys.js';
import { MeasureCard } from './measure_card.js';
import { controlsOf } from './measure_controls.js';
import { CrossHair } from './measure_hair.js';
import { MeasureOverlay } from './measure_overlay.js';
import { measuringTools } from './measure_tools.js';
import { measure } from './measurements.js';

/** The number of the point nearest to a place, within so many cells; -1: there is none. */
function nearestPoint(points, at, reach) {
  const off = (p) => (p.x - at.x) ** 2 + (p.y - at.y) ** 2;
  const best = points.reduce((least, p, i) => (off(p) < off(points[least]) ? i : least), 0);
  return off(points[best]) <= reach ** 2 ? best : -1;
}

/** Why tools measure nothing on this land, by their ids; falsy where they do. */
function lacksOf({ land, water }) {
  const noLand = land.level && 'there is no land yet';
  const noWater =
    land.cells > 1 && !land.draft
      ? 'not where the page shows means of squares of cells'
      : 'the ways of the water are still being computed';
  return { profile: noLand, section: noLand, catchment: !water.known && (noLand || noWater) };
}

export class Measuring {
  /** What is measured, on whatever land: {kind, grid, drawing: it is not finished, …}, or null. */
  shape = null;
  /** What was found of it (measurements.js), or null. */
  found = null;
  /** The place that is read in the diagram, {x, y}, or null. */
  mark = null;
  /** Where the next point may come, [x, y], or null. */
  cursor = null;
  #tools;

  /** page: of page.js, which has tools already. */
  constructor(page) {
    this.page = page;
    this.hair = new CrossHair(this);
    this.card = new MeasureCard(page.view.parent.parentElement, () => this.#close());
    const overlay = new MeasureOverlay(this);
    page.tools.layer((pen, place) => overlay.paint(pen, place));
    this.#tools = measuringTools(this);
    for (const tool of this.#tools) page.tools.add(tool);
    window.addEventListener('keydown', (event) => {
      if (event.key !== 'Escape' || !this.shape || page.tools.held || event.defaultPrevented) return;
      if (!typing(event) && !document.querySelector('dialog[open]')) this.drop();
    });
  }

  /** Whether a tool that measures is in the hand. */
  get isHeld() {
    return this.#tools.includes(this.page.tools.held);
  }

  /** What is measured on: as measure() wants it. */
  get context() {
    const { data, finder, land, pruning, rivers, water } = this.page;
    return { data, land, rivers, water, finder, orders: pruning.orders, slope: () => this.page.slope };
  }

  /** What is measured now: {kind, points: [{d, x, y [cells], z}] of its diagram, figures}, or null. */
  get result() {
    const { found, shape } = this;
    return found && { kind: shape.kind, points: found.points ?? null, line: found.line, ...found.figures };
  }

  /** So many pixels in cells, one and a half at least. */
  cellsOf(pixels) {
    return Math.max(pixels * this.page.view.cellsPerPixel, 1.5);
  }

  /** Keys go to the view, unless something else has them. */
  focusView() {
    if (document.activeElement === document.body) this.page.view.canvas.focus({ preventScroll: true });
  }

  #close() {
    const { tools, view } = this.page;
    this.drop();
    if (this.isHeld) tools.hold(null);
    view.canvas.focus({ preventScroll: true });
  }

  /** Shows the card as it is now. */
  show() {
    const { found, isHeld, page, shape } = this;
    const { held } = page.tools;
    this.card.show({
      isOpen: Boolean(shape) || isHeld,
      title: found?.title ?? held?.title ?? '',
      help: isHeld && (!shape || shape.drawing) ? held.help : '',
    });
    page.view.redraw(); // names keep out from under the card
  }

  /** Measures again what is held. isTold: to who does not see it, too. */
  renew(isTold = true) {
    if (!this.shape) return;
    this.found = measure(this.shape, this.context);
    const { found, page } = this;
    page.view.emphasize(found.inside ?? null);
    this.mark = null;
    this.card.fill(found, (place) => this.#point(place));
    if (isTold) this.card.speak(found.missing ?? found.sentence);
    this.show();
    page.tools.draw();
  }

  /** Begins another measurement. */
  begin(shape) {
    this.shape = { grid: JSON.stringify(this.page.data.grid), ...shape };
    this.renew(!shape.drawing);
    this.card.offer(...controlsOf(this));
  }

  /** Measures nothing any more. */
  drop() {
    this.shape = this.found = this.mark = this.cursor = this.hair.at = null;
    this.card.clear();
    this.page.view.emphasize(null);
    this.show();
    this.page.tools.draw();
  }

  /** Ends a line that is drawn. */
  finish() {
    const { shape } = this;
    if (!shape?.drawing) return;
    if (shape.points.length < 2) {
      this.drop();
      return;
    }
    shape.drawing = false;
    this.cursor = null;
    this.renew();
    this.card.offer(...controlsOf(this));
    this.focusView(); // the button has gone
  }

  /** Takes the last point of a line back. */
  takeBack() {
    const { shape } = this;
    if (!shape?.drawing) return;
    shape.points.pop();
    if (shape.points.length === 0) this.drop();
    else this.renew();
  }

  /** Marks a place on the land; null: none. */
  #point(place) {
    this.mark = place;
    this.page.tools.draw();
  }

  /** What is shown has changed. */
  changed() {
    const { page, shape } = this;
    const lacks = lacksOf(page);
    for (const tool of this.#tools) tool.enable(lacks[tool.id]);
    if (!shape) return;
    if (shape.grid !== JSON.stringify(page.data.grid)) this.drop();
    else this.renew(!shape.drawing);
  }

  /** The pointer is at a place of the land, or null: reads the diagram there. */
  hover(at) {
    const { found, mark, shape } = this;
    if (!found?.points || shape.drawing) return;
    const i = at ? nearestPoint(found.points, at, this.cellsOf(10)) : -1;
    if (i < 0 && !mark) return;
    this.card.read(i < 0 ? null : i);
    this.#point(i < 0 ? null : found.points[i]);
  }
}
