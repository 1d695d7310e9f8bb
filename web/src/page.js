// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A view of a terrain and its rivers, its controls and its panel. What is shown can be replaced while the page lives.
import { Colouring, Lines } from './colouring.js';
import { byId, inputById, tellAll } from './elements.js';
import { slopes } from './light.js';
import { Lighting } from './lighting.js';
import { Measuring } from './measure.js';
import { fillPanel, summary } from './panel.js';
import { Pointer } from './pointer.js';
import { Pruning } from './pruning.js';
import { ArcFinder } from './rivers.js';
import { Tools } from './tools.js';
import { coveredParts, makeView, namesOf } from './view.js';
import { addWays } from './ways.js';

/** What a page tells about itself to whoever asks. */
function tellState(page) {
  const { measure, pointer, pruning, state, view } = page;
  Object.assign(state, {
    mode: view.mode,
    pick: (px, py) => pointer.pick(px, py),
    /** The heights of the page [m], row-major, NaN where there are none. */
    heights: () => Float32Array.from(page.land.z, (z, i) => (page.land.has && !page.land.has[i] ? NaN : z)),
    /** Strahler orders of the arcs as pruned now, 0 for those that are gone. */
    orders: () => Array.from(pruning.orders),
    /** What is written over the view: {text, kind, x0, y0, x1, y1} [pixels]. */
    labels: () => view.labels.boxes,
    /** The contours drawn now: {step, index: of the labelled ones} [m], 0: none. */
    contours: () => view.drawn ?? { step: view.contour, index: 5 * view.contour },
    /** A place [cells] on the view [pixels], or null. */
    project: (x, y) => view.project(x, y),
    /** What is measured now, or null (docs/report_page.md). */
    measured: () => measure.result,
    /** When the view rests. */
    still: () => view.still?.(),
    ready: true,
  });
}

/** A scene is {data: the page's JSON, land, rivers, water}. */
export class Page {
  /** Finds the arc near a place. */
  finder;
  /**
   * The panel, which follows the pointer on the land.
   * @type {{hover: (x: number | null, y: number | null, arc: number) => void}}
   */
  panel = { hover() {} };
  #names = []; // of summits and outlets

  /** state: what the page tells about itself to whoever asks; keys: further ones for the list of keys. */
  constructor(scene, state, keys = []) {
    this.scene = scene;
    this.state = state;
    const { data, land, rivers, water } = scene;
    this.view = makeView(land, rivers, { lakes: water.lakes, sea: data.sea });
    document.documentElement.dataset.mode = this.view.mode;
    this.lighting = new Lighting(this.view);
    this.pruning = new Pruning(this);
    this.colouring = new Colouring(this);
    this.lines = new Lines(this);
    this.pointer = new Pointer(this);
    inputById('show-labels').addEventListener('change', () => {
      this.#showNames();
      this.view.redraw();
    });
    const { followTheme } = addWays(this, keys);
    this.view.ondraw = (turn) => (byId('north').style.transform = `rotate(${turn}rad)`);
    this.tools = new Tools(this.view);
    this.measure = new Measuring(this);
    this.view.keepOut = coveredParts;
    this.view.onlost = () =>
      tellAll('The graphics device was lost; the view returns when the browser gives it back.');
    this.view.onfound = () => tellAll('');

    this.#fill(true);
    this.#fillPanel();
    followTheme();
    this.lighting.look();
    this.colouring.paint();
    this.pruning.apply();
    this.view.home();
    new ResizeObserver(() => this.view.resize()).observe(byId('view'));
    tellState(this);
  }

  get data() {
    return this.scene.data;
  }

  get land() {
    return this.scene.land;
  }

  get rivers() {
    return this.scene.rivers;
  }

  get water() {
    return this.scene.water;
  }

  /** Slopes of the land to the east and to the south; the view in 3-D has them already. */
  get slope() {
    return this.view.ground?.slope ?? slopes(this.land);
  }

  /** What depends on the rivers that are kept. */
  showRivers() {
    this.lines.draw();
    this.colouring.showLegend();
    this.measure.changed();
  }

  #showNames() {
    this.view.names = inputById('show-labels').checked ? this.#names : [];
  }

  /** Everything on the page that depends on what is shown. afresh: not as it was for the land before. */
  #fill(afresh) {
    const { data, land, rivers } = this;
    this.finder = new ArcFinder(rivers, data.grid);
    this.#names = namesOf(this);
    this.lines.pinned = -1;
    document.title = data.title;
    byId('title').textContent = data.title;
    byId('summary').textContent = summary(data, rivers);
    byId('foot').textContent = `thalweg ${data.version}` + (data.recipe ? `, seed ${data.seed}` : '');
    this.lighting.fit(land, data.contour_m, afresh);
    this.#showNames();
    inputById('show-rivers').parentElement.hidden = rivers.count === 0;
    byId('label-ridges').hidden = rivers.ridges.length === 0;
    this.colouring.offer();
    this.state.water = this.water;
    this.pruning.fit();
  }

  #fillPanel() {
    const [verdict, ledger, sections] = ['verdict', 'ledger', 'sections'].map(byId);
    for (const part of [verdict, ledger, sections]) part.replaceChildren();
    const { view } = this;
    const mark = (places) => {
      view.marks = places;
      view.redraw();
    };
    this.panel = fillPanel({ verdict, ledger, sections }, this.data, {
      flyTo: (x, y) => view.fly(x, y),
      point: (x, y) => mark([[x, y]]),
      unpoint: () => mark([]),
    });
  }

  /** Only what is written of the scene has changed. */
  #rewrite() {
    const written = JSON.stringify(this.#names);
    this.#fill(false);
    this.#fillPanel();
    if (JSON.stringify(this.#names) !== written) this.view.redraw();
  }

  /**
   * Shows another scene from where the view stands; heights, contours, colours and light stay as they are chosen.
   * report: whether to write the panel anew; home: land that comes or goes is looked at afresh.
   */
  replace(next, { report = true, home = true } = {}) {
    const before = this.scene;
    this.scene = next;
    const { data, land, rivers, water } = next;
    if (report && land === before.land && rivers === before.rivers && water === before.water) {
      this.#rewrite();
      return;
    }
    const sameFrame = ['width', 'height', 'cell_m'].every((key) => before.data.grid[key] === data.grid[key]);
    const afresh = before.land.level !== land.level || !sameFrame;
    this.view.marks = [];
    this.view.replace(land, rivers, { lakes: water.lakes, sea: data.sea });
    this.#fill(afresh);
    if (report) this.#fillPanel();
    this.colouring.paint();
    this.lighting.look();
    this.pruning.apply();
    if (afresh && (home || !sameFrame)) this.view.home();
  }

  /** Binds the pruning length to a recipe: {least, changing(value), changed(value)}; null: to the page alone. */
  bindLength(recipe, value) {
    this.pruning.bind(recipe, value);
    this.#fill(false);
    this.pruning.apply();
  }
}
