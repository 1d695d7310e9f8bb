// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The page: what is packed in it, a view of it, and the controls.
import './style.css';
import { Land } from './land.js';
import { ArcFinder, Rivers } from './rivers.js';
import { number } from './chart.js';
import { css, riverStyle, tints } from './colours.js';
import { fillReport, metres, summary } from './report.js';
import { probe, View3d } from './view3d.js';
import { View2d } from './view2d.js';

const $ = (id) => document.getElementById(id);
const state = (window.__thalweg = { ready: false, mode: null, error: null, kept: 0, pick: () => null });

function fail(error) {
  state.error = String(error?.message ?? error);
  $('message').textContent = `This page cannot be shown: ${state.error}`;
  $('message').hidden = false;
}

/** Values that a slider walks through: 1, 2, 5, 10, … or a list. */
function slider(id, values, start, show, change) {
  const input = $(id);
  Object.assign(input, { min: 0, max: values.length - 1, step: 1 });
  input.value = values.reduce((best, v, i) => (Math.abs(v - start) < Math.abs(values[best] - start) ? i : best), 0);
  const tell = () => {
    const value = values[Number(input.value)];
    const text = show(value);
    $(`${id}out`).textContent = text;
    input.setAttribute('aria-valuetext', text);
    return value;
  };
  input.addEventListener('input', () => change(tell()));
  return tell();
}

function contourSteps(span, asked) {
  const steps = [0];
  for (let power = 10 ** Math.floor(Math.log10(Math.max(span, 1e-6) / 200)); power < span; power *= 10) {
    for (const m of [1, 2, 5]) if (m * power >= span / 120 && m * power <= span) steps.push(Number((m * power).toPrecision(3)));
  }
  if (asked > 0 && !steps.includes(asked)) steps.push(asked);
  return steps.sort((a, b) => a - b);
}

/** Exaggeration under which the land stands out: about an eighth as high as it is wide. */
function goodExaggeration(land) {
  const extent = Math.max(land.grid.width, land.grid.height) * land.grid.cell_m;
  const wanted = land.max > land.min ? (0.13 * extent) / (land.max - land.min) : 1;
  return lifts.reduce((best, v) => (Math.abs(Math.log(v / wanted)) < Math.abs(Math.log(best / wanted)) ? v : best), 1);
}
const lifts = [0.2, 0.5, 1, 1.5, 2, 3, 4, 5, 7, 10, 15, 20, 30, 50, 100, 200, 500, 1000];

