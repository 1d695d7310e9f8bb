// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Pens: a line is drawn, freehand or point by point, and sent. Nothing waits for the program: the line stays where it
// was drawn until the program's own takes its place, or comes back into the hand when it is refused.
import { nameOf } from './desk.js';
import { lengthOf, meeting, upTo } from './drawing.js';
import { apart, near, round, Tool } from './hand.js';
import { dot, ink, red } from './overlay.js';

export class Pen extends Tool {
  line = []; // what is set
  #marks = []; // how many numbers of it there were before each step
  #along = 0; // its length
  #crossings = []; // {i: vertex after it, x, y, along, object}
  #gesture = null; // {px, at, moved, last, off}
  #begin = null; // what it meets at its begin
  #target = null; // what it would meet at its end
  #tip = null; // the place under the pointer, beyond what is set
  #pressed = { px: { x: -99, y: -99 }, time: 0 };
  #refused = false;
  #warned = false;

  /**
   * about: what each tool has, and {kind: of the object, snaps: what its ends meet, closes: true, or 'maybe' where its
   * ends are near, avoids: what it must not cross, what(line, desk): the verb of it, then(desk): it is drawn}.
   */
  constructor(desk, overlay, about) {
    super(desk, overlay, about);
    this.kind = about.kind;
    this.snaps = about.snaps;
    this.closes = about.closes;
    this.avoids = about.avoids;
    this.what = about.what;
    this.then = about.then;
  }

  // ── The line.
  clear() {
    this.line = [];
    this.#marks = [];
    this.#crossings = [];
    this.#along = 0;
    this.#begin = this.#target = this.#tip = this.#gesture = null;
    this.#refused = false;
    this.#warn(null);
    this.desk.onchange();
  }

  /**
   * Whether a line that ends here ends where it began: a coast is closed where its ends are a few cells or a seventh of
   * its length apart.
   */
  get #rounds() {
    const { line } = this;
    if (!this.closes || line.length < 6) return false;
    if (this.#begin?.kind === 'border' && this.#target?.kind === 'border') return false;
    const at = this.#tip ?? { x: line.at(-2), y: line.at(-1) };
    const reach = near * this.desk.scale(at);
    return (
      Math.hypot(at.x - line[0], at.y - line[1]) <
      (this.closes === 'maybe' ? Math.max(reach, 6, 0.15 * this.#along) : reach)
    );
  }

  #snap(at) {
    return this.desk.snap(at, this.snaps, { pixels: near });
  }

  /** What a line meets is kept to the bit. */
  #add({ x: x0, y: y0, kind }) {
    const { line } = this;
    const [x, y] = kind ? [x0, y0] : [round(x0), round(y0)];
    if (line.length) {
      const [ax, ay] = line.slice(-2);
      if (ax === x && ay === y) return;
      const met = this.#met(ax, ay, x, y);
      if (met?.loop < near * this.desk.scale({ x, y })) { // of a hand that trembles
        this.#cutTo(met.from);
        this.#add({ ...met, kind: 'own' });
        this.#add({ x, y, kind: 'own' });
        return;
      }
      if (met) {
        this.#crossings.push({ ...met, i: line.length / 2, along: this.#along + Math.hypot(met.x - ax, met.y - ay) });
      }
      this.#along += Math.hypot(x - ax, y - ay);
    }
    line.push(x, y);
  }

  /** Where a new piece of the line meets what it must not cross. */
  #met(ax, ay, x, y) {
    const reach = 2 * near * this.desk.scale({ x: ax, y: ay });
    const crossed = this.desk.drawing.crossed(
      ax,
      ay,
      x,
      y,
      (object) => object.kind === this.avoids && !(object === this.#begin?.object && this.#along < reach),
    );
    if (crossed) return crossed;
    const { line } = this;
    for (let i = 2; i + 3 < line.length; i += 2) {
      const t = meeting(ax, ay, x, y, line[i - 2], line[i - 1], line[i], line[i + 1]);
      if (t < 0) continue;
      const at = { x: ax + t * (x - ax), y: ay + t * (y - ay) };
      return { object: null, ...at, from: i, loop: lengthOf([at.x, at.y, ...line.slice(i), at.x, at.y]) };
    }
    return null;
  }

