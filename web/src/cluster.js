// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The DLA cluster with its arms coloured, of which one becomes the valley.
import { make } from './elements.js';
import { bytesOf } from './unpack.js';

const arms = ['north', 'east', 'south', 'west'];
const colours = [[47, 122, 184], [217, 108, 30], [32, 145, 104], [178, 92, 148], [130, 130, 130]]; // the last: no arm

/** The least square that holds the cluster, and its longest arm. */
function read({ arms: base64, width, height }) {
  const bytes = bytesOf(base64);
  const box = { c0: width, c1: 0, r0: height, r1: 0 };
  const size = [0, 0, 0, 0, 0];
  for (let r = 0, i = 0; r < height; ++r) {
    for (let c = 0; c < width; ++c, ++i) {
      if (!bytes[i]) continue;
      ++size[bytes[i] - 1];
      box.c0 = Math.min(box.c0, c);
      box.c1 = Math.max(box.c1, c);
      box.r0 = Math.min(box.r0, r);
      box.r1 = Math.max(box.r1, r);
    }
  }
  const side = Math.max(1, box.c1 - box.c0 + 1, box.r1 - box.r0 + 1);
  const [c0, r0] = [(box.c0 + box.c1 + 1 - side) / 2, (box.r0 + box.r1 + 1 - side) / 2];
  return { bytes, width, height, side, c0, r0, largest: arms[size.indexOf(Math.max(...size.slice(0, 4)))] };
}

/** Cells by arm in a square of the cluster, every step-th one, and how many were looked at. */
function countArms({ bytes, width, height }, left, top, side, step) {
  const counts = [0, 0, 0, 0, 0];
  let seen = 0;
  for (let r = Math.floor(top); r < Math.max(Math.floor(top) + 1, top + side); r += step) {
    for (let c = Math.floor(left); c < Math.max(Math.floor(left) + 1, left + side); c += step) {
      ++seen;
      const arm = r >= 0 && c >= 0 && r < height && c < width ? bytes[r * width + c] : 0;
      if (arm) ++counts[arm - 1];
    }
  }
  return { counts, seen };
}

export class ClusterPicture {
  #canvas = make('canvas', { width: 1, height: 1 });
  #buttons;
  #cells = null; // of the cluster, as read() gives them
  #branch = '';

  /** choices: of the key; choose(arm): an arm was clicked. */
  constructor(choices, choose) {
    this.#canvas.setAttribute('aria-hidden', 'true'); // the buttons beside it say the same
    this.#buttons = choices.map((name) => this.#button(name, choose));
    const group = make('div', { className: 'arms' }, ...this.#buttons);
    group.setAttribute('role', 'group');
    group.setAttribute('aria-label', 'Arm of the cluster that becomes the valley');
    this.element = make('div', { className: 'cluster', hidden: true }, this.#canvas, group);
    this.#canvas.addEventListener('pointermove', (event) => {
      const arm = this.#armAt(event.offsetX, event.offsetY);
      this.#canvas.style.cursor = arm ? 'pointer' : '';
      this.#canvas.title = arm ? `Take the ${arm} arm` : '';
    });
    this.#canvas.addEventListener('click', (event) => {
      const arm = this.#armAt(event.offsetX, event.offsetY);
      if (arm) choose(arm);
    });
  }

  #button(name, choose) {
    const swatch = make('i', {});
    const k = arms.indexOf(name);
    if (k >= 0) swatch.style.background = `rgb(${colours[k]})`;
    const button = make('button', { type: 'button' }, k >= 0 && swatch, name);
    button.dataset.arm = name;
    button.addEventListener('click', () => choose(name));
    return button;
  }

  #draw() {
    const cells = this.#cells;
    if (!cells) return;
    const pixels = Math.round(116 * Math.min(window.devicePixelRatio || 1, 2));
    this.#canvas.width = this.#canvas.height = pixels;
    const chosen = this.#branch === 'largest' ? cells.largest : this.#branch;
    const picture = new ImageData(pixels, pixels);
    const per = cells.side / pixels;
    const step = Math.max(1, Math.floor(per / 3));
    for (let y = 0; y < pixels; ++y) {
      for (let x = 0; x < pixels; ++x) {
        const { counts, seen } = countArms(cells, cells.c0 + x * per, cells.r0 + y * per, per, step);
        const k = counts.indexOf(Math.max(...counts));
        if (!counts[k]) continue;
        const weight = Math.min(1, (2.2 * counts[k]) / seen) * (chosen === 'all' || arms[k] === chosen ? 1 : 0.32);
        picture.data.set([...colours[k], Math.round(255 * weight)], 4 * (y * pixels + x));
      }
    }
    this.#canvas.getContext('2d').putImageData(picture, 0, 0);
  }

  /** The arm nearest to a place of the picture, within some pixels, or null. */
  #armAt(px, py) {
    const cells = this.#cells;
    if (!cells) return null;
    const per = cells.side / this.#canvas.clientWidth;
    const [x, y] = [cells.c0 + px * per, cells.r0 + py * per];
    const reach = Math.ceil(7 * per);
    let least = reach * reach + 1;
    let found = 0;
    for (let r = Math.max(0, Math.floor(y) - reach); r <= Math.min(cells.height - 1, y + reach); ++r) {
      for (let c = Math.max(0, Math.floor(x) - reach); c <= Math.min(cells.width - 1, x + reach); ++c) {
        const d = (c - x) ** 2 + (r - y) ** 2;
        if (d < least && arms[cells.bytes[r * cells.width + c] - 1]) {
          least = d;
          found = cells.bytes[r * cells.width + c];
        }
      }
    }
    return arms[found - 1] ?? null;
  }

  /** message: of the program; null or without a cluster: the picture goes. */
  show(message) {
    this.#cells = message?.arms ? read(message) : null;
    this.element.hidden = !this.#cells;
    this.#draw();
  }

  /** branch: the arm that is taken, 'largest' or 'all'. */
  mark(branch) {
    this.#branch = branch;
    for (const button of this.#buttons) button.setAttribute('aria-pressed', String(button.dataset.arm === branch));
    this.#draw();
  }
}
