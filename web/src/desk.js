// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the drawing tools share: the drawing, what of it is chosen, what was sent and not answered yet, and how far
// things lie from the pointer on the screen.
import { number } from './chart.js';
import { Drawing, lengthOf } from './drawing.js';
import { foot } from './rivers.js';

export const nameOf = ({ kind, n }) => `${kind[0].toUpperCase()}${kind.slice(1)} ${n + 1}`;
const patience = 20000; // [ms] for rivers that are being made

export class Desk {
  drawing = null;
  chosen = null; // object
  vertex = -1; // of what is chosen
  hovered = null; // {object, …} under the pointer
  ghosts = []; // {line, closed, kind, hides: objects, state: 'sent' | 'refused'} of what was sent
  cursor = null; // of the keyboard: {x, y}
  heading = 0; // of the view [rad]
  tool = null; // of the drawing ones, in the hand
  type = ''; // of rivers to be drawn
  lambda = 0;
  level = null; // of lakes to be drawn
  onchange = () => {}; // of what stands beside the view too
  onask = () => {}; // the field of what is chosen is to be filled in
  onrefused = (_ghost) => {};
  /** @type {(text: string, about: {at?: number[] | null, bad?: boolean}) => void} */
  ontell = () => {};
  quiet = () => {}; // what was told is gone
  /** @type {(text: string) => void} to who does not see */
  speak = () => {};
  #queue = [];
  #runs = false;
  /** @type {(value?: any) => void} */
  #arrived = () => {};

  /**
   * view: of page.js; ask(question): a promise of the reply; revision(): of the document now; bends(): whether rivers
   * meander about the lines that are drawn.
   */
  constructor(view, { ask, revision, bends }) {
    this.view = view;
    this.ask = ask;
    this.revision = revision;
    this.bends = bends;
  }

  /** Whether the drawing is of the document as it is now: rivers of a generator come with their land. */
  get fresh() {
    return (this.drawing?.revision ?? -1) >= this.revision();
  }

  get waits() {
    return this.#runs;
  }

  /** The drawing lies on the land that is shown. */
  get lies() {
    const { grid } = this.view.land;
    return this.drawing !== null && ['width', 'height', 'cell_m'].every((key) => grid[key] === this.drawing.grid[key]);
  }

  /** It is the document's too. */
  get fits() {
    return this.fresh && this.lies;
  }

  take(message) {
    this.drawing = new Drawing(message);
    const { chosen } = this;
    this.chosen = chosen && this.drawing.same(chosen, true);
    if (this.chosen?.line.length !== chosen?.line.length) this.vertex = -1;
    this.hovered = null;
    this.#arrived();
    this.onchange();
  }

  /** What is chosen, where it is of a kind, or null. */
  chosenOf(kind) {
    return this.chosen?.kind === kind ? this.chosen : null;
  }

  choose(object, vertex_ = -1) {
    const vertex = object?.kind === 'pin' ? -1 : vertex_; // it is one place
    if (object === this.chosen && vertex === this.vertex) return;
    Object.assign(this, { chosen: object, vertex });
    this.onchange();
  }

  /**
   * Sends what was drawn, after all that was sent before; objects it speaks of are found again in the drawing as it is
   * by then. what: an object, or a function (same: finds an object again) that gives one. ghost: what is shown until it
   * is there.
   */
  send(what, ghost = null) {
    return new Promise((resolve) => {
      if (ghost) this.ghosts.push(Object.assign(ghost, { state: 'sent' }));
      this.#queue.push({ what, ghost, resolve });
      if (!this.#runs) this.#work();
      this.onchange();
    });
  }

  async #work() {
    this.#runs = true;
    while (this.#queue.length) {
      await this.#freshness();
      const next = this.#queue.shift(); // unless it was taken back meanwhile
      if (next) next.resolve(await this.#one(next));
    }
    this.#runs = false;
    this.onchange();
  }

  /** Takes back what was drawn last if the program has not got it yet; false: there is none. */
  recall() {
    const last = this.#queue.pop();
    if (!last) return false;
    this.#restore(last.ghost);
    this.#forget(last.ghost);
    last.resolve(null);
    return true;
  }

  /** What was to be changed is chosen again as it is. */
  #restore(ghost) {
    if (ghost?.hides?.length !== 1 || this.tool?.id !== 'select') return;
    const was = this.drawing.same(ghost.hides[0]);
    if (was) this.choose(was);
  }