  /** The first place where the line, with its tip, crosses what it must not; its ends may run over a river a little. */
  #wrong(tip) {
    const all = [...this.#crossings];
    let total = this.#along;
    if (tip && this.line.length) {
      const [ax, ay] = this.line.slice(-2);
      const met = this.#met(ax, ay, tip.x, tip.y);
      if (met && (!met.object || met.object !== this.#target?.object)) {
        all.push({ ...met, i: this.line.length / 2, along: total + Math.hypot(met.x - ax, met.y - ay) });
      }
      total += Math.hypot(tip.x - ax, tip.y - ay);
    }
    const slack = 1.5 * near * this.desk.scale(tip ?? { x: this.line[0], y: this.line[1] });
    return all.find((one) => !one.object || (one.along > slack && total - one.along > slack)) ?? null;
  }

  #warn(wrong) {
    if (Boolean(wrong) === this.#warned) return;
    this.#warned = Boolean(wrong);
    if (wrong) {
      this.desk.ontell(
        wrong.object
          ? `the ${this.kind} would cross ${nameOf(wrong.object).toLowerCase()} here`
          : `the ${this.kind} would cross itself here`,
        { at: [wrong.x, wrong.y], bad: true },
      );
    } else this.desk.quiet();
  }

  #start(at) {
    this.clear();
    this.#begin = this.#snap(at);
    this.#marks = [0];
    this.#add(this.#begin ?? at);
    this.desk.onchange();
  }

  /** Takes the last step back, of a stroke by hand a piece; false where there is none. */
  back() {
    const { line, desk } = this;
    if (line.length === 0) return false;
    desk.quiet();
    this.#warned = this.#refused = false;
    this.#target = null;
    const to = this.#marks.at(-1);
    const piece = 2 * near * desk.scale({ x: line[0], y: line[1] });
    let length = line.length - 2;
    for (; length > to && lengthOf(line.slice(length - 2)) < piece; length -= 2);
    if (length <= to) this.#marks.pop();
    if (this.#marks.length) this.#cutTo(length);
    else this.clear();
    this.#judge();
    desk.onchange();
    desk.speak(this.line.length ? `${this.line.length / 2} points` : 'nothing drawn');
    return true;
  }

  #cutTo(length) {
    this.line.length = Math.min(length, this.line.length); // of a hand that trembled less may be left
    this.#along = lengthOf(this.line);
    this.#crossings = this.#crossings.filter(({ i }) => i < length / 2);
  }