function start() {
  const data = JSON.parse($('data').textContent);
  document.title = data.title;
  $('title').textContent = data.title;
  const land = new Land(data.grid, data.heights, $('heights').textContent);
  const rivers = new Rivers(data.rivers, data.ridges, $('lines').textContent);
  $('summary').textContent = summary(data, rivers);
  fillReport($('sections'), data);
  $('foot').textContent = `thalweg ${data.version}` + (data.recipe ? `, seed ${data.seed}` : '');

  const asked = new URLSearchParams(location.search);
  const gl = probe();
  let view = null;
  if (gl && Math.max(land.width, land.height) <= gl.largest) {
    const segments = Math.round(Number(asked.get('seg')));
    try {
      view = new View3d($('view'), land, rivers, { antialias: asked.get('aa') !== '0', segments: segments >= 1 ? Math.min(segments, 2047) : undefined }, gl);
    } catch (error) {
      console.info(`no 3-D view: ${error.message}`);
      $('view').replaceChildren();
    }
  }
  view ??= new View2d($('view'), land, rivers);
  document.documentElement.dataset.mode = view.mode;
  const finder = new ArcFinder(rivers, data.grid);

  // Under slopes too gentle to be seen the shade is deepened, as on the printed map.
  const depth = Math.min(12, Math.max(1, 0.5 / Math.max(1e-6, land.steepness())));
  const how = { azimuth: 315, altitude: 45, tint: true, ridges: true, shadeGain: depth };
  how.exaggeration = slider('exaggeration', lifts, goodExaggeration(land), (v) => number(v), (v) => update({ exaggeration: v }));
  let interval = slider('contour', contourSteps(land.max - land.min, data.contour_m), data.contour_m,
    (v) => (v > 0 ? `${number(v)} m` : 'none'), (v) => update({}, (interval = v)));
  slider('sun', Array.from({ length: 72 }, (_, i) => 5 * i), 315, (v) => `${v}° (${'N NE E SE S SW W NW N'.split(' ')[Math.round(v / 45)]})`, (v) => update({ azimuth: v }));
  slider('altitude', Array.from({ length: 16 }, (_, i) => 10 + 5 * i), 45, (v) => `${v}°`, (v) => update({ altitude: v }));
  function update(change) {
    Object.assign(how, change);
    view.look({ ...how, contour: $('show-contours').checked ? interval : 0, tint: $('show-tint').checked, ridges: $('show-ridges').checked });
  }
  for (const id of ['show-contours', 'show-tint', 'show-ridges']) $(id).addEventListener('change', () => update({}));
  $('show-rivers').addEventListener('change', () => prune());
  $('field-L').hidden = rivers.count === 0;
  $('show-rivers').parentElement.hidden = rivers.count === 0;
  $('label-ridges').hidden = rivers.ridges.length === 0;
  if (land.level) for (const id of ['exaggeration', 'contour', 'sun', 'altitude', 'show-contours', 'show-tint']) $(id).disabled = true;
  $('exaggeration').disabled ||= view.mode === '2d';

  let orders = new Int32Array(rivers.count);
  const L = $('L');
  const least = Math.floor(data.rivers.prune);
  // Beyond 160 cells there is always room on the slider; past the longest stream nothing changes any more.
  Object.assign(L, { min: least, max: Math.max(least + 1, 160, Math.ceil(rivers.longest) + 1), value: least, disabled: rivers.count === 0 });
  function prune() {
    const length = Number(L.value) <= least ? data.rivers.prune : Number(L.value);
    const now = rivers.kept(length);
    orders = now.orders;
    const highest = Math.max(0, ...orders);
    state.kept = now.kept;
    const metres = length * data.grid.cell_m;
    $('Lout').textContent = `${number(length)} cells (${metres >= 2000 ? `${number(metres / 1000, 3)} km` : `${number(metres, 3)} m`})`;
    L.setAttribute('aria-valuetext', $('Lout').textContent);
    $('kept').textContent = `${number(now.kept)} of ${number(rivers.count)} links kept, to order ${highest}`;
    legend(highest, land);
    view.showRivers($('show-rivers').checked ? orders : new Int32Array(rivers.count), highest);
    mark(pinned);
  }
  L.addEventListener('input', prune);

  let pinned = -1;
  function mark(arc) {
    const shown = arc >= 0 && orders[arc] > 0 ? arc : -1;
    view.mark(shown >= 0 ? rivers.path(shown).map((k) => rivers.lines[k]) : []);
    return shown;
  }
  function pick(px, py) {
    const at = view.under(px, py);
    if (!at) return null;
    const { grid } = data;
    const arc = finder.nearest(at.x, at.y, Math.max(1.5, 7 * view.cellsPerPixel), orders);
    return {
      col: Math.min(Math.floor(at.x), grid.width - 1), row: Math.min(Math.floor(at.y), grid.height - 1),
      x: grid.west + at.x * grid.cell_m, y: grid.north - at.y * grid.cell_m,
      z: land.known(Math.min(at.x, grid.width - 1e-6), Math.min(at.y, grid.height - 1e-6)) ? land.heightAt(at.x, at.y) : null,
      arc: arc < 0 ? null : Object.fromEntries(Object.entries(rivers.arcs).filter(([key]) => key !== 'n').map(([key, column]) => [key, column[arc]])),
      number: arc,
    };
  }
  function tell(found) {
    if (!found) {
      $('point').textContent = '';
      return;
    }
    const lines = [`${found.x.toFixed(1)}, ${found.y.toFixed(1)} · cell ${found.col}, ${found.row}` + (found.z === null ? '' : ` · ${found.z.toFixed(1)} m`)];
    if (found.arc) {
      const a = found.arc;
      lines.push(`arc ${a.id}: order ${a.strahler} (Shreve ${a.shreve}, Hack ${a.hack}), ${number(a.length)} m, ${number(a.z_up)} → ${number(a.z_down)} m, drains ${number(a.ds_area / 1e6)} km²`,
        a.survives === null ? 'never pruned' : `pruned at L > ${number(a.survives)} cells` + (a.ds ? `, flows into arc ${a.ds}` : ', ends at the outlet'));
    }
    $('point').replaceChildren(...lines.map((text) => Object.assign(document.createElement('div'), { textContent: text })));
  }
  $('point').removeAttribute('aria-live'); // hovering would never let a reader speak: see the key P
  let pressed = null;
  view.canvas.addEventListener('pointermove', (event) => {
    if (event.buttons === 0) tell(pick(event.offsetX, event.offsetY));
  });
  view.canvas.addEventListener('pointerleave', () => tell(null));
  view.canvas.addEventListener('pointerdown', (event) => (pressed = [event.offsetX, event.offsetY]));
  view.canvas.addEventListener('pointerup', (event) => {
    if (!pressed || Math.hypot(event.offsetX - pressed[0], event.offsetY - pressed[1]) > 4) return;
    const found = pick(event.offsetX, event.offsetY);
    pinned = found?.number ?? -1;
    mark(pinned);
    tell(found);
  });

  view.canvas.tabIndex = 0;
  view.canvas.setAttribute('role', 'application');
  view.canvas.setAttribute('aria-label', `${view.mode === '2d' ? 'Map' : '3-D view'} of the terrain and its rivers. Arrow keys turn the view, with Shift they move it; plus and minus zoom; M shows the map; P reads what is in the middle; 0 returns to the first view.`);
  view.canvas.addEventListener('keydown', (event) => {
    const by = event.shiftKey || view.onmap
      ? { ArrowLeft: { right: -0.1 }, ArrowRight: { right: 0.1 }, ArrowUp: { up: 0.1 }, ArrowDown: { up: -0.1 } }
      : { ArrowLeft: { turn: -0.1 }, ArrowRight: { turn: 0.1 }, ArrowUp: { tip: -0.08 }, ArrowDown: { tip: 0.08 } };
    const zoom = { '+': 1.2, '=': 1.2, '-': 1 / 1.2, _: 1 / 1.2 }[event.key];
    if (by[event.key]) view.move(by[event.key]);
    else if (zoom) view.move({ zoom });
    else if (event.key === 'm' || event.key === 'M') $('bmap').click();
    else if (event.key === '0') $('bhome').click();
    else if (event.key === 'p' || event.key === 'P') {
      $('point').setAttribute('aria-live', 'polite');
      const found = pick(view.canvas.clientWidth / 2, view.canvas.clientHeight / 2);
      pinned = found?.number ?? -1;
      mark(pinned);
      tell(found);
    } else return;
    event.preventDefault();
  });

  $('bmap').addEventListener('click', () => {
    const on = !view.onmap;
    view.map(on);
    $('bmap').setAttribute('aria-pressed', String(on));
  });
  if (view.mode === '2d') $('bmap').disabled = true;
  $('bhome').addEventListener('click', () => (view.onmap && view.mode !== '2d' ? view.map(true) : view.home()));
  $('bpicture').addEventListener('click', () => {
    view.draw();
    view.canvas.toBlob((blob) => {
      const link = Object.assign(document.createElement('a'), { href: URL.createObjectURL(blob), download: `${data.title.replace(/[^\p{L}\p{N}]+/gu, '-').replace(/^-|-$/g, '') || 'thalweg'}.png` });
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 10000);
    });
  });
  const dark = matchMedia('(prefers-color-scheme: dark)');
  const theme = (name) => {
    document.documentElement.dataset.theme = name;
    view.background(name === 'dark' ? [24, 27, 31] : [236, 236, 232]);
  };
  dark.addEventListener('change', () => theme(dark.matches ? 'dark' : 'light'));
  $('btheme').addEventListener('click', () => theme(document.documentElement.dataset.theme === 'dark' ? 'light' : 'dark'));

  view.ondraw = (turn) => ($('north').style.transform = `rotate(${turn}rad)`);
  view.onlost = () => fail('the graphics device was lost; load the page again');
  theme(dark.matches ? 'dark' : 'light');
  update({});
  view.home();
  prune();
  new ResizeObserver(() => view.resize()).observe($('view'));
  view.draw();
  Object.assign(state, {
    mode: view.mode,
    pick,
    /** The heights of the page [m], row-major, NaN where there are none. */
    heights: () => Float32Array.from(land.z, (z, i) => (land.has && !land.has[i] ? NaN : z)),
    /** Strahler orders of the arcs as pruned now, 0 for those that are gone. */
    orders: () => Array.from(orders),
    ready: true,
  });
}

function legend(highest, land) {
  const box = $('legend');
  box.replaceChildren();
  for (let order = 1; order <= highest; ++order) {
    const { width, colour } = riverStyle(order, highest);
    const item = document.createElement('span');
    const line = Object.assign(document.createElement('i'), { className: 'river' });
    line.style.height = `${width}px`;
    line.style.background = css(colour);
    item.append(line, String(order));
    box.append(item);
  }
  if (highest) box.prepend('Order ');
  if (!land.level && land.max > land.min) {
    const ramp = Object.assign(document.createElement('div'), { className: 'ramp' });
    const bar = document.createElement('i');
    bar.style.background = `linear-gradient(to right, ${tints.map(css).join(', ')})`;
    ramp.append(metres(land.min, land), bar, `${metres(land.max, land)} m`);
    box.append(ramp);
  }
}

window.addEventListener('error', (event) => fail(event.error ?? event.message));
try {
  start();
} catch (error) {
  fail(error);
  console.error(error);
}
