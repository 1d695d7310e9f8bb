// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What stands beside the toolbar while one draws: what is chosen, and what can be done with it; and words at the
// pointer.
import { button, byId, make } from './elements.js';

/** Words over the view: they lie at a place of the land or at the pointer. */
function saying(desk, stage) {
  const box = make('div', { id: 'saying', hidden: true });
  const spoken = make('p', { className: 'unseen', id: 'drawing-said' });
  spoken.setAttribute('role', 'status');
  box.setAttribute('aria-hidden', 'true'); // it is spoken
  stage.append(box, spoken);
  let at = null;
  let fading;
  let pointer = { x: 0, y: 0 };
  window.addEventListener('pointermove', (event) => (pointer = desk.pixel(event)), { capture: true, passive: true });
  desk.speak = (text) => {
    spoken.textContent = text;
  };
  desk.quiet = () => {
    clearTimeout(fading);
    box.hidden = true;
  };
  const follow = () => {
    if (box.hidden) return;
    const p = (at?.place && desk.view.place(...at.place)) || at?.pixel;
    const { clientWidth, clientHeight } = desk.view.parent;
    const [w, h] = [box.offsetWidth, box.offsetHeight];
    const above = p.y - h - 14;
    box.style.left = `${Math.min(Math.max(p.x - w / 2, 8), clientWidth - w - 8)}px`;
    box.style.top = `${Math.min(above < 8 ? p.y + 18 : above, clientHeight - h - 8)}px`;
  };
  desk.ontell = (text, { at: place, bad = false }) => {
    desk.quiet();
    const cursor = desk.cursor && [desk.cursor.x, desk.cursor.y];
    at = { place: place ?? cursor, pixel: pointer };
    box.textContent = text;
    box.classList.toggle('bad', bad);
    box.hidden = false;
    follow();
    desk.speak(text);
    if (!bad) fading = setTimeout(desk.quiet, 6000);
  };
  return follow;
}

const numberInput = (id, properties) => make('input', { type: 'number', id, autocomplete: 'off', ...properties });

function row(label, control, unit = '') {
  const name = make('label', { htmlFor: control.id, textContent: label });
  return make('div', { className: 'row' }, name, control, unit && make('span', { textContent: unit }));
}

/** A field shows a value unless somebody is typing in it. */
function put(input, value, always = false) {
  if (always || document.activeElement !== input) input.value = value;
}

const metresOf = ({ value }) => (value.trim() === '' ? null : Number(value));

