// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Tools that work on the land, and what they draw over it. While one is held, the left button, a pen or one finger are
// its own; two fingers, the other buttons, the wheel, and the left button with the space bar go on moving the view.
import { draw, make } from './elements.js';
import { typing } from './keys.js';

/**
 * A tool: {id, title, icon: path on 20 x 20, letter: the key that takes it, group: number, the buttons of a group stand
 * together}, and of the following what it needs; `at` is a place {x, y} in cells, or null beside the land
 *   cursor: 'crosshair'
 *   down(at, event), move(at, event), up(at, event): one gesture; cancel(): it ended otherwise, or the tool is put away
 *   hover(at, event): the pointer without a button
 *   key(event): true where the key was the tool's
 *   draw(pen, place): what lies over the view; place(x, y) gives {x, y} [pixels] or null
 *   taken(), dropped(): the tool came into the hand, and left it
 */
export class Tools {
  held = null;
  #tools = new Map();
  #gesture = null; // pointer that the tool follows
  #fingers = new Set();
  #begun = null; // the event that began the gesture
  #passes = false; // an event is on its way to the view
  #space = false;
  #layers = []; // functions (pen, place) that always draw, below the tool

  constructor(view) {
    this.view = view;
    const { parent } = view;
    this.bar = make('div', { id: 'toolbar', hidden: true });
    this.bar.setAttribute('role', 'toolbar');
    this.bar.setAttribute('aria-label', 'Tools');
    this.bar.setAttribute('aria-orientation', 'vertical');
    parent.parentElement.append(this.bar);
    this.canvas = Object.assign(document.createElement('canvas'), { className: 'overlay' });
    this.canvas.setAttribute('aria-hidden', 'true');
    parent.append(this.canvas);
    const drawn = view.ondraw;
    view.ondraw = (turn) => {
      drawn?.(turn);
      this.draw();
    };
    for (const kind of ['pointerdown', 'pointermove', 'pointerup', 'pointercancel']) {
      parent.addEventListener(kind, (event) => this.#follow(event), { capture: true });
    }
    parent.addEventListener('contextmenu', (event) => this.held && event.preventDefault());
    window.addEventListener('keydown', (event) => {
      if (event.code === 'Space' && event.target === view.canvas) this.#space = true;
      const inDialog = /** @type {Element} */ (event.target).closest?.('dialog');
      if (typing(event) || inDialog || event.ctrlKey || event.metaKey || event.altKey) return;
      const tool = Array.from(this.#tools.values()).find(
        ({ letter, button }) => letter === event.key.toLowerCase() && !button.disabled && !button.hidden,
      );
      if (this.held?.key?.(event)) {
        event.preventDefault();
        event.stopPropagation();
        this.draw();
      } else if (event.key === 'Escape' && this.held) {
        if (this.#gesture !== null) this.#end();
        else this.hold(null);
      } else if (tool && !event.shiftKey) this.hold(tool === this.held ? null : tool.id);
    }, { capture: true });
    window.addEventListener('keyup', (event) => event.code === 'Space' && (this.#space = false));
    window.addEventListener('blur', () => (this.#space = false));
  }

  /** Puts a tool into the bar. Gives its button, as tool.button has it. */
  add(tool) {
    const { id, title, icon, letter, group = 0 } = tool;
    const button = make(
      'button',
      { type: 'button', id: `tool-${id}`, title: `${title}${letter ? ` (${letter.toUpperCase()})` : ''}` },
      draw('svg', { viewBox: '0 0 20 20', 'aria-hidden': 'true' }, draw('path', { d: icon })),
    );
    button.setAttribute('aria-label', title);
    button.setAttribute('aria-pressed', 'false');
    button.addEventListener('click', () => this.hold(this.held === tool ? null : id));
    button.dataset.group = String(group);
    const buttons = /** @type {HTMLElement[]} */ (Array.from(this.bar.children));
    const after = buttons.findIndex((other) => Number(other.dataset.group) > group);
    buttons.splice(after < 0 ? buttons.length : after, 0, button);
    this.bar.insertBefore(button, buttons[buttons.indexOf(button) + 1] ?? null);
    buttons.forEach((one, i) =>
      one.classList.toggle('begins', i > 0 && one.dataset.group !== buttons[i - 1].dataset.group),
    );
    this.bar.hidden = false;
    this.#tools.set(id, tool);
    tool.button = button;
    return button;
  }

  /** What is drawn whatever tool is held. */
  layer(paint) {
    this.#layers.push(paint);
  }

  /** Takes a tool by its id; null: none. */
  hold(id) {
    const next = this.#tools.get(id) ?? null;
    if (next === this.held) return;
    this.#end();
    this.held?.dropped?.();
    this.held?.button.setAttribute('aria-pressed', 'false');
    next?.button.setAttribute('aria-pressed', 'true');
    this.held = next;
    this.view.canvas.style.cursor = next?.cursor ?? '';
    next?.taken?.();
    this.draw();
  }

  #end() {
    if (this.#gesture === null) return;
    this.#gesture = null;
    this.held?.cancel?.();
    this.draw();
  }

  /** Two fingers move the view: it gets the first one too, which the tool had. */
  #handOver() {
    if (this.#gesture === null) return;
    const { clientX, clientY, pointerId, pointerType, isPrimary } = this.#begun;
    this.#end();
    this.#passes = true;
    this.view.canvas.dispatchEvent(
      new PointerEvent('pointerdown', {
        clientX,
        clientY,
        pointerId,
        pointerType,
        isPrimary,
        button: 0,
        buttons: 1,
        bubbles: true,
        cancelable: true,
      }),
    );
    this.#passes = false;
  }

  #at(event) {
    const frame = this.view.canvas.getBoundingClientRect();
    return this.view.under(event.clientX - frame.left, event.clientY - frame.top);
  }

  #follow(event) {
    const tool = this.held;
    if (this.#passes) return;
    if (event.type === 'pointerdown' && event.pointerType === 'touch') this.#fingers.add(event.pointerId);
    if (event.type === 'pointerup' || event.type === 'pointercancel') this.#fingers.delete(event.pointerId);
    if (!tool || event.target !== this.view.canvas) return;
    const mine = event.pointerId === this.#gesture;
    if (event.type === 'pointerdown') {
      // A hand that rests beside a pen or a mouse changes nothing.
      const other =
        this.#gesture !== null &&
        event.pointerId !== this.#gesture &&
        (this.#begun.pointerType !== 'touch' || event.pointerType !== 'touch');
      if (other) {
        event.stopPropagation();
        return;
      }
      if (this.#fingers.size > 1) this.#handOver();
      if (this.#fingers.size > 1 || event.button !== 0 || this.#space) return;
      const at = this.#at(event);
      // first: what is typed beside the view belongs to what is chosen now
      this.view.canvas.focus({ preventScroll: true });
      if (tool.down?.(at, event) === false) return; // it leaves the gesture to the view
      this.#gesture = event.pointerId;
      this.#begun = event;
      this.view.canvas.setPointerCapture(event.pointerId);
    } else if (event.type === 'pointermove') {
      if (mine) {
        const all = event.getCoalescedEvents?.() ?? [];
        for (const one of all.length ? all : [event]) tool.move?.(this.#at(one), one);
      } else if (event.buttons === 0) tool.hover?.(this.#at(event), event);
      if (!mine) return; // the page reads what is under the pointer
    } else {
      if (!mine) return;
      if (event.type === 'pointercancel') this.#end();
      else {
        this.#gesture = null;
        tool.up?.(this.#at(event), event);
      }
    }
    event.stopPropagation();
    this.draw();
  }

  /** Draws the layers and the tool's own lines over the view. */
  draw() {
    const { parent } = this.view;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const [width, height] = [Math.round(parent.clientWidth * ratio), Math.round(parent.clientHeight * ratio)];
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
    // kept off the GPU, where Chromium may show it stale once it is empty
    const pen = this.canvas.getContext('2d', { willReadFrequently: true });
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.clearRect(0, 0, width, height);
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.lineJoin = pen.lineCap = 'round';
    const place = (x, y) => this.view.place(x, y);
    for (const layer of this.#layers) layer(pen, place);
    this.held?.draw?.(pen, place);
  }
}
