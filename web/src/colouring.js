// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// By what the land and its rivers are coloured: the reader's choice, and the view as it has it.
import { modes, orderColours, riverStyle } from './colours.js';
import { byId, inputById, make, selectById, tellAll } from './elements.js';
import { Land } from './land.js';
import { showLegend } from './legend.js';
import { metres } from './panel.js';

/** Heights of another report page as they lie on this one's raster. Throws when it is none, or of another grid. */
function heightsOf(html, land) {
  const page = new DOMParser().parseFromString(html, 'text/html');
  const text = (id) => page.getElementById(id)?.textContent;
  if (!text('data')) throw new Error('this is not a report page of thalweg');
  const data = JSON.parse(text('data'));
  const there = new Land(data.grid, data.heights, text('heights') ?? '', data.sea ?? null);
  const same =
    ['width', 'height', 'cell_m', 'west', 'north'].every((key) => data.grid[key] === land.grid[key]) &&
    there.width === land.width;
  if (!same || there.level) throw new Error('it shows another grid: a difference needs the same cells');
  return there.z;
}

/** The colours of the land. */
export class Colouring {
  #page;
  #mode = 'height';
  #painted = null;
  #other = null; // heights of another report
  #select = selectById('colour');

  constructor(page) {
    this.#page = page;
    this.#select.addEventListener('change', () => {
      const { value } = this.#select;
      if (value !== 'difference') this.#choose(value);
      else {
        inputById('other').click();
        this.#select.value = this.#mode;
      }
    });
    inputById('other').addEventListener('change', () => this.#compare());
  }

  /** 'hack' or 'strahler' where rivers are coloured by these orders. */
  get lines() {
    return modes[this.#mode].lines;
  }

  get mode() {
    return this.#mode;
  }

  /** Takes the report that the reader gives for the difference of heights. */
  async #compare() {
    const input = inputById('other');
    const [file] = input.files;
    input.value = '';
    if (!file) return;
    try {
      this.#other = heightsOf(await file.text(), this.#page.land);
      tellAll('');
      this.#select.value = 'difference';
      this.#choose('difference');
    } catch (error) {
      tellAll(`${file.name}: ${error.message}`);
    }
  }

  #choose(name) {
    this.#mode = name;
    this.paint();
    this.#page.lines.draw();
    this.showLegend();
  }

  #can(name) {
    const { land, rivers, water } = this.#page;
    return { water: water.known, rivers: rivers.count > 0, other: !land.level }[modes[name].needs] ?? true;
  }

  /** What is painted now: the chosen colours, or plain ones while the land or its water is not known. */
  get #paintable() {
    const { land } = this.#page;
    if (land.level) return 'none';
    const lacks = this.#mode === 'difference' && this.#other?.length !== land.z.length;
    return this.#can(this.#mode) && !lacks ? this.#mode : 'height';
  }

  paint() {
    const { land, water, view, slope } = this.#page;
    this.#painted = modes[this.#paintable].make({
      land, water, other: this.#other, slope, metres: (z) => metres(z, land),
    });
    view.paint(this.#painted);
  }

  /** The ways to colour this land, and the one that is chosen even where its water is yet to come. */
  offer() {
    this.#select.disabled = this.#page.land.level;
    const names = Object.keys(modes).filter((name) => this.#can(name) || name === this.#mode);
    if (names.join() === Array.from(this.#select.options, (o) => o.value).join()) return;
    const options = names.map((value) => make('option', { value, textContent: modes[value].label }));
    this.#select.replaceChildren(...options);
    this.#select.value = this.#mode;
  }

  showLegend() {
    const { land, rivers, pruning } = this.#page;
    const shown = this.#painted?.legend;
    showLegend(byId('legend'), { land, rivers, highest: pruning.highest, by: this.lines, shown });
  }
}

/** Rivers by the orders that the slider leaves, or in the colours of an order; ridges; the river that is asked for. */
export class Lines {
  #page;
  /** The arc whose way to the outlet is marked, or -1. */
  pinned = -1;
  #drawn = { rivers: null, what: '' }; // as they are

  constructor(page) {
    this.#page = page;
    for (const id of ['show-rivers', 'show-ridges']) inputById(id).addEventListener('change', () => this.draw());
  }

  #stylesOf(by, highest) {
    const most = by === 'hack' ? orderColours.length : highest;
    return Array.from({ length: most }, (_, i) => {
      const style = riverStyle(by === 'hack' ? most - i : i + 1, most);
      return by ? { ...style, share: Math.min(i, orderColours.length - 1) } : style;
    });
  }

  draw() {
    const { colouring, data, pruning, rivers, view } = this.#page;
    const { highest, orders } = pruning;
    const { pinned } = this;
    const by = colouring.lines;
    const withRidges = inputById('show-ridges').checked;
    const chosen = by === 'hack' ? orders.map((order, k) => (order > 0 ? rivers.arcs.hack[k] : 0)) : orders;
    const shown = inputById('show-rivers').checked ? chosen : new Int32Array(rivers.count);
    const { width, height } = data.grid;
    const what = [shown.join(), colouring.mode, highest, withRidges, pinned, width, height].join(' ');
    if (rivers === this.#drawn.rivers && what === this.#drawn.what) return;
    this.#drawn = { rivers, what };
    view.showLines({
      orders: shown,
      styles: this.#stylesOf(by, highest),
      ridges: withRidges,
      marked: pinned >= 0 && orders[pinned] > 0 ? rivers.path(pinned).map((k) => rivers.lines[k]) : [],
      byClass: Boolean(by),
      colours: orderColours,
    });
  }
}
