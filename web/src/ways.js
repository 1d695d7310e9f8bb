// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The buttons over the view: map, first view, panel, keys, picture, dark and light.
import { byId, save } from './elements.js';
import { keysDialog } from './keys.js';

const root = document.documentElement;

function addMapButtons(view) {
  const map = /** @type {HTMLButtonElement} */ (byId('bmap'));
  map.addEventListener('click', () => {
    view.map(!view.onmap);
    map.setAttribute('aria-pressed', String(view.onmap));
  });
  if (view.mode === '2d') map.disabled = true;
  byId('bhome').addEventListener('click', () => (view.onmap && view.mode !== '2d' ? view.map(true) : view.home()));
}

function addPanelButton() {
  byId('bpanel').addEventListener('click', () => {
    const off = root.dataset.panel !== 'off';
    root.dataset.panel = off ? 'off' : 'on';
    byId('bpanel').setAttribute('aria-pressed', String(!off));
  });
}

/** keys: further ones for the list, [[key, what it does], …]. */
function addKeysButton(view, keys) {
  keysDialog(byId('bkeys'), [
    ['drag, arrow keys', view.mode === '2d' ? 'move the map' : 'turn the view'],
    ['Shift with arrow keys', 'move it'],
    ['wheel, + and −', 'zoom'],
    ['M', 'map'],
    ['0', 'first view'],
    ['P', 'read what is in the middle'],
    ['L, X, C, D', 'measure: profile, cross-section, catchment, distance'],
    ['arrows, Enter', 'with such a tool: move the cross-hair, set a point'],
    ['Backspace, Esc', 'take a point back, end the line, close the measurement'],
    ...keys,
    ['?', 'this list'],
  ]);
}

/** Saves the view with what is drawn and written over it. */
function addPictureButton(page) {
  byId('bpicture').addEventListener('click', () => {
    const { data, tools, view } = page;
    view.draw();
    const whole = document.createElement('canvas');
    whole.width = view.canvas.width;
    whole.height = view.canvas.height;
    const pen = whole.getContext('2d');
    pen.drawImage(view.canvas, 0, 0);
    for (const over of [tools.canvas, view.labels.canvas]) pen.drawImage(over, 0, 0, whole.width, whole.height);
    whole.toBlob((blob) => save(blob, data.title, 'png'));
  });
}

/** Gives a function that takes the theme of the system. */
function addThemeButton(view) {
  const dark = matchMedia('(prefers-color-scheme: dark)');
  const choose = (name) => {
    root.dataset.theme = name;
    view.theme(name);
  };
  const follow = () => choose(dark.matches ? 'dark' : 'light');
  dark.addEventListener('change', follow);
  byId('btheme').addEventListener('click', () => choose(root.dataset.theme === 'dark' ? 'light' : 'dark'));
  return follow;
}

/** page: of page.js. Gives {followTheme(): takes the theme of the system}. */
export function addWays(page, keys) {
  addMapButtons(page.view);
  addPanelButton();
  addKeysButton(page.view, keys);
  addPictureButton(page);
  return { followTheme: addThemeButton(page.view) };
}
