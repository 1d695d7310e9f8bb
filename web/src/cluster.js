// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The DLA cluster with its arms coloured, of which one becomes the valley.
import { make } from './elements.js';
import { bytesOf } from './unpack.js';

const arms = ['north', 'east', 'south', 'west'];
const colours = [[47, 122, 184], [217, 108, 30], [32, 145, 104], [178, 92, 148], [130, 130, 130]]; // the last: no arm

/** choose(arm): an arm was clicked. choices: of the key. Gives {element, show(message or null), mark(branch)}. */
export function clusterPicture(choices, choose) {
  const canvas = make('canvas', { width: 1, height: 1 });
  canvas.setAttribute('aria-hidden', 'true'); // the buttons beside it say the same
  const buttons = choices.map((name) => {
    const swatch = make('i', {});
    const k = arms.indexOf(name);
    if (k >= 0) swatch.style.background = `rgb(${colours[k]})`;
    const button = make('button', { type: 'button' }, k >= 0 && swatch, name);
    button.dataset.arm = name;
    button.addEventListener('click', () => choose(name));
    return button;
  });
  const group = make('div', { className: 'arms' }, ...buttons);
  group.setAttribute('role', 'group');
  group.setAttribute('aria-label', 'Arm of the cluster that becomes the valley');
  const element = make('div', { className: 'cluster', hidden: true }, canvas, group);
  let cells = null; // {bytes, width, height, box}
  let branch = '';

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
    return {
      bytes,
      width,
      height,
      side,
      c0: (box.c0 + box.c1 + 1 - side) / 2,
      r0: (box.r0 + box.r1 + 1 - side) / 2,
      largest: arms[size.indexOf(Math.max(...size.slice(0, 4)))],
    };
  }

  function draw() {
    if (!cells) return;
    const { bytes, width, height, side, c0, r0 } = cells;
    const pixels = Math.round(116 * Math.min(window.devicePixelRatio || 1, 2));
    canvas.width = canvas.height = pixels;
    const chosen = branch === 'largest' ? cells.largest : branch;
    const picture = new ImageData(pixels, pixels);
    const per = side / pixels;
    const step = Math.max(1, Math.floor(per / 3));
    for (let y = 0; y < pixels; ++y) {
      for (let x = 0; x < pixels; ++x) {
        const most = [0, 0, 0, 0, 0];
        let seen = 0;
        for (
          let r = Math.floor(r0 + y * per);
          r < Math.max(Math.floor(r0 + y * per) + 1, r0 + (y + 1) * per);
          r += step
        ) {
          for (
            let c = Math.floor(c0 + x * per);
            c < Math.max(Math.floor(c0 + x * per) + 1, c0 + (x + 1) * per);
            c += step
          ) {
            ++seen;
            const arm = r >= 0 && c >= 0 && r < height && c < width ? bytes[r * width + c] : 0;
            if (arm) ++most[arm - 1];
          }
        }
        const k = most.indexOf(Math.max(...most));
        if (!most[k]) continue;
        const weight = Math.min(1, (2.2 * most[k]) / seen) * (chosen === 'all' || arms[k] === chosen ? 1 : 0.32);
        picture.data.set([...colours[k], Math.round(255 * weight)], 4 * (y * pixels + x));
      }
    }
    canvas.getContext('2d').putImageData(picture, 0, 0);
  }

  /** The arm nearest to a place of the picture, within some pixels. */
  function armAt(px, py) {
    const per = cells.side / canvas.clientWidth;
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
  canvas.addEventListener('pointermove', (event) => {
    const arm = cells && armAt(event.offsetX, event.offsetY);
    canvas.style.cursor = arm ? 'pointer' : '';
    canvas.title = arm ? `Take the ${arm} arm` : '';
  });
  canvas.addEventListener('click', (event) => {
    const arm = cells && armAt(event.offsetX, event.offsetY);
    if (arm) choose(arm);
  });

  return {
    element,
    show(message) {
      cells = message?.arms ? read(message) : null;
      element.hidden = !cells;
      draw();
    },
    mark(name) {
      branch = name;
      for (const b of buttons) b.setAttribute('aria-pressed', String(b.dataset.arm === name));
      draw();
    },
  };
}