  /** Gives the reply, or null where it was refused. */
  async #one({ what, ghost }) {
    try {
      const { drawing } = this;
      const same = (object) => {
        const now = drawing.same(object);
        if (!now) throw new Error('it has changed meanwhile: try again');
        return now;
      };
      const reply = await this.ask({
        do: 'draw',
        revision: drawing.revision,
        what: typeof what === 'function' ? what(same) : what,
      });
      await this.#freshness();
      this.#forget(ghost);
      if (reply.said?.length) this.ontell(reply.said.join('; '), {});
      return reply;
    } catch (error) {
      if (ghost) ghost.state = 'refused';
      this.#restore(ghost);
      setTimeout(() => this.#forget(ghost), 900);
      this.ontell(error.message.replace(/^studio\.\w+: /, ''), { at: error.at, bad: true });
      this.onrefused(ghost);
      return null;
    }
  }

  /** When the drawing is of the document as it is now, or does not become so. */
  async #freshness() {
    const end = Date.now() + patience;
    while (!this.fresh && Date.now() < end) {
      await new Promise((done) => {
        this.#arrived = done;
        setTimeout(done, 250); // the document may have changed back
      });
    }
  }

  #forget(ghost) {
    this.ghosts = this.ghosts.filter((one) => one !== ghost);
    this.onchange();
  }

  hold(tool) {
    this.tool = tool;
    this.onchange();
  }

  // ── What is chosen.
  describe(object) {
    const { drawing } = this;
    const facts = [nameOf(object)];
    if (object.kind === 'pin') return `${facts[0]}, ${object.height} m`;
    const length = lengthOf(object.outline) * drawing.grid.cell_m;
    facts.push(length >= 1000 ? `${number(length / 1000, 3)} km` : `${number(length, 3)} m`);
    if (object.kind === 'lake') facts.push(object.level === null ? 'level by the terrain' : `level ${object.level} m`);
    if (object.kind === 'river') facts.push(this.#end(object));
    if (object.kind === 'ridge') facts.push(this.#crest(object));
    return facts.join(', ');
  }

  #crest({ from, to }) {
    if (from === null && to === null) return 'heights by the terrain';
    return (from ?? to) === (to ?? from) ? `level ${from ?? to} m` : `${from} m to ${to} m`;
  }

  #end(river) {
    const below = this.drawing.downstream[river.n] ?? -1;
    if (below >= 0) return `joins river ${below + 1}`;
    const [x, y] = river.line.slice(-2);
    const { width, height, cell_m } = this.drawing.grid;
    const close = 1e-6 * cell_m + 1;
    if (Math.min(x, y, width - x, height - y) < close) return 'leaves at the border';
    return this.drawing.nearest({ x, y }, close, ({ kind }) => kind === 'coast')
      ? 'ends at the coast'
      : 'ends on the land';
  }

  /** Takes away the chosen vertex, else all that is chosen; alone: a river without those that drain into it. */
  remove(alone = false) {
    const { chosen, vertex } = this;
    if (!chosen) return;
    const { kind, closed } = chosen;
    if (vertex >= 0 && kind !== 'pin') {
      const line = [...chosen.line.slice(0, 2 * vertex), ...chosen.line.slice(2 * vertex + 2)];
      this.send((same) => ({ verb: 'remove', of: { [kind]: same(chosen).n }, vertex }), {
        kind,
        closed,
        line,
        hides: [chosen],
      });
      this.chosen = this.drawing.like(chosen, line);
      this.vertex = -1;
      return;
    }
    const hides = kind === 'river' && !alone ? this.drawing.above(chosen) : [chosen];
    this.send((same) => ({ verb: 'erase', [kind]: same(chosen).n, ...(kind === 'river' ? { alone } : {}) }), {
      kind,
      line: [],
      hides,
    });
    this.choose(null);
    this.speak(`${nameOf(chosen)} is erased`);
  }

  // ── On the screen.
  pixel(event) {
    const frame = this.view.canvas.getBoundingClientRect();
    return { x: event.clientX - frame.left, y: event.clientY - frame.top };
  }

  /** Cells that a pixel covers about a place. */
  scale({ x, y }) {
    const h = 4 * this.view.cellsPerPixel;
    const [w, e, n, s] = [[x - h, y], [x + h, y], [x, y - h], [x, y + h]].map((p) => this.view.place(...p));
    if (!w || !e || !n || !s) return this.view.cellsPerPixel;
    return (4 * h) / (Math.hypot(e.x - w.x, e.y - w.y) + Math.hypot(s.x - n.x, s.y - n.y) || 1);
  }

  /** Where the grid ends between a pixel on the land and one beside it. */
  edge(on, off) {
    let at = null;
    let [a, b] = [on, off];
    for (let k = 0; k < 12; ++k) {
      const middle = { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 };
      const under = this.view.under(middle.x, middle.y);
      if (under) [a, at] = [middle, under];
      else b = middle;
    }
    return at;
  }

  /**
   * What a line that ends here would meet within so many pixels: {kind: 'river' | 'coast' | 'border', object, x, y}, or
   * null.
   */
  snap(at, kinds, { pixels = 12, except = null } = {}) {
    const reach = pixels * this.scale(at);
    for (const kind of ['river', 'coast']) {
      if (!kinds.includes(kind)) continue;
      const found = this.drawing.nearest(at, reach, (object) => object.kind === kind && object !== except);
      if (!found) continue;
      const { line } = found.object;
      // An end of a river draws more than what lies between.
      const end =
        kind === 'river' &&
        [[line[0], line[1]], line.slice(-2)].find(([x, y]) => Math.hypot(x - at.x, y - at.y) < reach);
      return end ? { kind, object: found.object, x: end[0], y: end[1], end: true } : { kind, ...found };
    }
    if (!kinds.includes('border')) return null;
    const { width, height } = this.drawing.grid;
    const sides = [[0, 0, width, 0], [width, 0, width, height], [width, height, 0, height], [0, height, 0, 0]].map(
      (side) => foot(at.x, at.y, ...side),
    );
    const side = sides.reduce((least, one) => (one.d < least.d ? one : least));
    return side.d < reach ? { kind: 'border', object: null, x: side.x, y: side.y } : null;
  }

  // ── The keyboard's cursor.
  /** Moves it over the land by so many pixels to the right and up. */
  step(right, up) {
    const { width, height } = this.drawing.grid;
    const by = this.view.cellsPerPixel;
    const { x, y } = this.cursor ?? this.#middle();
    const [c, s] = [Math.cos(this.heading), Math.sin(this.heading)];
    const hold = (v, most) => Math.min(Math.max(v, 0), most);
    this.cursor = { x: hold(x + by * (right * c - up * s), width), y: hold(y - by * (right * s + up * c), height) };
    const seen = this.view.place(this.cursor.x, this.cursor.y);
    const { clientWidth, clientHeight } = this.view.parent;
    if (!seen || seen.x < 20 || seen.y < 20 || seen.x > clientWidth - 20 || seen.y > clientHeight - 20) {
      this.view.move({ right: Math.sign(right) * 0.1, up: Math.sign(up) * 0.1 });
    }
    return this.cursor;
  }

  #middle() {
    const { clientWidth, clientHeight } = this.view.parent;
    return (
      this.view.under(clientWidth / 2, clientHeight / 2) ?? {
        x: this.drawing.grid.width / 2,
        y: this.drawing.grid.height / 2,
      }
    );
  }
}