/** Type and branching of a river: of the chosen one, or of those that are drawn next. */
class RiverFields {
  #desk;
  #types;
  #type = make('select', { id: 'river-type' });
  #lambda = numberInput('river-lambda', { min: 1, max: 50, step: 1, placeholder: 'recipe' });
  #typeRow = row('Type', this.#type);
  #lambdaRow = row('Branching', this.#lambda);
  rows = [this.#typeRow, this.#lambdaRow];

  constructor(desk, types) {
    this.#desk = desk;
    this.#types = types;
    this.#lambdaRow.title =
      'Generator lambda of the side streams: 1 has none, 2 is dendritic, larger values are feathered; ' +
      'empty: as the recipe says';
    this.#type.addEventListener('change', () => {
      const river = desk.chosenOf('river');
      const { value } = this.#type;
      if (river) desk.send((same) => ({ verb: 'type', rivers: [same(river).n], type: value }));
      else desk.type = value;
    });
    this.#lambda.addEventListener('change', () => {
      const river = desk.chosenOf('river');
      const value = Math.min(50, Math.max(0, Math.round(Number(this.#lambda.value) || 0)));
      if (river) desk.send((same) => ({ verb: 'lambda', rivers: [same(river).n], lambda: value }));
      else desk.lambda = value;
    });
  }

  show() {
    const [desk, types] = [this.#desk, this.#types];
    const river = desk.chosenOf('river');
    this.#typeRow.hidden = !(river || desk.tool?.id === 'river');
    this.#lambdaRow.hidden = this.#typeRow.hidden || !desk.drawing.branching;
    const value = river ? river.type : desk.type;
    const all = ['', ...types, ...(types.includes(value) || value === '' ? [] : [value])];
    if (all.join() !== Array.from(this.#type.options, (o) => o.value).join()) {
      this.#type.replaceChildren(...all.map((t) => make('option', { value: t, textContent: t || 'none' })));
    }
    this.#type.value = value;
    put(this.#lambda, (river ? river.lambda : desk.lambda) || '');
  }
}

/** The level of a lake: of the chosen one, or of those that are drawn next. */
class LakeField {
  #desk;
  #level = numberInput('lake-level', { step: 'any', placeholder: 'by the terrain' });
  row = row('Level', this.#level, 'm');

  constructor(desk) {
    this.#desk = desk;
    this.#level.addEventListener('change', () => {
      const lake = desk.chosenOf('lake');
      const level = metresOf(this.#level);
      if (lake) desk.send((same) => ({ verb: 'level', lake: same(lake).n, level }));
      else desk.level = level;
    });
  }

  show() {
    const lake = this.#desk.chosenOf('lake');
    this.row.hidden = !(lake || this.#desk.tool?.id === 'lake');
    put(this.#level, (lake ? lake.level : this.#desk.level) ?? '');
  }
}

/** The height of the chosen pin, or those of the ends of the chosen ridge. */
class HeightFields {
  #desk;
  #shown = null; // whose values the fields have
  #height = numberInput('pin-height', { step: 'any' });
  #from = numberInput('ridge-from', { step: 'any', placeholder: 'by the terrain' });
  #to = numberInput('ridge-to', { step: 'any', placeholder: 'by the terrain' });
  #pinRow = row('Height', this.#height, 'm');
  #ridgeRows = [row('Begins at', this.#from, 'm'), row('Ends at', this.#to, 'm')];
  rows = [this.#pinRow, ...this.#ridgeRows];

  constructor(desk) {
    this.#desk = desk;
    for (const element of this.#ridgeRows) {
      element.title = 'Height of the ridge at its end; one alone: it is level; none: it is as high as the terrain';
    }
    this.#height.addEventListener('change', () => {
      const pin = desk.chosenOf('pin');
      const height = metresOf(this.#height);
      if (pin && height !== null) this.#raise('height', pin, { height });
      else this.show({ always: true }); // a pin has a height
    });
    for (const end of [this.#from, this.#to]) {
      end.addEventListener('change', () => {
        const ridge = desk.chosenOf('ridge');
        if (ridge) this.#raise('heights', ridge, { from: metresOf(this.#from), to: metresOf(this.#to) });
      });
    }
    // Enter and Escape lead back to the land, where the next one is drawn.
    for (const input of [this.#height, this.#from, this.#to]) {
      input.addEventListener('keydown', (event) => {
        if (event.key === 'Escape') this.show({ always: true });
        if (event.key !== 'Enter' && event.key !== 'Escape') return;
        desk.view.canvas.focus({ preventScroll: true });
        event.stopPropagation();
      });
    }
    desk.onask = () => {
      const input = desk.chosen?.kind === 'ridge' ? this.#from : this.#height;
      input.focus({ preventScroll: true });
      input.select();
    };
  }

  /** What is chosen has other heights at once, and the former ones again where they are refused. */
  async #raise(verb, object, heights) {
    const before = { ...object };
    Object.assign(object, heights);
    if (await this.#desk.send((same) => ({ verb, [object.kind]: same(object).n, ...heights }))) return;
    Object.assign(object, before);
    this.#desk.onchange();
  }

  /** always: also where somebody is typing, as where something else was chosen meanwhile. */
  show({ always = false } = {}) {
    const { chosen } = this.#desk;
    const [pin, ridge] = ['pin', 'ridge'].map((kind) => this.#desk.chosenOf(kind));
    const isOther = chosen?.kind !== this.#shown?.kind || chosen?.n !== this.#shown?.n;
    this.#shown = chosen;
    this.#pinRow.hidden = !pin;
    for (const element of this.#ridgeRows) element.hidden = !ridge;
    if (pin) put(this.#height, pin.height, always || isOther);
    if (!ridge) return;
    put(this.#from, ridge.from ?? '', always || isOther);
    put(this.#to, ridge.to ?? '', always || isOther);
  }
}

/** What can be done with what is chosen, or with the line that is drawn. */
class Actions {
  #desk;
  #reverse;
  #swap;
  #erase;
  #alone;
  #finish;
  #back;

  constructor(desk) {
    this.#desk = desk;
    this.#reverse = button('Reverse', 'The river and all below it run the other way', () => {
      const river = desk.chosenOf('river');
      desk.send((same) => ({ verb: 'reverse', river: same(river).n }));
    });
    this.#swap = button('Swap land and sea', 'Land and sea change sides', () => {
      const coast = desk.chosenOf('coast');
      desk.send((same) => ({ verb: 'swap', coast: same(coast).n }));
    });
    this.#erase = button('Delete', '', () => desk.remove());
    this.#alone = button('Delete alone', 'The rivers that flow into it stay (Shift+Delete)', () => desk.remove(true));
    this.#finish = button('End the line', '(Enter, double click)', () => desk.tool.finish());
    this.#back = button('Take back', 'The last point (Backspace)', () => desk.tool.back());
    const all = [this.#finish, this.#back, this.#reverse, this.#swap, this.#erase, this.#alone];
    this.element = make('div', { className: 'actions' }, ...all);
  }

  show() {
    const { chosen, drawing, tool, vertex } = this.#desk;
    const river = this.#desk.chosenOf('river');
    this.#reverse.hidden = !river;
    this.#swap.hidden = !this.#desk.chosenOf('coast');
    this.#erase.hidden = !chosen;
    this.#erase.textContent = vertex >= 0 ? 'Delete vertex' : 'Delete';
    const other = river ? 'The river with all that flow into it' : 'What is chosen';
    this.#erase.title = `${vertex >= 0 ? 'The chosen vertex' : other} (Delete)`;
    this.#alone.hidden = !river || vertex >= 0 || drawing.above(river).length < 2;
    const isDrawn = (tool.line?.length ?? 0) > 0;
    this.#finish.hidden = this.#back.hidden = !isDrawn;
    this.element.hidden = !chosen && !isDrawn;
  }
}

/** The sheet as a whole: side streams, and clearing it. */
class SheetFields {
  #desk;
  #branching = make('input', { type: 'checkbox', id: 'branching' });
  #clear;

  constructor(desk) {
    this.#desk = desk;
    this.#branching.title = 'Every river grows a network of side streams';
    this.#branching.addEventListener('change', () => desk.send({ verb: 'branching', on: this.#branching.checked }));
    this.#clear = button('Clear sheet', 'An empty sheet: nothing is drawn on it', () => this.#clearAll());
    const label = make('label', {}, this.#branching, 'side streams');
    this.element = make('div', { className: 'whole' }, label, this.#clear);
  }

  async #clearAll() {
    const desk = this.#desk;
    const { drawing } = desk;
    desk.choose(null);
    if (await desk.send({ verb: 'clear' }, { kind: 'river', line: [], hides: drawing.objects })) {
      desk.ontell('An empty sheet. Undo (Ctrl+Z) brings everything back', {});
    }
  }

  show() {
    const { drawing } = this.#desk;
    this.#branching.checked = drawing.branching;
    this.#clear.disabled = drawing.empty;
  }
}

export class Inspector {
  /** Words go with the view. */
  follow;
  #desk;
  #title = make('p', { className: 'what' });
  #note = make('p', { className: 'hint' });
  #hint = make('p', { id: 'sheet-hint', hidden: true });
  #parts;
  #box;

  /** types: of rivers. */
  constructor(desk, types) {
    this.#desk = desk;
    const stage = byId('stage');
    this.follow = saying(desk, stage);
    const [rivers, lake, heights] = [new RiverFields(desk, types), new LakeField(desk), new HeightFields(desk)];
    const [actions, sheet] = [new Actions(desk), new SheetFields(desk)];
    this.#parts = [rivers, lake, heights, actions, sheet];
    const fields = [...rivers.rows, lake.row, ...heights.rows, actions.element, sheet.element];
    this.#box = make('section', { id: 'inspector', hidden: true }, this.#title, this.#note, ...fields);
    this.#box.setAttribute('aria-label', 'Drawing');
    const key = make('kbd', { textContent: 'R' });
    this.#hint.append('Draw a river ', key, ': from its source to the sea, or the other way');
    byId('view').after(this.#box);
    stage.append(this.#hint);
  }

  /** What there is on the sheet, in words. */
  #countAll() {
    const { rivers, coasts, lakes, masks, pins, ridges } = this.#desk.drawing;
    const counts = Object.entries({ river: rivers, coast: coasts, lake: lakes, mask: masks, pin: pins, ridge: ridges })
      .filter(([, { length }]) => length > 0)
      .map(([word, { length }]) => `${length} ${word}${length > 1 ? 's' : ''}`);
    return `${counts.join(', ') || 'Nothing is drawn'}.`;
  }

  #noteNow() {
    const { chosen, drawing, tool } = this.#desk;
    if (drawing.kind === 'shown' && drawing.rivers.length) {
      return 'The network becomes drawn lines; undo brings the generator back.';
    }
    if (chosen?.kind === 'river' && this.#desk.bends()) return 'It meanders about this line (network.meander).';
    if (chosen) return '';
    return tool.id === 'select' ? this.#countAll() : `${tool.help}.`;
  }

  /** Shows what is chosen, held and drawn now. */
  show() {
    const { chosen, drawing, fits, ghosts, tool } = this.#desk;
    this.#box.hidden = !tool || !drawing;
    this.#hint.hidden =
      !drawing || drawing.rivers.length > 0 || !fits || ghosts.length > 0 || (tool?.line?.length ?? 0) > 0;
    if (this.#box.hidden) return;
    this.#title.textContent = chosen ? this.#desk.describe(chosen) : tool.title.split(':')[0];
    const note = this.#noteNow();
    this.#note.textContent = note;
    this.#note.hidden = note === '';
    for (const part of this.#parts) part.show();
  }
}
