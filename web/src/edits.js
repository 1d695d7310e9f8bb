// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Tools that change what is drawn: it is chosen, its vertices are moved, rivers are cut and joined.
import { nameOf } from './desk.js';
import { bent, inside } from './drawing.js';
import { apart, near, round, Tool } from './hand.js';
import { dot, ink, orange, peg, red } from './overlay.js';

/** Where a click or the keyboard chooses a place, and no line is drawn. */
class Pointing extends Tool {
  #px = null;

  down(at, event) {
    this.desk.cursor = null;
    if (!at) return false;
    this.desk.quiet();
    this.#px = this.desk.pixel(event);
    this.point(at);
    this.pressed(at);
    return true;
  }

  /** A gesture begins at a place. */
  pressed(_at) {}

  /** It ends there. moved: it went somewhere. */
  released(_at, _moved) {}

  move(at) {
    this.point(at);
  }

  up(at, event) {
    if (at) this.released(at, apart(this.#px, this.desk.pixel(event)) > 6);
  }

  hover(at) {
    this.desk.cursor = null;
    this.point(at);
  }
}

export class Cut extends Pointing {
  #at = null; // {object, x, y}

  point(at) {
    const { desk } = this;
    this.#at = at && desk.drawing.nearest(at, 1.5 * near * desk.scale(at), ({ kind }) => kind === 'river');
    desk.hovered = this.#at;
  }

  released() {
    const { desk } = this;
    if (!this.#at) return;
    const { object, x, y } = this.#at;
    desk.send((same) => ({ verb: 'cut', river: same(object).n, at: [round(x), round(y)] }));
    this.#at = desk.hovered = null;
  }

  press() {
    this.released();
  }

  draw(pen, place) {
    const p = this.#at && place(this.#at.x, this.#at.y);
    if (p) {
      dot(pen, p, 7, { fill: '#fff', stroke: red });
      pen.beginPath();
      for (const [a, b] of [[-1, -1], [1, -1]]) {
        pen.moveTo(p.x + 3 * a, p.y + 3 * b);
        pen.lineTo(p.x - 3 * a, p.y - 3 * b);
      }
      pen.stroke();
    }
    super.draw(pen, place);
  }
}

export class Join extends Pointing {
  #end = null; // {object, end, x, y} under the pointer, or taken
  #taken = false;
  #fresh = false; // taken by the press that goes on
  #target = null;

  clear() {
    this.#end = this.#target = null;
    this.#taken = false;
  }

  #nearestEnd(at) {
    const { desk } = this;
    const reach = 2 * near * desk.scale(at);
    const found = desk.drawing.nearest(at, reach, ({ kind }) => kind === 'river');
    const rivers = found ? [found.object, ...desk.drawing.rivers] : [];
    let best = null;
    for (const object of rivers) {
      for (const [end, x, y] of [['source', object.line[0], object.line[1]], ['outlet', ...object.line.slice(-2)]]) {
        const d = Math.hypot(x - at.x, y - at.y);
        if (d < Math.min(reach, best?.d ?? Infinity)) best = { object, end, x, y, d };
      }
    }
    return best;
  }

  point(at) {
    const { desk } = this;
    if (!this.#taken) this.#end = at && this.#nearestEnd(at);
    else this.#target = at && desk.snap(at, ['river'], { pixels: 2 * near, except: this.#end.object });
    desk.hovered = this.#end;
    this.tip = at;
  }

  pressed() {
    this.#fresh = !this.#taken && this.#end !== null;
    if (this.#fresh) this.#take();
  }

  #take() {
    this.#taken = true;
    this.desk.speak(`${this.#end.end} of ${nameOf(this.#end.object).toLowerCase()}: now the river that it joins`);
  }

  released(at, dragged) {
    if (!this.#taken || (this.#fresh && !dragged)) return;
    if (this.#target) {
      const { object, end } = this.#end;
      const { x, y } = this.#target;
      this.desk.send((same) => ({ verb: 'join', river: same(object).n, end, at: [x, y] }),
        { kind: 'river', line: [this.#end.x, this.#end.y, x, y] });
    } else this.desk.ontell('there is no river to join', { at: [at.x, at.y], bad: true });
    this.clear();
  }

  press(at) {
    if (this.#taken) this.released(at, true);
    else if (this.#end) this.#take();
  }

  key(event) {
    if (event.key !== 'Escape' || !this.#taken) return this.steps(event);
    this.clear();
    return true;
  }

  cancel() {
    this.clear();
  }

  draw(pen, place) {
    const { overlay } = this;
    if (this.#taken && this.tip) {
      overlay.stroke(
        pen,
        place,
        [this.#end.x, this.#end.y, (this.#target ?? this.tip).x, (this.#target ?? this.tip).y],
        { colour: orange },
      );
    }
    overlay.ring(pen, place, this.#end);
    overlay.ring(pen, place, this.#target);
    super.draw(pen, place);
  }
}

/** Sets pins: each has the terrain's height at first, and its field is ready for another one. */
export class Pin extends Pointing {
  #at = null;

  clear() {
    this.#at = null;
  }

  #near(at) {
    return this.desk.drawing.nearest(at, near * this.desk.scale(at), ({ kind }) => kind === 'pin');
  }

  point(at) {
    this.desk.hovered = at && this.#near(at);
    this.#at = this.desk.hovered ? null : at;
  }

  released(at) {
    const { desk, view } = this;
    const there = this.#near(at);
    if (there) {
      this.#take(there.object);
      return;
    }
    const [x, y] = [round(at.x), round(at.y)];
    const height = Math.round(view.land.heightAt(x, y));
    this.#at = null;
    desk.choose(null);
    desk.send({ verb: 'pin', at: [x, y], height }, { kind: 'pin', line: [x, y] })
      .then((reply) => reply && desk.tool === this && this.#take(desk.drawing.pins.at(-1)));
  }

  #take(pin) {
    this.desk.choose(pin);
    this.desk.speak(this.desk.describe(pin));
    this.desk.onask();
  }

  press(at) {
    this.released(at);
  }

  key(event) {
    const { desk } = this;
    if ((event.key !== 'Delete' && event.key !== 'Backspace') || !desk.chosen) return this.steps(event);
    desk.remove();
    return true;
  }

  draw(pen, place) {
    const p = this.#at && place(this.#at.x, this.#at.y);
    if (p) peg(pen, p, ink.pin, 0.6);
    super.draw(pen, place);
  }
}

/** Chooses what is drawn, and moves its vertices. */
export class Select extends Tool {
  cursor = 'default';
  #drag = null; // {object, vertex, insert, reach, from, to, target, moved}
  #beside = null; // where the view was pressed

  #handles() {
    const { chosen } = this.desk;
    return chosen ? this.overlay.handles(chosen) : [];
  }

  #handleAt(px, reach) {
    return (
      this.#handles()
        .map((h) => ({ ...h, d: apart(h, px) }))
        .filter(({ d }) => d <= reach)
        .sort((a, b) => a.d - b.d)[0] ?? null
    );
  }

  #hit(at, pixels) {
    const { desk } = this;
    const { drawing, chosen } = desk;
    const reach = pixels * desk.scale(at);
    for (const accept of [
      ({ kind }) => kind === 'pin',
      (one) => one === chosen,
      ({ kind }) => kind === 'river',
      ({ kind }) => kind === 'ridge',
      ({ kind }) => kind === 'coast',
      ({ kind }) => kind === 'lake',
      ({ kind }) => kind === 'mask',
    ]) {
      const found = drawing.nearest(at, reach, accept);
      if (found) return found;
    }
    const lake = drawing.lakes.find(({ line }) => inside(at.x, at.y, line));
    return lake ? { object: lake, ...at } : null;
  }

  // ── Taking hold.
  /** Takes what lies at a place; false: nothing does. */
  #grab(at, px, reach) {
    const { desk } = this;
    const handle = this.#handleAt(px, reach);
    if (handle) {
      desk.choose(desk.chosen, handle.i);
      this.#lift({ vertex: handle.i }, at, px);
      return true;
    }
    const found = at && this.#hit(at, reach);
    if (!found) return false;
    if (found.object !== desk.chosen) {
      desk.choose(found.object);
      desk.speak(desk.describe(found.object));
    } else if (found.i) this.#onLine(found, at, px);
    return true;
  }

  /** The line between two handles: of a dense line the nearest vertex, else a new one. */
  #onLine(found, at, px) {
    const { chosen } = this.desk;
    if (chosen.kind === 'pin') {
      this.#lift({ vertex: 0 }, at, px);
      return;
    }
    const count = chosen.line.length / 2;
    if (!this.#dense()) {
      this.#lift({ insert: found.i, foot: found }, at, px);
      return;
    }
    const [i, k] = [found.i - 1, found.i % count];
    const off = (n) => Math.hypot(chosen.line[2 * n] - found.x, chosen.line[2 * n + 1] - found.y);
    const vertex = off(i) < off(k) ? i : k;
    this.desk.choose(chosen, vertex);
    this.#lift({ vertex }, at, px);
  }

  #dense() {
    return this.#handles().length < 0.7 * (this.desk.chosen.line.length / 2);
  }

  #lift(what, at, px) {
    const { chosen } = this.desk;
    // Of a dense line what lies within two or three handles follows.
    const reach = this.#dense() && at ? round(50 * this.desk.scale(at)) : 0;
    this.#drag = { object: chosen, reach, px, to: at, moved: false, target: null, ...what };
  }

  down(at, event) {
    const { desk } = this;
    desk.cursor = null;
    desk.quiet();
    const px = desk.pixel(event);
    this.#beside = null;
    if (this.#grab(at, px, event.pointerType === 'touch' ? 18 : 10)) return true;
    this.#beside = px;
    this.view.canvas.addEventListener(
      'pointerup',
      (end) => this.#beside && apart(this.#beside, desk.pixel(end)) < 4 && desk.choose(null),
      { once: true },
    );
    return false;
  }

  #moved(at) {
    const drag = this.#drag;
    if (!drag || !at) return;
    drag.moved = true;
    const { object, vertex } = drag;
    const last = object.line.length / 2 - 1;
    const end = vertex !== undefined && !object.closed && (vertex === 0 || vertex === last);
    drag.target = end
      ? this.desk.snap(at, { river: ['river', 'coast', 'border'], coast: ['border'] }[object.kind] ?? [], {
          pixels: near,
          except: object,
        })
      : null;
    drag.to = drag.target ?? at;
  }

  move(at, event) {
    const px = this.desk.pixel(event);
    if (this.#drag && (this.#drag.moved || apart(px, this.#drag.px) >= 4)) {
      this.#moved(at ?? this.desk.edge(this.#drag.px, px));
    }
  }

  up() {
    this.#put();
  }

  cancel() {
    this.#drag = null;
  }

  #put() {
    const { desk } = this;
    const drag = this.#drag;
    this.#drag = null;
    if (!drag) return;
    const { object, vertex, insert, reach } = drag;
    if (!drag.moved && insert === undefined) return;
    const to = drag.moved ? drag.to : drag.foot;
    const at = [drag.target ? to.x : round(to.x), drag.target ? to.y : round(to.y)];
    const of = (same) => ({ [object.kind]: same(object).n });
    const ghost = { kind: object.kind, closed: object.closed, line: this.#shape({ ...drag, to }), hides: [object] };
    if (insert === undefined) desk.send((same) => ({ verb: 'move', of: of(same), vertex, to: at, reach }), ghost);
    else desk.send((same) => ({ verb: 'insert', of: of(same), vertex: insert, at }), ghost);
    // What comes back is known again by its line.
    desk.chosen = desk.drawing.like(object, ghost.line);
    desk.vertex = object.kind === 'pin' ? -1 : insert ?? vertex;
    desk.speak('put down');
  }

  /** The line as it is with what is in the hand. */
  #shape({ object, vertex, insert, to, reach }) {
    if (insert === undefined) return bent(object.line, vertex, [to.x, to.y], reach, object.closed);
    return [...object.line.slice(0, 2 * insert), to.x, to.y, ...object.line.slice(2 * insert)];
  }

  // ── Without a button.
  hover(at, event) {
    const { desk, view } = this;
    desk.cursor = null;
    const handle = this.#handleAt(desk.pixel(event), 10);
    this.point(at);
    view.canvas.style.cursor = handle ? 'move' : desk.hovered ? 'pointer' : '';
  }

  point(at) {
    const { desk } = this;
    if (this.#drag) this.#moved(at);
    else desk.hovered = at && this.#hit(at, 10);
  }

  press(at) {
    const p = this.view.place(at.x, at.y);
    if (this.#drag) {
      this.#put();
      return;
    }
    if (!p || !this.#grab(at, p, 10)) this.desk.choose(null);
    else if (this.#drag) this.desk.speak(this.#drag.insert === undefined ? 'picked up' : 'a new vertex is picked up');
  }

  key(event) {
    const { desk } = this;
    if ((event.key === 'Delete' || event.key === 'Backspace') && desk.chosen) {
      desk.remove(event.shiftKey);
      return true;
    }
    if (event.key === 'Escape' && (this.#drag || desk.chosen)) {
      if (this.#drag) this.#drag = null;
      else desk.choose(null);
      return true;
    }
    if (event.key === 'PageDown' || event.key === 'PageUp') return this.#next(event.key === 'PageDown' ? 1 : -1);
    return this.steps(event);
  }

  /** The next of what is drawn. */
  #next(step) {
    const { desk } = this;
    const { objects } = desk.drawing;
    if (objects.length === 0) return true;
    const k = objects.indexOf(desk.chosen);
    desk.choose(objects[k < 0 ? (step > 0 ? 0 : objects.length - 1) : (k + step + objects.length) % objects.length]);
    desk.cursor = { x: desk.chosen.line[0], y: desk.chosen.line[1] };
    desk.speak(desk.describe(desk.chosen));
    return true;
  }

  draw(pen, place) {
    const { desk, overlay } = this;
    const drag = this.#drag;
    if (drag && (drag.moved || drag.insert !== undefined)) {
      overlay.stroke(pen, place, this.#shape(drag), {
        closed: drag.object.closed,
        colour: orange,
        arrows: drag.object.kind === 'river',
      });
      overlay.ring(pen, place, drag.target);
      const p = place(drag.to.x, drag.to.y);
      if (p) dot(pen, p, 5, { fill: orange, stroke: '#fff' });
    } else if (desk.chosen && desk.ghosts.length === 0) {
      const last = desk.chosen.line.length / 2 - 1;
      for (const { i, x, y } of this.#handles()) {
        const end = desk.chosen.kind === 'river' && (i === 0 || i === last);
        if (desk.chosen.kind === 'pin') continue;
        if (i === desk.vertex) dot(pen, { x, y }, 5.5, { fill: orange, stroke: '#fff' });
        else if (!end) dot(pen, { x, y }, 3.6, { stroke: orange, width: 1.8 });
      }
    }
    super.draw(pen, place);
  }
}
