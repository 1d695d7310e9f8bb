// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A view of a terrain and its rivers, its controls and its panel. What is shown can be replaced while the page lives.
import { ArcFinder } from './rivers.js';
import { number } from './chart.js';
import { css, modes, orderColours, riverStyle } from './colours.js';
import { save } from './elements.js';
import { keysDialog } from './keys.js';
import { Land } from './land.js';
import { slopes } from './light.js';
import { measuring } from './measure.js';
import { fillPanel, metres, summary } from './panel.js';
import { Tools } from './tools.js';
import { probe, View3d } from './view3d.js';
import { View2d } from './view2d.js';

const $ = (id) => document.getElementById(id);

export function tellAll(words) {
  $('message').textContent = words;
  $('message').hidden = words === '';
}

/** A slider that walks through a list of values. Gives set(values, start), which gives the value nearest to start. */
function slider(id, show, change) {
  const input = $(id);
  let values = [0];
  const tell = () => {
    const value = values[Number(input.value)];
    const text = show(value);
    $(`${id}out`).textContent = text;
    input.setAttribute('aria-valuetext', text);
    return value;
  };
  input.addEventListener('input', () => change(tell()));
  return (list, start) => {
    values = list;
    Object.assign(input, { min: 0, max: values.length - 1, step: 1 });
    input.value = values.reduce((best, v, i) => (Math.abs(v - start) < Math.abs(values[best] - start) ? i : best), 0);
    return tell();
  };
}

function contourSteps(span, asked) {
  const steps = [0];
  for (let power = 10 ** Math.floor(Math.log10(Math.max(span, 1e-6) / 200)); power < span; power *= 10) {
    for (const m of [1, 2, 5]) {
      if (m * power >= span / 120 && m * power <= span) steps.push(Number((m * power).toPrecision(3)));
    }
  }
  if (asked > 0 && !steps.includes(asked)) steps.push(asked);
  return steps.sort((a, b) => a - b);
}

const lifts = [1, 1.25, 1.5, 2, 2.5, 3, 4, 5, 7, 10, 15, 20, 30, 50, 100, 200, 500, 1000];

/** Exaggeration under which the land stands as it does from a hill: about a tenth as high as it is wide. */
function goodExaggeration(land) {
  const extent = Math.max(land.grid.width, land.grid.height) * land.grid.cell_m;
  const wanted = land.max > land.min ? (0.1 * extent) / (land.max - land.min) : 1;
  return lifts.reduce((best, v) => (Math.abs(Math.log(v / wanted)) < Math.abs(Math.log(best / wanted)) ? v : best), 1);
}

/** What stands beside summits and where rivers leave. */
function namesOf(data, rivers, land) {
  const names = data.summits.map(([x, y, z]) => ({ x, y, text: metres(z, land), kind: 'summit' }));
  const ends = [];
  rivers.downstream.forEach((d, k) => d < 0 && ends.push(k));
  const area = rivers.arcs.ds_area;
  ends.sort((a, b) => area[b] - area[a]);
  const outlets = ends.slice(0, 6).filter((k) => area[k] > 0).map((k) => {
    const line = rivers.lines[k];
    return { x: line.at(-2), y: line.at(-1), text: `${number(area[k] / 1e6, 3)} km²`, kind: 'outlet' };
  });
  // The highest summit first, then the two kinds in turn.
  return Array.from({ length: Math.max(names.length, outlets.length) }, (_, i) => [names[i], outlets[i]])
    .flat()
    .filter(Boolean);
}

function makeView(land, rivers, options) {
  const asked = new URLSearchParams(location.search);
  const gl = probe(asked.get('aa') !== '0');
  if (gl && Math.max(land.width, land.height) <= gl.largest) {
    const segments = Math.round(Number(asked.get('seg')));
    try {
      return new View3d(
        $('view'),
        land,
        rivers,
        { segments: segments >= 1 ? Math.min(segments, 2047) : undefined, ...options },
        gl,
      );
    } catch (error) {
      console.info(`no 3-D view: ${error.message}`);
      $('view').replaceChildren();
    }
  }
  return new View2d($('view'), land, rivers, options);
}

