// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What each kind of measurement finds, in words, figures and a diagram.
import { number } from './chart.js';
import { fold, make, table } from './elements.js';
import {
  along,
  catchment,
  crossings,
  lengthOf,
  nearestOn,
  networkOf,
  outline,
  riverOf,
  riverProfile,
  sectionPoints,
  sums,
  traverse,
  valley,
  valueOfRiver,
  wkt,
} from './survey.js';

const unit = (value, name) => `${value}\u00a0${name}`;
export const far = (m) => (m >= 2000 ? unit(number(m / 1000), 'km') : unit(number(m), 'm'));
export const high = (z) => unit(number(Math.round(10 * z) / 10 + 0, 6), 'm'); // no minus before 0
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
  /** @type {[{d: number, z: number}, string][]} */
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

const kinds = {
  profile: profileOf,
  river: riverProfileOf,
  section: sectionOf,
  catchment: catchmentOf,
  distance: distanceOf,
};
const nothing = { content: [], saves: [], figures: {}, sentence: '' };

/**
 * Measures a shape, {kind, …} as measure.js holds it. here: {data, land, rivers, water, orders, finder, slope()}.
 * Gives {title, sentence: for who does not see it, figures: for scripts, line: what is drawn, content: nodes of the
 * card, points and chart: of a diagram, saves: [[label, name, ending, text()], …], inside: part of the land, missing:
 * why there is nothing}.
 */
export const measure = (shape, here) => ({ ...nothing, ...kinds[shape.kind](shape, here) });
