// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The long profiles: of the main stem, and of those of other basins.
import { number, plot } from './chart.js';
import { make, section } from './elements.js';

/** The height at a distance; points ascend from the outlet up. */
function heightAt(points, distance) {
  const i = Math.max(1, points.findIndex((p) => p[0] >= distance));
  const [[d0, z0], [d1, z1]] = [points[i - 1], points[i]];
  return z0 + (d1 > d0 ? ((distance - d0) / (d1 - d0)) * (z1 - z0) : 0);
}

/**
 * Knickpoints: where the slope over the next 25th of the length downstream is at least 2.5 times that over as much
 * upstream, and the fall over it at least a 50th of the whole; of several within a 25th the one with the greatest
 * difference of slopes, moved to the lip: what stands highest above a straight line from a 25th below to a 25th above.
 * points ascend from the outlet up. Gives [{index, above, below}] from the outlet up, slopes [m/m].
 */
export function knickpoints(points) {
  const length = points.at(-1)[0];
  const fall = points.at(-1)[1] - points[0][1];
  const reach = length / 25;
  if (!(fall > 0 && reach > 0)) return [];
  const at = (index) => {
    const [d, z] = points[index];
    return {
      index,
      d,
      above: (heightAt(points, d + reach) - z) / reach,
      below: (z - heightAt(points, d - reach)) / reach,
    };
  };
  const lip = ({ index, d, above, below }) => {
    const over = (p) => p[1] - points[index][1] - 0.5 * (above + below) * (p[0] - d);
    const near = [...points.keys()].filter(
      (i) => Math.abs(points[i][0] - d) <= reach && points[i][0] >= reach && points[i][0] + reach <= length,
    );
    return near.reduce((best, i) => (over(points[i]) > over(points[best]) ? i : best), index);
  };
  const found = points
    .map((_, index) => at(index))
    .filter(
      ({ d, above, below }) => d >= reach && d + reach <= length && below >= 2.5 * above && below * reach >= fall / 50,
    )
    .sort((a, b) => b.below - b.above - a.below + a.above);
  const chosen = [];
  for (const one of found) if (chosen.every((other) => Math.abs(other.d - one.d) > reach)) chosen.push(one);
  return [...new Set(chosen.map(lip))].sort((a, b) => a - b).map(at);
}

/** Gives {element: section or null, hover(x, y, arc)}. */
export function profiles(data, actions) {
  const stems = data.profiles.filter(({ points }) => points.length > 1);
  const place = make('div');
  const choice = make('select', { id: 'stem' });
  let shown;
  let points = [];
  let read = (_index) => {};

  function show(index) {
    shown = stems[index];
    points = [...shown.points].reverse();
    const km = points.at(-1)[0] >= 2000;
    const along = (d) => (km ? d / 1000 : d);
    const steps = knickpoints(points);
    const slope = (v) => `${number(100 * v, 2)}\u00a0%`;
    const sentence = ({ above, below }) => `knickpoint: ${slope(above)} above it, ${slope(below)} below`;
    const line = plot([{ points: points.map(([d, z]) => [along(d), z]), kind: 'area', name: 'height' }], {
      title:
        (index ? `Longest river of basin ${shown.basin}` : 'Main stem') + ', from the outlet up to its farthest source',
      x: `distance from the outlet [${km ? 'km' : 'm'}]`,
      y: 'height [m]',
      zeroX: true,
      height: 176,
      flags: steps.map(({ index: i }) => [along(points[i][0]), points[i][1]]),
      note: (i) => {
        const near = steps.find((step) => Math.abs(step.d - points[i][0]) < points.at(-1)[0] / 200);
        return near && sentence(near);
      },
      onread: (i) => (i === null ? actions.unpoint() : actions.point(points[i][2], points[i][3])),
    });
    read = line.read;
    const go = ({ index: i, d }) => {
      const button = make('button', {
        type: 'button',
        className: 'link',
        textContent: `${number(along(d), 3)}\u00a0${km ? 'km' : 'm'}`,
      });
      button.title = sentence(steps.find((step) => step.index === i));
      button.addEventListener('click', () => actions.flyTo(points[i][2], points[i][3]));
      for (const [event, to] of [['pointerenter', i], ['focus', i], ['pointerleave', null], ['blur', null]]) {
        button.addEventListener(event, () => read(to));
      }
      return button;
    };
    const list = steps.length
      ? make(
          'p',
          { className: 'hint' },
          make('span', { className: 'flag-sign', textContent: '▼ ' }),
          `${steps.length === 1 ? 'Knickpoint' : 'Knickpoints'} at `,
          ...steps.flatMap((step, i) => (i ? [', ', go(step)] : [go(step)])),
        )
      : '';
    place.replaceChildren(line.figure, list);
  }
  if (!stems.length) return { element: null, hover() {} };
  choice.append(...stems.map((stem, i) => {
    const length = stem.points[0][0];
    return make('option', {
      value: i,
      textContent:
        (i ? `basin ${stem.basin}, ` : 'main stem, ') +
        (length >= 2000 ? `${number(length / 1000, 3)} km` : `${number(length, 3)} m`),
    });
  }));
  choice.addEventListener('change', () => show(Number(choice.value)));
  show(0);
  const { arcs } = data.rivers;
  return {
    element: section(
      'Long profile',
      stems.length > 1 &&
        make('p', { className: 'choice' }, make('label', { htmlFor: 'stem', textContent: 'River' }), choice),
      place,
    ),
    /** The pointer on the land: of a basin's arcs its longest river has Hack's order 1. */
    hover(x, y, arc) {
      if (!(arc >= 0 && arcs.basin[arc] === shown.basin && arcs.hack[arc] === 1)) return read(null);
      const off = (p) => (p[2] - x) ** 2 + (p[3] - y) ** 2;
      return read(points.reduce((best, p, i) => (off(p) < off(points[best]) ? i : best), 0));
    },
  };
}
