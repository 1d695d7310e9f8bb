// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Measuring on the land: tools for profiles, sections, catchments and distances, and the card with what they found.
import './measure.css';
import { number, plot } from './chart.js';
import { fold, make, save, table } from './elements.js';
import { typing } from './keys.js';
import { slopes } from './light.js';
import {
  along,
  catchment,
  courseAt,
  crossings,
  fallAt,
  leastReach,
  lengthOf,
  nearestOn,
  networkOf,
  outline,
  riverOf,
  riverProfile,
  room,
  sectionAcross,
  sectionPoints,
  spread,
  sums,
  traverse,
  valley,
  valueOfRiver,
  wkt,
} from './survey.js';

const unit = (value, name) => `${value}\u00a0${name}`;
const far = (m) => (m >= 2000 ? unit(number(m / 1000), 'km') : unit(number(m), 'm'));
const high = (z) => unit(number(Math.round(10 * z) / 10 + 0, 6), 'm'); // no minus before 0
const square = (m2) => (m2 >= 1e5 ? unit(number(m2 / 1e6), 'km²') : unit(number(m2), 'm²'));
const angle = (degrees) =>
  Number.isFinite(degrees) ? `${(Math.round(10 * degrees) / 10 + 0).toFixed(1).replace('-', '\u2212')}°` : '–';
const counted = (n, one, many = `${one}s`) => `${number(n)} ${n === 1 ? one : many}`;
const facts = (rows) =>
  make(
    'dl',
    {},
    ...rows.flatMap(([name, value]) => [make('dt', { textContent: name }), make('dd', { textContent: value })]),
  );
const ink = '#d95f02';
const paper = 'rgb(255 255 252 / 0.9)';

// ── What each kind of measurement finds. A result: {title, sentence: for who does not see it, figures: for scripts,
// line: what is drawn, content: nodes of the card, points and chart: of a diagram, saves: [[label, name, ending, text],
// …], inside: part of the land}.

/** Rivers at places of a profile: marks over its line, and a list. */
function riversAlong(points, rivers, { heading, scale }) {
  const spots = rivers.map((river) => ({
    ...river,
    sample: points.reduce((best, p, i) => (Math.abs(p.d - river.d) < Math.abs(points[best].d - river.d) ? i : best), 0),
  }));
  const about = points.length / 200;
  return {
    flags: spots.map(({ d, sample }) => [d / scale.by, points[sample].z]),
    note: (i) => {
      const near = spots.find(({ sample }) => Math.abs(sample - i) <= about);
      return near && `river of order ${near.order}, drains ${square(near.area)}`;
    },
    list: spots.length
      ? fold(
          `${counted(spots.length, 'river')} ${heading}`,
          table(
            ['at', 'order', 'drains'],
            spots.slice(0, 200).map(({ d, order, area }) => [far(d), String(order), square(area)]),
            `Rivers ${heading}`,
          ),
        )
      : null,
  };
}
const scaleOf = (length) => (length >= 2000 ? { by: 1000, unit: 'km' } : { by: 1, unit: 'm' });

