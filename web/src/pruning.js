// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The slider of the pruning length, and the orders of the rivers that it leaves.
import { number } from './chart.js';
import { byId, inputById } from './elements.js';

export class Pruning {
  /** Strahler orders by arc, 0 for those that are gone. */
  orders = new Int32Array(0);
  highest = 0;
  #page;
  #recipe = null; // what the length is bound to in the studio: {least, changing(value), changed(value)}
  #slider = inputById('L');

  constructor(page) {
    this.#page = page;
    this.#slider.addEventListener('input', () => {
      this.apply();
      this.#recipe?.changing(this.#slider.value);
    });
    this.#slider.addEventListener('change', () => this.#recipe?.changed(this.#slider.value));
  }

  /** Length below which streams go [cells]; at the left end of a report's slider it is the one of its rivers. */
  get #length() {
    const { value, min } = this.#slider;
    return Number(value) <= Number(min) && !this.#recipe ? this.#page.data.rivers.prune : Number(value);
  }

  /** Keeps the rivers that the slider says, here and in all that shows them. */
  apply() {
    const { data, rivers, state } = this.#page;
    const length = this.#length;
    const { kept, orders } = rivers.kept(length);
    this.orders = orders;
    this.highest = Math.max(0, ...orders);
    state.kept = kept;
    const metres = length * data.grid.cell_m;
    const far = metres >= 2000 ? `${number(metres / 1000, 3)} km` : `${number(metres, 3)} m`;
    const text = `${number(length)} cells (${far})`;
    byId('Lout').textContent = text;
    this.#slider.setAttribute('aria-valuetext', text);
    byId('kept').textContent = `${number(kept)} of ${number(rivers.count)} links kept, to order ${this.highest}`;
    this.#page.showRivers();
  }

  /** recipe: {least, changing(value), changed(value)}, or null: the length is the page's alone. */
  bind(recipe, value) {
    this.#recipe = recipe;
    if (value !== undefined) this.#slider.value = String(value);
  }

  /** Fits the slider to other rivers. */
  fit() {
    const { data, rivers } = this.#page;
    const recipe = this.#recipe;
    byId('field-L').hidden = rivers.count === 0 && !recipe;
    // Beyond 160 cells there is always room on the slider; past the longest stream nothing changes any more.
    const least = recipe ? recipe.least : Math.floor(data.rivers.prune);
    const chosen = recipe ? Number(this.#slider.value) : 0;
    const most = Math.max(least + 1, 160, Math.ceil(rivers.longest) + 1, chosen);
    Object.assign(this.#slider, { min: least, max: most, disabled: rivers.count === 0 && !recipe });
    if (!recipe) this.#slider.value = String(least);
  }
}
