// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The view of a land that this browser can show, and the names in it.
import { number } from './chart.js';
import { byId } from './elements.js';
import { metres } from './panel.js';
import { View2d } from './view2d.js';
import { probe, View3d } from './view3d.js';

/** options: {lakes, sea} of the land. */
export function makeView(land, rivers, options) {
  const asked = new URLSearchParams(location.search);
  const gl = probe(asked.get('aa') !== '0');
  if (gl && Math.max(land.width, land.height) <= gl.largest) {
    const segments = Math.round(Number(asked.get('seg')));
    const most = segments >= 1 ? Math.min(segments, 2047) : undefined;
    try {
      return new View3d(byId('view'), land, rivers, { segments: most, ...options }, gl);
    } catch (error) {
      console.info(`no 3-D view: ${error.message}`);
      byId('view').replaceChildren();
    }
  }
  return new View2d(byId('view'), land, rivers, options);
}

/** What stands beside summits and where rivers leave: {x, y [cells], text, kind}. */
export function namesOf({ data, rivers, land }) {
  const names = data.summits.map(([x, y, z]) => ({ x, y, text: metres(z, land), kind: 'summit' }));
  const ends = [];
  rivers.downstream.forEach((d, k) => d < 0 && ends.push(k));
  const area = rivers.arcs.ds_area;
  ends.sort((a, b) => area[b] - area[a]);
  const largest = ends.slice(0, 6).filter((k) => area[k] > 0);
  const outlets = largest.map((k) => {
    const line = rivers.lines[k];
    return { x: line.at(-2), y: line.at(-1), text: `${number(area[k] / 1e6, 3)} km²`, kind: 'outlet' };
  });
  // The highest summit first, then the two kinds in turn.
  const most = Math.max(names.length, outlets.length);
  return Array.from({ length: most }, (_, i) => [names[i], outlets[i]]).flat().filter(Boolean);
}

/** Where labels keep out, since something lies over the view: {x0, x1, y0, y1} [pixels]. */
export function coveredParts() {
  const frame = byId('view').getBoundingClientRect();
  const over = ['ways', 'north', 'point', 'doing', 'toolbar', 'inspector', 'measure'];
  return over
    .flatMap((id) => document.getElementById(id)?.getBoundingClientRect() ?? [])
    .filter((b) => b.width > 0)
    .map((b) => ({
      x0: b.left - frame.left - 2,
      x1: b.right - frame.left + 2,
      y0: b.top - frame.top - 2,
      y1: b.bottom - frame.top + 2,
    }));
}