  #judge() {
    this.#warn(this.line.length ? this.#wrong(this.#target ?? this.#tip) : null);
  }

  // ── The pointer.
  down(at, event) {
    const { desk } = this;
    desk.cursor = null;
    if (!at) return false;
    desk.quiet();
    desk.choose(null);
    const px = desk.pixel(event);
    const end = this.line.length && this.view.place(...this.line.slice(-2));
    if (this.#refused && (!end || apart(px, end) > 1.5 * near)) this.clear();
    this.#refused = false;
    this.#gesture = { px, at, moved: false, last: px, off: false, fresh: this.line.length === 0 };
    return true;
  }

  move(at, event) {
    const g = this.#gesture;
    const px = this.desk.pixel(event);
    if (!g || g.off || (!g.moved && apart(px, g.px) < 4)) return;
    if (!g.moved) {
      g.moved = true;
      if (g.fresh) this.#start(g.at);
      else {
        this.#marks.push(this.line.length);
        this.#add(g.at);
      }
      this.#gesture = g;
    }
    if (!at) {
      const edge = this.desk.edge(g.last, px);
      if (edge) this.#add(edge);
      g.off = true; // a line ends where the grid does
    } else if (apart(px, g.last) >= 3) {
      this.#add(at);
      g.last = px;
    }
    this.#target = this.#snap(at ?? { x: this.line.at(-2), y: this.line.at(-1) });
    this.#tip = null;
    this.#judge();
  }

  up(at, event) {
    const g = this.#gesture;
    this.#gesture = null;
    if (!g) return;
    if (!g.moved) {
      const twice = event.timeStamp - this.#pressed.time < 400 && apart(g.px, this.#pressed.px) < 8;
      this.#pressed = { px: g.px, time: event.timeStamp };
      this.#click(at ?? g.at, twice);
    } else if (g.fresh || this.#target) this.finish();
    else this.#judge();
  }

  /** The gesture ended otherwise: what it drew is taken back. */
  cancel() {
    const g = this.#gesture;
    this.#gesture = null;
    if (!g?.moved) return;
    if (g.fresh) this.clear();
    else this.#cutTo(this.#marks.pop());
  }

  hover(at) {
    this.desk.cursor = null;
    this.point(at);
  }

  /** The pointer or the cursor came to a place. */
  point(at) {
    const before = this.#target;
    this.#tip = at;
    this.#target = at && this.#snap(at);
    if (this.desk.cursor && this.#target && this.#target.object !== before?.object) {
      this.desk.speak(`meets ${this.#target.object ? nameOf(this.#target.object) : 'the border'}`);
    }
    if (this.line.length && !this.#refused) this.#judge();
  }

  #click(at, twice) {
    const { line, desk } = this;
    const pixels = (x, y) => {
      const [p, q] = [this.view.place(at.x, at.y), this.view.place(x, y)];
      return p && q ? apart(p, q) : Infinity;
    };
    if (line.length === 0) {
      this.#start(at);
      this.#tip = at;
      desk.speak(`begun${this.#begin ? ` at ${this.#begin.object ? nameOf(this.#begin.object) : 'the border'}` : ''}`);
      return;
    }
    const last = pixels(...line.slice(-2));
    if ((twice && last < 8) || last < 1) {
      this.finish();
      return;
    }
    if (this.closes && line.length >= 6 && pixels(line[0], line[1]) < near) {
      if (this.closes === 'maybe') line.push(line[0], line[1]);
      this.finish();
      return;
    }
    this.#target = this.#snap(at);
    this.#marks.push(line.length);
    this.#add(this.#target ?? at);
    desk.speak(`point ${line.length / 2}`);
    if (this.#target && this.#along > 2 * near * desk.scale(at)) this.finish();
    else this.#judge();
  }

  // ── Keys.
  press(at, key) {
    const [x, y] = this.line.slice(-2);
    if (
      this.#refused ||
      (key === 'Enter' && this.line.length && Math.hypot(x - at.x, y - at.y) < 2 * this.desk.scale(at))
    ) {
      this.finish();
    } else this.#click(at, false);
  }

  key(event) {
    if (event.key === 'Backspace' && this.line.length) return this.back();
    if (event.key === 'Escape' && this.line.length && !this.#gesture) {
      this.clear();
      this.desk.quiet();
      this.desk.speak('the line is dropped');
      return true;
    }
    if (event.key === 'Enter' && this.line.length && !this.desk.cursor && event.target === this.view.canvas) {
      this.finish();
      return true;
    }
    return this.steps(event);
  }

  // ── The end.
  /** The line as it is sent: its ends carried to what they meet, or cut where they ran over it. */
  #trimmed() {
    let { line } = this;
    const slack = 1.5 * near * this.desk.scale({ x: line[0], y: line[1] });
    const last = this.#crossings.at(-1);
    const cut = last?.object && this.#along - last.along <= slack && last.along > slack;
    if (cut) line = upTo(line, last.i, last);
    else if (this.#target) line = [...line, this.#target.x, this.#target.y];
    const first = this.#crossings[0];
    if (first?.object && !(cut && first === last) && !this.#begin && first.along <= slack) {
      line = [first.x, first.y, ...line.slice(2 * first.i)];
    }
    return line;
  }

  finish() {
    const { desk } = this;
    // What is shown closed is sent closed.
    const rounds = this.closes === 'maybe' && !this.#begin && this.#rounds;
    const line = rounds ? [...this.line, this.line[0], this.line[1]] : this.#trimmed();
    if (line.length < (this.closes === true ? 6 : 4) || lengthOf(line) < 4 * desk.scale({ x: line[0], y: line[1] })) {
      desk.speak(this.closes === true ? 'an area needs three points' : 'a line needs two points');
      return;
    }
    const closed = this.closes === true;
    const ghost = { line, closed, kind: this.kind, pen: this };
    this.clear();
    desk.speak('sent');
    const reply = desk.send(this.what(line, desk), ghost);
    if (this.then) reply.then((there) => there && this.then(desk));
  }

  /** A line that the program refused is in the hand again, if that is empty. */
  resume({ line }) {
    if (this.line.length || this.#gesture) return;
    const { desk } = this;
    this.line = [...line];
    this.#marks = [0];
    this.#along = lengthOf(line);
    this.#begin = this.#snap({ x: line[0], y: line[1] });
    this.#tip = this.#target = null;
    this.#refused = true;
    desk.onchange();
  }

  draw(pen, place) {
    const { line, overlay } = this;
    if (line.length) {
      const tip = this.#gesture ? null : this.#target ?? this.#tip;
      const whole = tip && !this.#refused ? [...line, tip.x, tip.y] : line;
      const wrong = this.#refused ? { i: 1, x: line[0], y: line[1] } : this.#wrong(tip);
      overlay.stroke(pen, place, whole, {
        colour: ink[this.kind],
        wrong,
        arrows: this.kind === 'river',
        turned: this.#turned(),
      });
      if (whole.length >= 6 && (this.closes === true || this.#rounds)) {
        overlay.stroke(pen, place, [...whole.slice(-2), line[0], line[1]], {
          colour: ink[this.kind],
          width: 1,
          dashed: true,
        });
      }
      for (const k of this.#marks) {
        const p = place(line[k], line[k + 1]);
        if (p) dot(pen, p, 3.4, { stroke: this.#refused ? red : ink[this.kind] });
      }
    }
    overlay.ring(pen, place, this.#begin);
    overlay.ring(pen, place, this.#rounds ? { x: line[0], y: line[1] } : this.#target);
    super.draw(pen, place);
  }

  /** Whether the line runs towards its begin: it meets more there than at its end. */
  #turned() {
    const rank = (met) => (!met ? 0 : met.kind === 'river' ? 2 : 1);
    return rank(this.#begin) > rank(this.#target);
  }
}
