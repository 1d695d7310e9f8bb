// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What lies under the pointer, in words, and the keys of the view.
import { number } from './chart.js';
import { byId, make } from './elements.js';
import { windOf } from './lighting.js';

/** What a key does to the view: {turn, tip, right, up, zoom}, or undefined. moves: arrows move it, and do not turn. */
function motionOf(key, moves) {
  const arrows = moves
    ? { ArrowLeft: { right: -0.1 }, ArrowRight: { right: 0.1 }, ArrowUp: { up: 0.1 }, ArrowDown: { up: -0.1 } }
    : { ArrowLeft: { turn: -0.1 }, ArrowRight: { turn: 0.1 }, ArrowUp: { tip: -0.08 }, ArrowDown: { tip: 0.08 } };
  const zoom = { '+': 1.2, '=': 1.2, '-': 1 / 1.2, _: 1 / 1.2 }[key];
  return arrows[key] ?? (zoom && { zoom });
}

export class Pointer {
  #page;
  #pressed = null; // place on the canvas, [x, y] pixels
  #moved = null; // the frame in which the place is read

  constructor(page) {
    this.#page = page;
    byId('point').removeAttribute('aria-live'); // hovering would never let a reader speak: see the key P
    this.#followPointer();
    this.#followKeys();
  }

  /** What is at a place of the canvas [pixels], or null beside the land. number: of the arc, -1 for none. */
  pick(px, py) {
    const { data, finder, land, pruning, rivers, view } = this.#page;
    const at = view.under(px, py);
    if (!at) return null;
    const { grid } = data;
    const arc = finder.nearest(at.x, at.y, Math.max(1.5, 7 * view.cellsPerPixel), pruning.orders);
    const columns = Object.entries(rivers.arcs).filter(([key]) => key !== 'n');
    return {
      col: Math.min(Math.floor(at.x), grid.width - 1),
      row: Math.min(Math.floor(at.y), grid.height - 1),
      px: at.x,
      py: at.y,
      x: grid.west + at.x * grid.cell_m,
      y: grid.north - at.y * grid.cell_m,
      z: land.known(at.x, at.y) ? land.heightAt(at.x, at.y) : null,
      arc: arc < 0 ? null : Object.fromEntries(columns.map(([key, column]) => [key, column[arc]])),
      number: arc,
    };
  }

  /** Slope, aspect, drained area and distance to the outlet of a cell, for a place that was asked for by a click. */
  #detailOf(found) {
    const { data, land, slope, water } = this.#page;
    if (found.z === null) return [];
    const { east, south } = slope;
    const row = Math.min(Math.floor(found.row / land.cells), land.height - 1);
    const i = row * land.width + Math.min(Math.floor(found.col / land.cells), land.width - 1);
    const steep = (Math.atan(Math.hypot(east[i], south[i])) * 180) / Math.PI;
    const facing = ((Math.atan2(-east[i], south[i]) * 180) / Math.PI + 360) % 360;
    const words = [`slope ${steep.toFixed(1)}°` + (steep > 0.05 ? ` facing ${windOf(facing)}` : '')];
    if (water.known) {
      const cell = data.grid.cell_m;
      words.push(
        `drains ${number((water.areas[i] * cell * cell) / 1e6, 3)} km²`,
        `${number((water.distances[i] * cell) / 1000, 3)} km to the outlet`,
      );
    }
    return [words.join(' · ')];
  }

  #heightIn(found) {
    const { data, land } = this.#page;
    if (found.z !== null) return ` · ${found.z.toFixed(1)} m`;
    return data.sea && land.has ? ' · sea' : '';
  }

  /** Tells what was picked. all: with what takes room. */
  #tell(found, all = false) {
    if (!found) {
      byId('point').textContent = '';
      return;
    }
    const lines = [
      `${found.x.toFixed(1)}, ${found.y.toFixed(1)} · cell ${found.col}, ${found.row}${this.#heightIn(found)}`,
    ];
    if (all) lines.push(...this.#detailOf(found));
    if (found.arc) {
      const a = found.arc;
      const follows = a.ds ? `, flows into arc ${a.ds}` : ', ends at the outlet';
      lines.push(
        `arc ${a.id}: order ${a.strahler} (Shreve ${a.shreve}, Hack ${a.hack}), ${number(a.length)} m, ` +
          `${number(a.z_up)} → ${number(a.z_down)} m, drains ${number(a.ds_area / 1e6)} km²`,
        a.survives === null ? 'never pruned' : `pruned at L > ${number(a.survives)} cells${follows}`,
      );
    }
    byId('point').replaceChildren(...lines.map((textContent) => make('div', { textContent })));
  }

  /** Marks and tells what is at a place of the canvas [pixels]. */
  #ask(px, py) {
    const { lines } = this.#page;
    const found = this.pick(px, py);
    lines.pinned = found?.number ?? -1;
    lines.draw();
    this.#tell(found, true);
  }

  #hover(found) {
    const { measure, panel } = this.#page;
    this.#tell(found);
    measure.hover(found && { x: found.px, y: found.py });
    if (found && found.number >= 0) panel.hover(found.px, found.py, found.number);
    else panel.hover(null, null, -1);
  }

  #followPointer() {
    const { canvas } = this.#page.view;
    canvas.addEventListener('pointermove', (event) => {
      if (event.buttons !== 0 || this.#moved) return;
      const { offsetX, offsetY } = event;
      this.#moved = requestAnimationFrame(() => {
        this.#moved = null;
        this.#hover(this.pick(offsetX, offsetY));
      });
    });
    canvas.addEventListener('pointerleave', () => {
      if (this.#moved) cancelAnimationFrame(this.#moved);
      this.#moved = null;
      this.#hover(null);
    });
    canvas.addEventListener('pointerdown', (event) => (this.#pressed = [event.offsetX, event.offsetY]));
    canvas.addEventListener('pointerup', (event) => {
      const pressed = this.#pressed;
      if (!pressed || Math.hypot(event.offsetX - pressed[0], event.offsetY - pressed[1]) > 4) return;
      this.#ask(event.offsetX, event.offsetY);
    });
  }

  #followKeys() {
    const { view } = this.#page;
    const { canvas } = view;
    canvas.tabIndex = 0;
    canvas.setAttribute('role', 'application');
    canvas.setAttribute(
      'aria-label',
      `${view.mode === '2d' ? 'Map' : '3-D view'} of the terrain and its rivers. Arrow keys turn the view, ` +
        'with Shift they move it; plus and minus zoom; M shows the map; P reads what is in the middle; ' +
        '0 returns to the first view.',
    );
    canvas.addEventListener('keydown', (event) => {
      const motion = motionOf(event.key, event.shiftKey || view.onmap);
      if (motion) view.move(motion);
      else if (event.key === 'm' || event.key === 'M') byId('bmap').click();
      else if (event.key === '0') byId('bhome').click();
      else if (event.key === 'p' || event.key === 'P') {
        byId('point').setAttribute('aria-live', 'polite');
        this.#ask(canvas.clientWidth / 2, canvas.clientHeight / 2);
      } else return;
      event.preventDefault();
    });
  }
}