/**
 * Shows a scene: {data: the page's JSON, land, rivers, water}. state: what it tells about itself to whoever asks;
 * keys: further ones for the list of keys, [[key, what it does], …].
 * Gives {view, tools, replace(scene, {report: whether to write the report anew}), bindLength(L), scene: the one that is
 * shown}.
 */
export function createPage(first, state, keys = []) {
  let { data, land, rivers, water } = first;
  let scene = first;
  const view = makeView(land, rivers, { lakes: water.lakes, sea: data.sea });
  document.documentElement.dataset.mode = view.mode;
  let finder;
  let names;
  let panel = { hover: () => {} };
  let bound = null; // the recipe's pruning length in the studio
  const actions = {
    flyTo: (x, y) => view.fly(x, y),
    point: (x, y) => {
      view.marks = [[x, y]];
      view.redraw();
    },
    unpoint: () => {
      view.marks = [];
      view.redraw();
    },
  };

  const how = { azimuth: 315, altitude: 40 };
  let interval = 0;
  const setLift = slider('exaggeration', (v) => `× ${number(v)}`, (v) => update({ exaggeration: v }));
  const setContour = slider('contour', (v) => (v > 0 ? `${number(v)} m` : 'none'), (v) => update({}, (interval = v)));
  slider(
    'sun',
    (v) => `${v}° (${'N NE E SE S SW W NW N'.split(' ')[Math.round(v / 45)]})`,
    (v) => update({ azimuth: v }),
  )(
    Array.from({ length: 72 }, (_, i) => 5 * i),
    315,
  );
  slider(
    'altitude',
    (v) => `${v}°`,
    (v) => update({ altitude: v }),
  )(
    Array.from({ length: 17 }, (_, i) => 5 + 5 * i),
    40,
  );
  function update(change) {
    Object.assign(how, change);
    view.look({ ...how, contour: $('show-contours').checked ? interval : 0 });
  }
  $('show-contours').addEventListener('change', () => update({}));
  for (const id of ['show-rivers', 'show-ridges']) $(id).addEventListener('change', () => drawLines());
  $('show-labels').addEventListener('change', () => {
    view.names = $('show-labels').checked ? names : [];
    view.redraw();
  });

  let orders = new Int32Array(0);
  let highest = 0;
  const L = $('L');
  function prune() {
    const length = Number(L.value) <= Number(L.min) && !bound ? data.rivers.prune : Number(L.value);
    const now = rivers.kept(length);
    orders = now.orders;
    highest = Math.max(0, ...orders);
    state.kept = now.kept;
    const along = length * data.grid.cell_m;
    $('Lout').textContent =
      `${number(length)} cells (${along >= 2000 ? `${number(along / 1000, 3)} km` : `${number(along, 3)} m`})`;
    L.setAttribute('aria-valuetext', $('Lout').textContent);
    $('kept').textContent = `${number(now.kept)} of ${number(rivers.count)} links kept, to order ${highest}`;
    drawLines();
    legend();
    measure.changed();
  }
  L.addEventListener('input', () => {
    prune();
    bound?.changing(L.value);
  });
  L.addEventListener('change', () => bound?.changed(L.value));

  let mode = 'height';
  let painted = null;
  let other = null; // heights of another report
  let pinned = -1;
  let drawn = {}; // lines as they are
  /** Rivers by the orders that the slider leaves, or in the colours of an order. */
  function drawLines() {
    const by = modes[mode].lines;
    const styles = Array.from({ length: by === 'hack' ? orderColours.length : highest }, (_, i) => {
      const style = riverStyle(
        by === 'hack' ? orderColours.length - i : i + 1,
        by === 'hack' ? orderColours.length : highest,
      );
      return by ? { ...style, share: Math.min(i, orderColours.length - 1) } : style;
    });
    const shown = $('show-rivers').checked
      ? by === 'hack'
        ? orders.map((o, k) => (o > 0 ? rivers.arcs.hack[k] : 0))
        : orders
      : new Int32Array(rivers.count);
    const marked = pinned >= 0 && orders[pinned] > 0 ? rivers.path(pinned).map((k) => rivers.lines[k]) : [];
    const { grid } = data;
    const what = [shown.join(), mode, highest, $('show-ridges').checked, pinned, grid.width, grid.height].join(' ');
    if (rivers === drawn.rivers && what === drawn.what) return;
    drawn = { rivers, what };
    view.showLines({
      orders: shown,
      styles,
      ridges: $('show-ridges').checked,
      marked,
      byClass: Boolean(by),
      colours: orderColours,
    });
  }
  const can = (name) =>
    ({ water: water.known, rivers: rivers.count > 0, other: !land.level })[modes[name].needs] ?? true;
  /** Paints the land by the mode that is chosen, or plainly while the land or its water is not known. */
  function paint() {
    const name = land.level
      ? 'none'
      : can(mode) && (mode !== 'difference' || other?.length === land.z.length)
        ? mode
        : 'height';
    painted = modes[name].make({
      land,
      water,
      other,
      slope: view.ground?.slope ?? slopes(land),
      metres: (z) => metres(z, land),
    });
    view.paint(painted);
  }
  function colour(name) {
    mode = name;
    paint();
    drawLines();
    legend();
  }
  const select = $('colour');
  /** The ways to colour this land, and the one that is chosen even where its water is yet to come. */
  function offer() {
    const names_ = Object.keys(modes).filter((name) => can(name) || name === mode);
    if (names_.join() === Array.from(select.options, (o) => o.value).join()) return;
    select.replaceChildren(
      ...names_.map((name) =>
        Object.assign(document.createElement('option'), { value: name, textContent: modes[name].label }),
      ),
    );
    select.value = mode;
  }
  select.addEventListener('change', () => {
    if (select.value === 'difference') $('other').click();
    else colour(select.value);
    if (select.value === 'difference') select.value = mode;
  });
  $('other').addEventListener('change', async () => {
    const [file] = $('other').files;
    $('other').value = '';
    if (!file) return;
    try {
      other = heightsOf(await file.text(), land);
      tellAll('');
      select.value = 'difference';
      colour('difference');
    } catch (error) {
      tellAll(`${file.name}: ${error.message}`);
    }
  });

  function legend() {
    const box = $('legend');
    box.replaceChildren();
    const by = modes[mode].lines;
    const entries = [];
    if (rivers.count && highest) {
      const most = by === 'hack' ? Math.min(orderColours.length, Math.max(...rivers.arcs.hack)) : highest;
      const row = Object.assign(document.createElement('div'), { className: 'orders' });
      row.append(by === 'hack' ? 'Hack order ' : 'Strahler order ');
      for (let order = 1; order <= most; ++order) {
        const { width, colour: blue } = riverStyle(by === 'hack' ? most - order + 1 : order, most);
        const item = document.createElement('span');
        const line = Object.assign(document.createElement('i'), { className: 'river' });
        line.style.height = `${Math.max(2, width)}px`;
        line.style.background = css(by ? orderColours[Math.min(order, orderColours.length) - 1] : blue);
        item.append(line, String(order));
        row.append(item);
      }
      entries.push(row);
    }
    const shown = painted?.legend;
    if (shown?.ramp && land.max > land.min && !land.level) {
      const ramp = Object.assign(document.createElement('div'), { className: 'ramp' });
      const bar = document.createElement('i');
      bar.style.background = `linear-gradient(to right, ${shown.ramp.map(css).join(', ')})`;
      ramp.append(shown.from, bar, shown.to);
      entries.push(ramp);
    }
    if (shown?.entries) {
      const row = Object.assign(document.createElement('div'), { className: 'classes' });
      for (const [name, c] of shown.entries) {
        const item = document.createElement('span');
        const square = document.createElement('i');
        square.style.background = css(c);
        item.append(square, name);
        row.append(item);
      }
      entries.push(row);
    }
    box.replaceChildren(...entries);
  }

  function pick(px, py) {
    const at = view.under(px, py);
    if (!at) return null;
    const { grid } = data;
    const arc = finder.nearest(at.x, at.y, Math.max(1.5, 7 * view.cellsPerPixel), orders);
    const col = Math.min(Math.floor(at.x), grid.width - 1);
    const row = Math.min(Math.floor(at.y), grid.height - 1);
    return {
      col,
      row,
      px: at.x,
      py: at.y,
      x: grid.west + at.x * grid.cell_m,
      y: grid.north - at.y * grid.cell_m,
      z: land.known(Math.min(at.x, grid.width - 1e-6), Math.min(at.y, grid.height - 1e-6))
        ? land.heightAt(at.x, at.y)
        : null,
      arc:
        arc < 0
          ? null
          : Object.fromEntries(
              Object.entries(rivers.arcs)
                .filter(([key]) => key !== 'n')
                .map(([key, column]) => [key, column[arc]]),
            ),
      number: arc,
    };
  }
  /** Slope, aspect, drained area and distance to the outlet of a cell, for a place that was asked for by a click. */
  function more(found) {
    if (found.z === null) return [];
    const { east, south } = view.ground?.slope ?? slopes(land);
    const i =
      Math.min(Math.floor(found.row / land.cells), land.height - 1) * land.width +
      Math.min(Math.floor(found.col / land.cells), land.width - 1);
    const steep = (Math.atan(Math.hypot(east[i], south[i])) * 180) / Math.PI;
    const facing = ((Math.atan2(-east[i], south[i]) * 180) / Math.PI + 360) % 360;
    const words = [
      `slope ${steep.toFixed(1)}°` +
        (steep > 0.05 ? ` facing ${'N NE E SE S SW W NW N'.split(' ')[Math.round(facing / 45)]}` : ''),
    ];
    if (water.known) {
      const cell = data.grid.cell_m;
      words.push(
        `drains ${number((water.areas[i] * cell * cell) / 1e6, 3)} km²`,
        `${number((water.distances[i] * cell) / 1000, 3)} km to the outlet`,
      );
    }
    return [words.join(' · ')];
  }
  function tell(found, all) {
    if (!found) {
      $('point').textContent = '';
      return;
    }
    const lines = [`${found.x.toFixed(1)}, ${found.y.toFixed(1)} · cell ${found.col}, ${found.row}` +
      (found.z !== null ? ` · ${found.z.toFixed(1)} m` : data.sea && land.has ? ' · sea' : '')];
    if (all) lines.push(...more(found));
    if (found.arc) {
      const a = found.arc;
      lines.push(
        `arc ${a.id}: order ${a.strahler} (Shreve ${a.shreve}, Hack ${a.hack}), ${number(a.length)} m, ` +
          `${number(a.z_up)} → ${number(a.z_down)} m, drains ${number(a.ds_area / 1e6)} km²`,
        a.survives === null
          ? 'never pruned'
          : `pruned at L > ${number(a.survives)} cells` + (a.ds ? `, flows into arc ${a.ds}` : ', ends at the outlet'),
      );
    }
    $('point').replaceChildren(
      ...lines.map((text) => Object.assign(document.createElement('div'), { textContent: text })),
    );
  }
  function ask(px, py) {
    const found = pick(px, py);
    pinned = found?.number ?? -1;
    drawLines();
    tell(found, true);
  }
  $('point').removeAttribute('aria-live'); // hovering would never let a reader speak: see the key P
  let pressed = null;
  let moved = null;
  view.canvas.addEventListener('pointermove', (event) => {
    if (event.buttons !== 0 || moved) return;
    const { offsetX, offsetY } = event;
    moved = requestAnimationFrame(() => {
      moved = null;
      const found = pick(offsetX, offsetY);
      tell(found);
      measure.hover(found && { x: found.px, y: found.py });
      if (found && found.number >= 0) panel.hover(found.px, found.py, found.number);
      else panel.hover(null, null, -1);
    });
  });
  view.canvas.addEventListener('pointerleave', () => {
    if (moved) cancelAnimationFrame(moved);
    moved = null;
    tell(null);
    measure.hover(null);
    panel.hover(null, null, -1);
  });
  view.canvas.addEventListener('pointerdown', (event) => (pressed = [event.offsetX, event.offsetY]));
  view.canvas.addEventListener('pointerup', (event) => {
    if (!pressed || Math.hypot(event.offsetX - pressed[0], event.offsetY - pressed[1]) > 4) return;
    ask(event.offsetX, event.offsetY);
  });

  view.canvas.tabIndex = 0;
  view.canvas.setAttribute('role', 'application');
  view.canvas.setAttribute(
    'aria-label',
    `${view.mode === '2d' ? 'Map' : '3-D view'} of the terrain and its rivers. Arrow keys turn the view, ` +
      'with Shift they move it; plus and minus zoom; M shows the map; P reads what is in the middle; ' +
      '0 returns to the first view.',
  );
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
      ask(view.canvas.clientWidth / 2, view.canvas.clientHeight / 2);
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
  $('bpanel').addEventListener('click', () => {
    const off = document.documentElement.dataset.panel !== 'off';
    document.documentElement.dataset.panel = off ? 'off' : 'on';
    $('bpanel').setAttribute('aria-pressed', String(!off));
  });
  keysDialog($('bkeys'), [
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
  $('bpicture').addEventListener('click', () => {
    view.draw();
    const whole = document.createElement('canvas');
    whole.width = view.canvas.width;
    whole.height = view.canvas.height;
    const pen = whole.getContext('2d');
    pen.drawImage(view.canvas, 0, 0);
    for (const over of [tools.canvas, view.labels.canvas]) pen.drawImage(over, 0, 0, whole.width, whole.height);
    whole.toBlob((blob) => save(blob, data.title, 'png'));
  });
  const dark = matchMedia('(prefers-color-scheme: dark)');
  const theme = (name) => {
    document.documentElement.dataset.theme = name;
    view.theme(name);
  };
  dark.addEventListener('change', () => theme(dark.matches ? 'dark' : 'light'));
  $('btheme').addEventListener('click', () =>
    theme(document.documentElement.dataset.theme === 'dark' ? 'light' : 'dark'),
  );

  view.ondraw = (turn) => ($('north').style.transform = `rotate(${turn}rad)`);
  const tools = new Tools(view);
  const measure = measuring({ view, tools, here: () => ({ data, land, rivers, water, orders, finder }) });
  // Labels keep out from under what lies over the view.
  view.keepOut = () => {
    const frame = $('view').getBoundingClientRect();
    return ['ways', 'north', 'point', 'doing', 'toolbar', 'inspector', 'measure']
      .flatMap((id) => $(id)?.getBoundingClientRect() ?? [])
      .filter((b) => b.width > 0)
      .map((b) => ({
        x0: b.left - frame.left - 2,
        x1: b.right - frame.left + 2,
        y0: b.top - frame.top - 2,
        y1: b.bottom - frame.top + 2,
      }));
  };
  view.onlost = () => tellAll('The graphics device was lost; the view returns when the browser gives it back.');
  view.onfound = () => tellAll('');

  /** Everything on the page that depends on what is shown. */
  function fill(afresh) {
    finder = new ArcFinder(rivers, data.grid);
    names = namesOf(data, rivers, land);
    pinned = -1;
    document.title = data.title;
    $('title').textContent = data.title;
    $('summary').textContent = summary(data, rivers);
    $('foot').textContent = `thalweg ${data.version}` + (data.recipe ? `, seed ${data.seed}` : '');
    // Under slopes too gentle to be seen the shade of the map is deepened, as on the printed one.
    how.shadeGain = Math.min(12, Math.max(1, 0.5 / Math.max(1e-6, land.steepness())));
    if (afresh) {
      how.exaggeration = setLift(lifts, goodExaggeration(land));
      interval = data.contour_m;
    }
    interval = setContour(contourSteps(land.max - land.min, interval), interval);
    view.names = $('show-labels').checked ? names : [];
    $('field-L').hidden = rivers.count === 0 && !bound;
    $('show-rivers').parentElement.hidden = rivers.count === 0;
    $('label-ridges').hidden = rivers.ridges.length === 0;
    for (const id of ['exaggeration', 'contour', 'sun', 'altitude', 'show-contours', 'colour']) {
      $(id).disabled = land.level;
    }
    $('exaggeration').disabled ||= view.mode === '2d';
    offer();
    state.water = water;
    // Beyond 160 cells there is always room on the slider; past the longest stream nothing changes any more.
    const least = bound ? bound.least : Math.floor(data.rivers.prune);
    const most = Math.max(least + 1, 160, Math.ceil(rivers.longest) + 1, bound ? Number(L.value) : 0);
    Object.assign(L, { min: least, max: most, disabled: rivers.count === 0 && !bound });
    if (!bound) L.value = least;
  }
  function fillReport() {
    for (const id of ['verdict', 'ledger', 'sections']) $(id).replaceChildren();
    panel = fillPanel({ verdict: $('verdict'), ledger: $('ledger'), sections: $('sections') }, data, actions);
  }

  fill(true);
  fillReport();
  theme(dark.matches ? 'dark' : 'light');
  update({});
  paint();
  prune();
  view.home();
  new ResizeObserver(() => view.resize()).observe($('view'));

  /**
   * Shows another scene from where the view stands; heights, contours, colours and light stay as they are chosen. home:
   * land that comes or goes is looked at afresh.
   */
  function replace(next, { report = true, home = true } = {}) {
    const before = scene;
    scene = next;
    ({ data, land, rivers, water } = next);
    if (report && land === before.land && rivers === before.rivers && water === before.water) {
      const written = JSON.stringify(names);
      fill(false);
      fillReport();
      if (JSON.stringify(names) !== written) view.redraw();
      return;
    }
    const sameFrame = ['width', 'height', 'cell_m'].every((key) => before.data.grid[key] === data.grid[key]);
    const afresh = before.land.level !== land.level || !sameFrame;
    view.marks = [];
    view.replace(land, rivers, { lakes: water.lakes, sea: data.sea });
    fill(afresh);
    if (report) fillReport();
    paint();
    update({});
    prune();
    if (afresh && (home || !sameFrame)) view.home();
  }

  Object.assign(state, {
    mode: view.mode,
    pick,
    /** The heights of the page [m], row-major, NaN where there are none. */
    heights: () => Float32Array.from(land.z, (z, i) => (land.has && !land.has[i] ? NaN : z)),
    /** Strahler orders of the arcs as pruned now, 0 for those that are gone. */
    orders: () => Array.from(orders),
    /** What is written over the view: {text, kind, x0, y0, x1, y1} [pixels]. */
    labels: () => view.labels.boxes,
    /** The contours drawn now: {step, index: of the labelled ones} [m], 0: none. */
    contours: () => view.drawn ?? { step: view.contour, index: 5 * view.contour },
    /** A place [cells] on the view [pixels], or null. */
    project: (x, y) => view.project(x, y),
    /** What is measured now, or null (docs/report_page.md). */
    measured: () => measure.result(),
    /** When the view rests. */
    still: () => view.still?.(),
    ready: true,
  });
  return {
    view,
    tools,
    replace,
    get scene() {
      return scene;
    },
    /** Binds the pruning length to a recipe: {least, changing(value), changed(value)}; null: to the page alone. */
    bindLength(length, value) {
      bound = length;
      if (value !== undefined) L.value = value;
      fill(false);
      prune();
    },
  };
}

/** Heights of another report page as they lie on this one's raster. Throws when it is none, or of another grid. */
function heightsOf(html, land) {
  const page = new DOMParser().parseFromString(html, 'text/html');
  const text = (id) => page.getElementById(id)?.textContent;
  if (!text('data')) throw new Error('this is not a report page of thalweg');
  const data = JSON.parse(text('data'));
  const there = new Land(data.grid, data.heights, text('heights') ?? '', data.sea ?? null);
  const same =
    ['width', 'height', 'cell_m', 'west', 'north'].every((key) => data.grid[key] === land.grid[key]) &&
    there.width === land.width;
  if (!same || there.level) throw new Error('it shows another grid: a difference needs the same cells');
  return there.z;
}
