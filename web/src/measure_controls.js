// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What can be done with a measurement: its buttons, and the slider of a section's width.
import { button, make, save } from './elements.js';
import { far } from './measurements.js';
import { room } from './survey.js';

/** Gives the section that is held other lengths to its left and right [cells], as far as the land goes. */
export function widen(measuring, left, right) {
  const { page, shape } = measuring;
  const within = (length, side) => {
    const most = room(page.land, shape.x, shape.y, side * shape.ux, side * shape.uy);
    return Math.min(Math.max(length, 2), Math.max(2, most));
  };
  Object.assign(shape, { left: within(left, -1), right: within(right, 1) });
  shape.onwiden?.();
  measuring.renew();
}

/** A slider of the width of the section that is held. */
function widthSlider(measuring) {
  const { page, shape } = measuring;
  const { width, height, cell_m } = page.land.grid;
  const max = Math.ceil(0.6 * Math.max(width, height));
  const slider = make('input', { type: 'range', id: 'section-width', min: 4, max, step: 'any' });
  const out = make('output');
  shape.onwiden = () => {
    slider.value = shape.left + shape.right;
    out.textContent = far((shape.left + shape.right) * cell_m);
    slider.setAttribute('aria-valuetext', out.textContent);
  };
  slider.addEventListener('input', () => {
    const by = Number(slider.value) / (shape.left + shape.right);
    widen(measuring, shape.left * by, shape.right * by);
  });
  shape.onwiden();
  const label = make('label', { htmlFor: 'section-width', textContent: 'Width' });
  return make('div', { className: 'field' }, label, out, slider);
}

/** Buttons that save what was found. */
function saveButtons(measuring) {
  return measuring.found.saves.map(([label, name, ending], i) => {
    const write = () => {
      const text = measuring.found.saves[i][3](); // as it is measured by then
      save(new Blob([text], { type: 'text/csv' }), `${measuring.page.data.title} ${name}`, ending);
    };
    return button(label, `Save as ${ending.toUpperCase()}`, write);
  });
}

/** What can be done with what is held; made once for each measurement, as a slider is held while it changes. */
export function controlsOf(measuring) {
  const { shape } = measuring;
  if (shape.kind === 'section') return [widthSlider(measuring), ...saveButtons(measuring)];
  if (!shape.drawing) return saveButtons(measuring);
  return [
    button('Done', 'Enter', () => measuring.finish()),
    button('Take back', 'Backspace', () => measuring.takeBack()),
  ];
}