function csv(points, data, first = 'distance') {
  const crs = (data.grid.crs.length < 24 ? data.grid.crs : data.grid.crs_name).replace(/[",\n]/g, ' ') || 'm';
  const fixed = (v) => (Number.isFinite(v) ? v.toFixed(3) : '');
  const rows = points.map(({ d, x, y, z }) =>
    [d, data.grid.west + x * data.grid.cell_m, data.grid.north - y * data.grid.cell_m, z].map(fixed).join(','),
  );
  return `${first} [m],x [${crs}],y [${crs}],z [m]\n${rows.join('\n')}\n`;
}

function profileOf({ points: corners }, here) {
  const { data, land } = here;
  if (corners.length < 2) return { title: 'Profile', line: corners };
  const points = along(land, corners);
  const sum = sums(points);
  const scale = scaleOf(sum.length);
  const crossed = crossings(land, corners, here);
  const rivers = riversAlong(points, crossed, { heading: 'crossed', scale });
  const [from, to] = [points[0].z, points.at(-1).z];
  return {
    title: 'Profile',
    line: corners,
    points,
    sentence:
      `Profile of ${far(sum.length)}, ${far(sum.ground)} over the ground: ${high(sum.up)} up and ` +
      `${high(sum.down)} down, at most ${angle(sum.steepest)}, ${counted(crossed.length, 'river')} crossed.`,
    figures: {
      ...sum,
      rivers: crossed.map(({ d, arc, order, area }) => ({ d, arc: data.rivers.arcs.id[arc], order, area })),
    },
    chart: {
      series: { points: points.map(({ d, z }) => [d / scale.by, z]), kind: 'area', name: 'height' },
      what: {
        title: 'Height along the line',
        x: `distance [${scale.unit}]`,
        y: 'height [m]',
        height: 150,
        flags: rivers.flags,
        note: rivers.note,
      },
    },
    content: [
      facts([
        ['length in plan', far(sum.length)],
        ['over the ground', far(sum.ground)],
        ['up, down', `${high(sum.up)}, ${high(sum.down)}`],
        ['from, to', `${high(from)}, ${high(to)}`],
        ['lowest, highest', `${high(sum.low)}, ${high(sum.high)}`],
        ['greatest slope', angle(sum.steepest)],
      ]),
      rivers.list,
      sum.gaps && make('p', { className: 'hint', textContent: 'Where there is no land the ground counts as level.' }),
    ],
    saves: [['CSV', 'profile', 'csv', () => csv(points, data)]],
  };
}

function riverProfileOf(shape, here) {
  const { data, land, rivers, finder, orders } = here;
  const [x, y] = shape.at;
  const arc = finder.nearest(x, y, Math.max(shape.reach, 6), orders);
  if (arc < 0) {
    return { title: 'Profile of a river', line: shape.line ?? [shape.at], missing: 'There is no river here any more.' };
  }
  const river = riverOf(here, arc);
  shape.line = river.line;
  const points = riverProfile(land, river.line);
  const { length, low, high: top } = sums(points);
  const scale = scaleOf(length);
  const joins = river.joins
    .map((join) => ({ ...join, d: length - nearestAlong(river.line, join) * data.grid.cell_m }))
    .sort((a, b) => a.d - b.d);
  const along_ = riversAlong(points, joins, { heading: 'join it', scale });
  const order = Math.max(...river.arcs.map((k) => orders[k]));
  const area = rivers.arcs.ds_area[river.arcs.at(-1)];
  return {
    title: 'Profile of a river',
    line: river.line,
    points,
    sentence:
      `River of order ${order}, ${far(length)} from its source to its outlet, falls ${high(top - low)} and ` +
      `drains ${square(area)}; ${counted(joins.length, 'river joins it', 'rivers join it')}.`,
    figures: { length, fall: top - low, order, area, arcs: river.arcs.map((k) => data.rivers.arcs.id[k]) },
    chart: {
      series: { points: points.map(({ d, z }) => [d / scale.by, z]), kind: 'area', name: 'height' },
      what: {
        title: 'From the outlet up to the farthest source',
        x: `distance from the outlet [${scale.unit}]`,
        y: 'height [m]',
        zeroX: true,
        height: 150,
        flags: along_.flags,
        note: along_.note,
      },
    },
    content: [
      facts([
        ['length', far(length)],
        ['falls', high(top - low)],
        ['mean slope', unit(number((100 * (top - low)) / length, 3), '%')],
        ['order', String(order)],
        ['drains', square(area)],
      ]),
      along_.list,
    ],
    saves: [['CSV', 'river-profile', 'csv', () => csv(points, data, 'distance from the outlet')]],
  };
}
/** How far along a line the nearest place to another is [cells]. */
function nearestAlong(line, { x, y }) {
  const near = nearestOn(line, x, y);
  return lengthOf([...line.slice(0, near.part), [near.x, near.y]]);
}

function sectionOf(shape, { data, land }) {
  const { x, y, ux, uy, left, right, river } = shape;
  const points = sectionPoints(land, shape);
  const line = [[x - left * ux, y - left * uy], [x + right * ux, y + right * uy]];
  const found = valley(land, points);
  const title = 'Cross-section';
  if (!found) return { title, line, points, missing: 'There are no heights here.' };
  const across = found.depth > 0;
  const sideOf = ({ rise, slope, d }) => `${high(rise)} in ${far(Math.abs(d - found.floor.d))}, ${angle(slope)}`;
  const shares = ['¼', '½', '¾', 'all'];
  const whole = points.at(-1).d - points[0].d;
  const scale = scaleOf(whole / 5);
  const flags = [
    [found.left, 'highest ground at the left'],
    [{ d: 0, z: points.find((p) => p.d === 0).z }, river ? 'river' : 'place'],
    [found.right, 'highest ground at the right'],
  ];
  return {
    title,
    line,
    points,
    sentence: across
      ? `Section of ${far(whole)}: ${high(found.depth)} deep below the lower side, ` +
        `${far(found.widths[3].width)} wide there and ${far(found.widths[1].width)} at half the depth; ` +
        `sides of ${angle(found.left.slope)} left and ${angle(found.right.slope)} right.`
      : `Section of ${far(whole)}: the ground does not rise on both sides.`,
    figures: { ...found, width: whole, bearing: ((Math.atan2(ux, -uy) * 180) / Math.PI + 360) % 180 },
    chart: {
      series: { points: points.map(({ d, z }) => [d / scale.by, z]), kind: 'area', name: 'height' },
      what: {
        title: 'Left and right as seen looking downstream',
        x: `distance from the ${river ? 'river' : 'place'} [${scale.unit}]`,
        y: 'height [m]',
        height: 150,
        flags: flags.filter(([{ z }]) => Number.isFinite(z)).map(([{ d, z }]) => [d / scale.by, z]),
        note: (i) => flags.find(([{ d }]) => Math.abs(d - points[i].d) < whole / 300)?.[1],
      },
    },
    content: [
      facts([
        ['floor', high(found.floor.z)],
        ...(across ? [['depth to the lower side', high(found.depth)]] : []),
        ['left side', sideOf(found.left)],
        ['right side', sideOf(found.right)],
        ...(across ? [['area below the lower side', square(found.area)]] : []),
      ]),
      across
        ? table(
            ['share of the depth', 'above the floor', 'width'],
            found.widths.map(({ height, width }, i) => [shares[i], high(height), far(width)]),
            'Widths of the valley',
          )
        : make('p', { className: 'hint', textContent: 'The ground does not rise on both sides: no depth or width.' }),
    ],
    saves: [['CSV', 'section', 'csv', () => csv(points, data, 'distance to the right')]],
  };
}

function catchmentOf(shape, here) {
  const { data, land, rivers, water, finder, orders, slope } = here;
  const title = 'Catchment';
  if (!water.known) return { title, line: [], missing: 'The ways of the water are still being computed.' };
  const [x, y] = shape.at;
  const arc = finder.nearest(x, y, Math.max(shape.reach, 1), orders);
  const column = Math.min(Math.floor(x / land.cells), land.width - 1);
  const value =
    arc >= 0
      ? valueOfRiver(land, water, rivers, arc, x, y)
      : Math.min(Math.floor(y / land.cells), land.height - 1) * land.width + column;
  const line = [[((value % land.width) + 0.5) * land.cells, (Math.floor(value / land.width) + 0.5) * land.cells]];
  if (land.has && !land.has[value]) return { title, line, missing: 'There is no land here.' };
  const found = catchment(land, water, value, slope());
  const network = networkOf(here, found, arc);
  const percent = unit(number(100 * found.share, 3), '%');
  const { inside, ...figures } = found;
  const crs = data.grid.crs;
  const words = (text) => `"${text.replace(/"/g, '""')}"`;
  return {
    title,
    line,
    inside,
    sentence:
      `Catchment of ${square(found.area)}, ${percent} of the land: mean height ${high(found.mean)}, ` +
      `highest ${high(found.high)}, mean slope ${angle(found.slope)}, longest way of water ${far(found.longest)}, ` +
      `${counted(network.arcs, 'arc')} of rivers to order ${network.order}.`,
    figures: { ...figures, ...network, arc: arc >= 0 ? data.rivers.arcs.id[arc] : null },
    content: [
      facts([
        ['area', square(found.area)],
        ['share of the land', percent],
        ['mean height', high(found.mean)],
        ['highest', high(found.high)],
        ['relief', high(found.high - found.low)],
        ['mean slope', angle(found.slope)],
        ['longest way of water', far(found.longest)],
        ['arcs, sources', `${number(network.arcs)}, ${number(network.sources)}`],
        ['highest order', network.order ? String(network.order) : '–'],
      ]),
    ],
    saves: [
      [
        'Outline',
        'catchment',
        'csv',
        () => `WKT,area_m2,crs\n${words(wkt(outline(land, inside), data.grid))},${found.area},${words(crs)}\n`,
      ],
    ],
  };
}

function distanceOf({ points, closed }, { land }) {
  if (points.length < 2) return { title: 'Distance', line: points };
  const found = traverse(land, points, closed);
  const one = found.legs.length === 1 ? found.legs[0] : null;
  const height = [['over the ground', far(found.ground)], ...(closed ? [] : [['height difference', high(found.rise)]])];
  return {
    title: 'Distance',
    line: closed ? [...points, points[0]] : points,
    sentence:
      far(found.length) +
      (land.level ? '' : `, ${far(found.ground)} over the ground`) +
      (land.level || closed ? '' : `, height difference ${high(found.rise)}`) +
      (one ? `, bearing ${angle(one.bearing)}` : ` in ${found.legs.length} legs`) +
      `${closed ? `, encloses ${square(found.area)}` : ''}.`,
    figures: found,
    content: [
      facts([
        ['length in plan', far(found.length)],
        ...(land.level ? [] : height),
        ...(one ? [['bearing from grid north', angle(one.bearing)], ['slope', angle(one.slope)]] : []),
        ...(closed ? [['encloses', square(found.area)]] : []),
      ]),
      !one &&
        table(
          ['leg', 'in plan', 'ground', 'Δ height', 'bearing', 'slope'],
          found.legs.map((leg, i) => [
            String(i + 1),
            far(leg.length),
            far(leg.ground),
            high(leg.rise),
            angle(leg.bearing),
            angle(leg.slope),
          ]),
          'Legs',
        ),
    ],
  };
}

const found = {
  profile: profileOf,
  river: riverProfileOf,
  section: sectionOf,
  catchment: catchmentOf,
  distance: distanceOf,
};

/**
 * Puts the measuring tools on a page. here(): {data, land, rivers, water, orders, finder}, what is shown now.
 * Gives {changed(): what is shown has changed, hover(place or null): the pointer on the land, result()}.
 */
export function measuring({ view, tools, here }) {
  let shape = null; // {kind, grid, drawing, …}: what is measured, on whatever land
  let result = null;
  let read = () => {};
  let mark = null; // place that is read in the diagram
  let cursor = null; // where the next point may come
  let hair = null; // cross-hair of the keyboard
  let help = '';

  // ── The card.
  const title = make('h2');
  const close = make('button', { type: 'button', className: 'close', textContent: '×', title: 'Close (Esc)' });
  close.setAttribute('aria-label', 'Close');
  const hint = make('p', { className: 'hint' });
  const body = make('div');
  const foot = make('div', { className: 'do' });
  const card = make(
    'section',
    { id: 'measure', className: 'report', hidden: true },
    make('header', {}, title, close),
    hint,
    body,
    foot,
  );
  card.setAttribute('aria-label', 'Measurement');
  const spoken = make('p', { className: 'unseen' });
  spoken.setAttribute('role', 'status');
  const stage = view.parent.parentElement;
  const phone = matchMedia('(max-width: 860px)');
  const settle = () => (phone.matches ? stage.after(card) : stage.append(card)); // below a phone's view, over others
  phone.addEventListener('change', settle);
  settle();
  stage.append(spoken);
  close.addEventListener('click', () => {
    drop();
    if (mine()) tools.hold(null);
    view.canvas.focus({ preventScroll: true });
  });

  const mine = () => own.includes(tools.held);
  const context = () => ({ ...here(), slope: () => view.ground?.slope ?? slopes(here().land) });
  let speaking;
  function speak(words) {
    clearTimeout(speaking);
    speaking = setTimeout(() => (spoken.textContent = words), 250);
  }
  function show() {
    card.hidden = !shape && !mine();
    document.documentElement.dataset.measure = card.hidden ? 'off' : 'on';
    hint.textContent = mine() && (!shape || shape.drawing) ? help : '';
    hint.hidden = hint.textContent === '';
    title.textContent = result?.title ?? tools.held?.title ?? '';
    view.redraw(); // names keep out from under the card
  }
  /** Measures again what is held; once: it is told. */
  function renew(tell = true) {
    if (!shape) return;
    const reading = body.contains(document.activeElement) && document.activeElement.closest('.plot');
    const folded = body.querySelector('details')?.open;
    result = { content: [], saves: [], figures: {}, sentence: '', ...found[shape.kind](shape, context()) };
    view.emphasize(result.inside ?? null);
    mark = null;
    read = () => {};
    const parts = [];
    if (result.chart) {
      const { series, what } = result.chart;
      const { points } = result;
      const line = plot([series], { ...what, onread: (i) => point(i === null ? null : points[i]) });
      read = line.read;
      parts.push(line.figure);
    }
    if (result.missing) parts.push(make('p', { className: 'missing', textContent: result.missing }));
    body.replaceChildren(...parts, ...result.content.filter(Boolean));
    if (folded) body.querySelector('details')?.setAttribute('open', '');
    if (reading) body.querySelector('.plot')?.focus();
    if (tell) speak(result.missing ?? result.sentence);
    show();
    tools.draw();
  }
  /** What can be done with a measurement; made once for each, as a slider is held while it changes. */
  function offer() {
    foot.replaceChildren();
    if (shape.kind === 'section') foot.append(widthSlider());
    if (lineTools.some(({ kind }) => kind === shape.kind) && shape.drawing) {
      foot.append(press('Done', 'Enter', finish), press('Take back', 'Backspace', takeBack));
    } else {
      for (const [i, [label, name, ending]] of (result.saves ?? []).entries()) {
        foot.append(
          press(label, `Save as ${ending.toUpperCase()}`, () =>
            save(new Blob([result.saves[i][3]()], { type: 'text/csv' }), `${here().data.title} ${name}`, ending),
          ),
        );
      }
    }
  }
  function press(textContent, hint_, does) {
    const button = make('button', { type: 'button', textContent, title: hint_ });
    button.addEventListener('click', does);
    return button;
  }
  function widthSlider() {
    const { grid } = here().land;
    const slider = make('input', {
      type: 'range',
      id: 'section-width',
      min: 4,
      max: Math.ceil(0.6 * Math.max(grid.width, grid.height)),
      step: 'any',
    });
    const out = make('output');
    const tell = () => {
      slider.value = shape.left + shape.right;
      out.textContent = far((shape.left + shape.right) * grid.cell_m);
      slider.setAttribute('aria-valuetext', out.textContent);
    };
    slider.addEventListener('input', () => {
      const by = Number(slider.value) / (shape.left + shape.right);
      widen(shape.left * by, shape.right * by);
    });
    shape.told = tell;
    tell();
    return make(
      'div',
      { className: 'field' },
      make('label', { htmlFor: 'section-width', textContent: 'Width' }),
      out,
      slider,
    );
  }
  function widen(left, right) {
    const { land } = here();
    const within = (length, sign) =>
      Math.min(Math.max(length, 2), Math.max(2, room(land, shape.x, shape.y, sign * shape.ux, sign * shape.uy)));
    Object.assign(shape, { left: within(left, -1), right: within(right, 1) });
    shape.told?.();
    renew();
  }

  // ── What is held, and how it comes about.
  function take(next) {
    shape = { grid: JSON.stringify(here().data.grid), ...next };
    renew(!shape.drawing);
    offer();
  }
  function drop() {
    shape = result = mark = hair = cursor = null;
    read = () => {};
    body.replaceChildren();
    foot.replaceChildren();
    spoken.textContent = '';
    view.emphasize(null);
    show();
    tools.draw();
  }
  function finish() {
    if (!shape?.drawing) return;
    if (shape.points.length < 2) {
      drop();
      return;
    }
    shape.drawing = false;
    cursor = null;
    renew();
    offer();
    if (document.activeElement === document.body) view.canvas.focus({ preventScroll: true }); // the button has gone
  }
  function takeBack() {
    if (!shape?.drawing) return;
    shape.points.pop();
    if (shape.points.length === 0) drop();
    else renew();
  }
  function point(place) {
    mark = place;
    tools.draw();
  }
  const cells = (pixels) => Math.max(pixels * view.cellsPerPixel, 1.5);
  const touched = (event) => event?.pointerType === 'touch';
  const apart = ([x, y], [u, v]) => {
    const [a, b] = [view.place(x, y), view.place(u, v)];
    return a && b ? Math.hypot(a.x - b.x, a.y - b.y) : Infinity;
  };

  /** A tool of lines: a click, or Enter at the cross-hair, sets a point; one more on the last ends the line. */
  function lineTool({ kind, freehand, closes, start }) {
    let pressed = null; // {x, y, at, free}
    const set = (at, event) => {
      const near = event.type === 'keydown' ? 1.5 : touched(event) ? 18 : 8;
      if (shape?.drawing && shape.kind === kind) {
        const { points } = shape;
        shape.closed = Boolean(closes) && points.length > 2 && apart(points[0], at) < near;
        if (shape.closed || apart(points.at(-1), at) < near) return finish();
        points.push(at);
        renew();
      } else if (!start?.(at, event)) take({ kind, points: [at], drawing: true, closed: false });
      return undefined;
    };
    return {
      kind, set,
      down(at, event) {
        if (!at) return false;
        pressed = { x: event.clientX, y: event.clientY, at: [at.x, at.y], free: false };
        return true;
      },
      move(at, event) {
        if (!pressed || !at || !freehand) return;
        const moved = Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y);
        if (!pressed.free && moved < (touched(event) ? 10 : 5)) return;
        if (!pressed.free && !(shape?.drawing && shape.kind === kind)) {
          take({ kind, points: [pressed.at], drawing: true, closed: false });
        } else if (pressed.free && moved < 4) return;
        Object.assign(pressed, { free: true, x: event.clientX, y: event.clientY });
        shape.points.push([at.x, at.y]);
        shape.freehand = true;
        soon();
      },
      up(_, event) {
        const { free, at } = pressed ?? {};
        pressed = null;
        if (free) finish();
        else if (at) set(at, event);
      },
      cancel() {
        pressed = null;
      },
    };
  }
  let waiting;
  const soon = () => (waiting ??= requestAnimationFrame(() => {
    waiting = undefined;
    if (shape?.drawing) renew(false);
  }));

  const riverAt = (at, pixels) => {
    const { finder, orders } = here();
    return finder.nearest(at[0], at[1], cells(pixels), orders);
  };
  function startOfProfile(at, event) {
    const reach = touched(event) ? 14 : 7; // as the page names what is under the pointer
    if (event?.shiftKey || riverAt(at, reach) < 0) return false;
    take({ kind: 'river', at, reach: cells(reach) });
    return true;
  }
  function takeSection(at, event) {
    const { land, rivers } = here();
    const arc = riverAt(at, touched(event) ? 22 : 12);
    const reach = 5 * land.cells;
    const course = arc >= 0 ? courseAt(riverOf(here(), arc).line, ...at, reach) : fallAt(land, ...at, reach);
    take({
      kind: 'section',
      ...sectionAcross(land, course, leastReach(land, arc >= 0 ? rivers.arcs.ds_area[arc] : 0)),
      river: arc >= 0,
    });
  }
  const takeCatchment = (at, event) => take({ kind: 'catchment', at, reach: cells(touched(event) ? 16 : 8) });

  const lineTools = [
    lineTool({ kind: 'profile', freehand: true, start: startOfProfile }),
    lineTool({ kind: 'distance', closes: true }),
  ];
  let handle = null; // end of the section that is drawn: -1 left, 1 right
  const endOf = (sign) => [
    shape.x + sign * (sign < 0 ? shape.left : shape.right) * shape.ux,
    shape.y + sign * (sign < 0 ? shape.left : shape.right) * shape.uy,
  ];
  const clicked = (set) => ({ set, down: (at) => at !== null, up: (at, event) => at && set([at.x, at.y], event) });
  const sectionTool = {
    ...clicked(takeSection),
    down(at, event) {
      if (!at) return false;
      const frame = view.canvas.getBoundingClientRect();
      const near = (sign) => {
        const p = view.place(...endOf(sign));
        return (
          p !== null &&
          Math.hypot(p.x - event.clientX + frame.left, p.y - event.clientY + frame.top) < (touched(event) ? 24 : 11)
        );
      };
      handle = shape?.kind === 'section' ? [-1, 1].find(near) ?? null : null;
      return true;
    },
    move(at) {
      if (!handle || !at) return;
      const out = handle * ((at.x - shape.x) * shape.ux + (at.y - shape.y) * shape.uy);
      widen(handle < 0 ? out : shape.left, handle > 0 ? out : shape.right);
    },
    up(at, event) {
      if (!handle && at) takeSection([at.x, at.y], event);
      handle = null;
    },
    cancel: () => (handle = null),
  };

  // ── Keys: arrows move a cross-hair, Enter is a click there.
  function step(key, far_) {
    const { grid } = here().data;
    const to = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[key];
    const turn = view.controls?.getAzimuthalAngle() ?? 0;
    const by = 4 * (far_ ? 10 : 1) * view.cellsPerPixel;
    const [right, up] = to.map((v) => v * by);
    const next = {
      x: hair.x + right * Math.cos(turn) - up * Math.sin(turn),
      y: hair.y - right * Math.sin(turn) - up * Math.cos(turn),
    };
    next.x = Math.min(Math.max(next.x, 0), grid.width);
    next.y = Math.min(Math.max(next.y, 0), grid.height);
    const seen = view.place(next.x, next.y);
    if (seen && seen.x >= 0 && seen.y >= 0 && seen.x <= view.parent.clientWidth && seen.y <= view.parent.clientHeight) {
      hair = next;
    }
  }
  function aim() {
    const { grid } = here().data;
    hair ??= view.under(view.parent.clientWidth / 2, view.parent.clientHeight / 2) ?? {
      x: grid.width / 2,
      y: grid.height / 2,
    };
  }
  function key(event) {
    if (event.key === 'Escape' && !event.target.closest?.('dialog')) {
      if (shape?.drawing) finish();
      else if (shape) drop();
      else return false;
      return true;
    }
    if (event.target !== view.canvas) return false;
    if (event.key.startsWith('Arrow')) {
      if (hair) step(event.key, event.shiftKey);
      else aim();
      cursor = [hair.x, hair.y];
      const { land, data } = here();
      const height = land.known(Math.min(hair.x, data.grid.width - 1e-6), Math.min(hair.y, data.grid.height - 1e-6))
        ? `, ${high(land.heightAt(hair.x, hair.y))}`
        : '';
      speak(`cell ${Math.floor(hair.x)}, ${Math.floor(hair.y)}${height}`);
    } else if (event.key === 'Enter') {
      if (hair) tools.held.set([hair.x, hair.y], event);
      else if (shape?.drawing) finish();
      else aim();
    } else if (event.key === 'Backspace') takeBack();
    else return false;
    tools.draw();
    return true;
  }
  window.addEventListener('keydown', (event) => {
    if (
      event.key === 'Escape' &&
      shape &&
      !tools.held &&
      !event.defaultPrevented &&
      !typing(event) &&
      !document.querySelector('dialog[open]')
    ) {
      drop();
    }
  });

  // ── Drawing over the view.
  /** Whether a place of the land is behind what stands before it. */
  const hidden = (x, y, { x: px, y: py }) =>
    !view.onmap &&
    px >= 0 &&
    py >= 0 &&
    px <= view.parent.clientWidth &&
    py <= view.parent.clientHeight &&
    !view.project(x, y);
  function stroke(pen, place, line) {
    const { land } = here();
    const places = spread(land, line, Math.max(1, lengthOf(line) / 160), 160).map(({ x, y }) => [x, y]);
    const corners = line.length <= 60 && view.onmap ? line : places; // on the map straight is straight
    const spots = corners.map(([x, y]) => {
      const at = place(x, y);
      return at && { ...at, hidden: hidden(x, y, at) };
    });
    const trace = (behind) => {
      pen.beginPath();
      for (let i = 1; i < spots.length; ++i) {
        const [a, b] = [spots[i - 1], spots[i]];
        if (!a || !b || (a.hidden && b.hidden) !== behind) continue;
        pen.moveTo(a.x, a.y);
        pen.lineTo(b.x, b.y);
      }
    };
    trace(false);
    for (const [colour, wide] of [[paper, 5], [ink, 2.4]]) {
      Object.assign(pen, { strokeStyle: colour, lineWidth: wide }).stroke();
    }
    trace(true);
    pen.setLineDash([1, 5]);
    Object.assign(pen, { strokeStyle: ink, lineWidth: 1.6 }).stroke();
    pen.setLineDash([]);
  }
  function dot(pen, at, radius, filled) {
    if (!at) return;
    pen.beginPath();
    pen.arc(at.x, at.y, radius, 0, 7);
    Object.assign(pen, { fillStyle: filled ? ink : paper, strokeStyle: filled ? paper : ink, lineWidth: 2 });
    pen.fill();
    pen.stroke();
  }
  function letter(pen, at, text) {
    if (!at) return;
    Object.assign(pen, {
      font: '600 12px system-ui, sans-serif',
      textAlign: 'center',
      textBaseline: 'middle',
      strokeStyle: paper,
      fillStyle: ink,
      lineWidth: 3.5,
    });
    pen.strokeText(text, at.x, at.y - 14);
    pen.fillText(text, at.x, at.y - 14);
  }
  tools.layer((pen, place) => {
    if (shape && result) {
      const { line } = result;
      const next = shape.drawing && cursor ? [...line, cursor] : line;
      if (next.length > 1) stroke(pen, place, next);
      for (const [x, y] of (shape.freehand ? [line[0], line.at(-1)] : shape.points) ?? []) dot(pen, place(x, y), 3.5);
      if (shape.kind === 'section') {
        dot(pen, place(shape.x, shape.y), 3.5);
        for (const [sign, name] of [[-1, 'L'], [1, 'R']]) {
          const at = place(...endOf(sign));
          dot(pen, at, 5.5, true);
          letter(pen, at, name);
        }
      } else if (shape.kind === 'catchment' && line.length) dot(pen, place(...line[0]), 4.5, true);
      if (mark) dot(pen, place(mark.x, mark.y), 6);
    }
    if (hair && mine()) {
      const at = place(hair.x, hair.y);
      if (!at) return;
      pen.beginPath();
      for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
        pen.moveTo(at.x + 4 * dx, at.y + 4 * dy);
        pen.lineTo(at.x + 15 * dx, at.y + 15 * dy);
      }
      for (const [colour, wide] of [[paper, 4.5], ['#1f2226', 1.8]]) {
        Object.assign(pen, { strokeStyle: colour, lineWidth: wide }).stroke();
      }
    }
  });

  // ── The tools.
  const common = {
    group: 9, cursor: 'crosshair', key,
    hover(at) {
      hair = null;
      cursor = at ? [at.x, at.y] : null;
      if (shape?.drawing) tools.draw();
    },
    dropped() {
      if (shape?.drawing) finish();
      hair = null;
      queueMicrotask(show); // when the next is held
    },
  };
  const tool = (own_, id, letter_, title_, help_, icon) => ({
    ...common, ...own_, id, letter: letter_, title: title_, icon,
    taken() {
      help = help_;
      show();
      if (document.activeElement === document.body) view.canvas.focus({ preventScroll: true });
    },
  });
  const own = [
    tool(
      lineTools[0],
      'profile',
      'l',
      'Profile',
      'Draw a line, or click its points. A click on a river gives its profile (with Shift: a point).',
      'M2 15l4-7 4 4 4-8 4 6M2 18h16',
    ),
    tool(
      sectionTool,
      'section',
      'x',
      'Cross-section',
      'Click a river for the section across its valley. Drag its ends to change the width.',
      'M2 5l4 2 3 8h2l3-8 4-2M9 18h2',
    ),
    tool(
      clicked(takeCatchment),
      'catchment',
      'c',
      'Catchment',
      'Click a place, or a river, for all land that drains through it.',
      'M10 18c0-4-7-5-7-10 0-4 3-6 7-6s7 2 7 6c0 5-7 6-7 10zM10 18v-7M10 11L7 7M10 11l3-4',
    ),
    tool(
      lineTools[1],
      'distance',
      'd',
      'Distance and height',
      'Click the points of a way; its beginning once more closes it.',
      'M2 14L14 2l4 4L6 18zM6 10l2 2M9 7l2 2M12 4l2 2',
    ),
  ];
  for (const one of own) tools.add(one);

  return {
    changed() {
      const { land, water, data } = here();
      const lacks = {
        profile: land.level && 'there is no land yet',
        section: land.level && 'there is no land yet',
        catchment:
          !water.known &&
          (land.level
            ? 'there is no land yet'
            : land.cells > 1 && !land.draft
              ? 'not where the page shows means of squares of cells'
              : 'the ways of the water are still being computed'),
      };
      for (const { id, button, title: name, letter: letter_ } of own) {
        button.disabled = Boolean(lacks[id]);
        button.title = lacks[id] ? `${name}: ${lacks[id]}` : `${name} (${letter_.toUpperCase()})`;
      }
      if (!shape) return;
      if (shape.grid !== JSON.stringify(data.grid)) drop();
      else renew(!shape.drawing);
    },
    hover(at) {
      if (!result?.points || shape.drawing) return;
      const reach = at ? cells(10) ** 2 : 0;
      const off = (p) => (p.x - at.x) ** 2 + (p.y - at.y) ** 2;
      const i = at ? result.points.reduce((best, p, k) => (off(p) < off(result.points[best]) ? k : best), 0) : -1;
      const near = i >= 0 && off(result.points[i]) <= reach;
      if (!near && !mark) return;
      read(near ? i : null);
      point(near ? result.points[i] : null);
    },
    /** What is measured now: {kind, points: [{d, x, y [cells], z}] of its diagram, figures}, or null. */
    result: () => result && { kind: shape.kind, points: result.points ?? null, line: result.line, ...result.figures },
  };
}
