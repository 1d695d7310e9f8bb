// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the studio shows, put together from what the program sends: rivers, heights, scenes; and what was there before.
import { byId } from './elements.js';
import { Land } from './land.js';
import { noData } from './no_data.js';
import { Rivers } from './rivers.js';
import { Water } from './water.js';

const patience = 300; // [ms] for the land of rivers, which mostly comes before

const sameGrid = (a, b) => ['width', 'height', 'cell_m', 'west', 'north'].every((key) => a[key] === b[key]);

/** Level ground, over which water has no ways. */
function levelGround(grid) {
  const land = new Land(grid, null);
  return { land, water: new Water(land, '', false) };
}

/** Says on the page whether what is written there is of another land than the one that is shown. */
function setStale(isStale) {
  document.documentElement.dataset.stale = isStale ? 'on' : 'off';
  for (const id of ['verdict', 'ledger', 'sections']) byId(id).setAttribute('aria-busy', String(isStale));
}

export class Scenes {
  /** The scene that belongs to the last land. */
  now = null;
  /** The scene before the last edit. */
  before = null;
  /** Whether that one is shown. */
  isHeld = false;
  #studio;
  #pending = null; // rivers whose land is yet to come: {data, rivers, job}
  #alone; // after which they are shown without
  #made = null; // of the last scene: {job, lines, land, text, rivers, water}

  /** studio: of studio.js */
  constructor(studio) {
    this.#studio = studio;
  }

  /** What is shown becomes what was before. */
  keep() {
    if (this.now && this.#studio.page) this.before = this.now;
    this.#studio.compare.disabled = !this.before;
  }

  #dataOf(grid, known) {
    const { about, document: recipe } = this.#studio;
    const seed = Number(recipe.values.seed) || 0;
    return { ...noData, version: about.version, title: document.title, seed, grid, heights: null, ...known };
  }

  /** options: of Page.replace */
  #show(scene, options) {
    this.now = scene;
    const { page, sheet } = this.#studio;
    if (!page) {
      this.#studio.open(scene);
      return;
    }
    if (!this.isHeld) page.replace(scene, { home: !page.tools.held, ...options });
    sheet?.follow();
  }

  /** Whether the land that is shown is one of this grid. */
  #hasLand(grid) {
    return this.now && !this.now.land.level && sameGrid(this.now.data.grid, grid);
  }

  /** Whether level ground without rivers is shown, and nothing else is to come. */
  isFlat(grid) {
    const { now } = this;
    return now?.land.level && now.rivers.count === 0 && !this.#pending && sameGrid(now.data.grid, grid);
  }

  /** An empty sheet: level ground. */
  flatten(grid) {
    this.#pending = null;
    clearTimeout(this.#alone);
    this.#studio.state.level = null;
    const { command, recipe } = this.#studio.document;
    const data = this.#dataOf(grid, { command, recipe });
    this.#show({ data, ...levelGround(grid), rivers: new Rivers(noData.rivers, null, '') });
    setStale(false);
  }

  #rivers({ data, lines, job }) {
    const next = { data, job, rivers: new Rivers(data.rivers, data.ridges, lines) };
    this.#pending = next;
    clearTimeout(this.#alone);
    const show = () => this.#pending === next && this.#riversAlone(next);
    if (this.now) this.#alone = setTimeout(show, patience);
    else show();
  }

  /** Rivers on the land before, or on level ground. */
  #riversAlone({ data, rivers }) {
    const { now } = this;
    if (now && !sameGrid(now.data.grid, data.grid)) return; // they wait for their land
    if (now) {
      const mixed = { ...now.data, rivers: data.rivers, ridges: data.ridges };
      this.#show({ ...now, rivers, data: mixed }, { report: false });
    } else this.#show({ data: this.#dataOf(data.grid, data), ...levelGround(data.grid), rivers });
    setStale(true);
  }

  /** Heights have come, coarse ones or all; their water and what is measured are yet to come. */
  heights(header, values) {
    if (this.#studio.isEmpty) return;
    const { grid, width, height, cells, min, max, nodata, sea, level, job } = header;
    const heights = { width, height, cells, min, max, nodata };
    const land = new Land(grid, heights, values, sea);
    const known = [this.#pending, this.now].find((scene) => scene && sameGrid(scene.data.grid, grid));
    if (level === 'coarse' && this.#hasLand(grid)) {
      land.draft = true;
      land.steepest = this.now.land.steepness();
    }
    const contour_m = known?.data.contour_m || Number(((max - min) / 40).toPrecision(1)) || 1;
    const data = { ...this.#dataOf(grid, known?.data), heights, sea, lakes: false, summits: [], contour_m };
    const rivers = known?.rivers ?? new Rivers(noData.rivers, null, '');
    this.#show({ data, land, rivers, water: new Water(land, '', false) }, { report: false });
    this.#studio.state.level = level;
    setStale(true);
    this.#studio.questions.shown(level, job);
  }

  /** The land of a scene: the one that is shown, where its heights have come already. */
  #landOf({ grid, heights, sea }) {
    const { link, state } = this.#studio;
    const isShown = this.now && sameGrid(this.now.data.grid, grid);
    if (!heights) return isShown && this.now.land.level ? this.now.land : new Land(grid, null);
    return state.level === 'full' && this.#hasLand(grid) ? this.now.land : new Land(grid, heights, link.heights, sea);
  }

  /** A scene has come: its rivers, then its water, then what is measured of it. */
  scene(message) {
    if (this.#studio.isEmpty) return;
    const { data, lines, water: text, level, job } = message;
    if (level === 'rivers') {
      this.#rivers(message);
      return;
    }
    this.#pending = null;
    const land = this.#landOf(data);
    const made = this.#made;
    const isSame = made && made.job === job && made.lines === lines && made.land === land && made.text === text;
    const rivers = isSame ? made.rivers : new Rivers(data.rivers, data.ridges, lines);
    const water = isSame ? made.water : new Water(land, text, data.lakes);
    this.#made = { job, lines, land, text, rivers, water };
    const isMeasured = level === 'measured';
    const whole = isMeasured ? data : this.#dataOf(data.grid, data);
    this.#show({ data: whole, land, rivers, water }, { report: isMeasured });
    setStale(!isMeasured);
  }

  /** Shows what was before the last edit, as long as it is held. */
  hold(isHeld) {
    const { compare, page, side } = this.#studio;
    if (isHeld === this.isHeld || (isHeld && (!this.before || !page))) return;
    this.isHeld = isHeld;
    compare.setAttribute('aria-pressed', String(isHeld));
    document.documentElement.dataset.before = isHeld ? 'on' : 'off';
    page.replace(isHeld ? this.before : this.now, { report: false });
    if (isHeld) side.bindFixedLength(this.before.data.rivers.prune);
    else side.showFirst();
  }
}
