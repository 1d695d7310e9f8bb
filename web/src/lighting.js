// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How the land is looked at: exaggeration, contours, and the sun.
import { number } from './chart.js';
import { byId, inputById } from './elements.js';

/** @param {number} degrees clockwise from the north */
export const windOf = (degrees) => 'N NE E SE S SW W NW N'.split(' ')[Math.round(degrees / 45)];

/** A slider that walks through a list of values. Gives set(values, start), which gives the value nearest to start. */
function slider(id, show, change) {
  const input = inputById(id);
  let values = [0];
  const tell = () => {
    const value = values[Number(input.value)];
    const text = show(value);
    byId(`${id}out`).textContent = text;
    input.setAttribute('aria-valuetext', text);
    return value;
  };
  input.addEventListener('input', () => change(tell()));
  return (list, start) => {
    values = list;
    Object.assign(input, { min: 0, max: values.length - 1, step: 1 });
    const nearest = values.reduce((best, v, i) => (Math.abs(v - start) < Math.abs(values[best] - start) ? i : best), 0);
    input.value = String(nearest);
    return tell();
  };
}

/** Intervals of contours that suit a land: none, 1, 2 and 5 times powers of ten, and the one that is asked for [m]. */
export function contourSteps(span, asked) {
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
export function goodExaggeration(land) {
  const extent = Math.max(land.grid.width, land.grid.height) * land.grid.cell_m;
  const wanted = land.max > land.min ? (0.1 * extent) / (land.max - land.min) : 1;
  return lifts.reduce((best, v) => (Math.abs(Math.log(v / wanted)) < Math.abs(Math.log(best / wanted)) ? v : best), 1);
}

/** The controls of exaggeration, contours and light, and the view as they have it. */
export class Lighting {
  #way = { azimuth: 315, altitude: 40 };
  #interval = 0; // of contours [m]
  #setLift;
  #setContour;

  constructor(view) {
    this.view = view;
    this.#setLift = slider('exaggeration', (v) => `× ${number(v)}`, (v) => this.look({ exaggeration: v }));
    this.#setContour = slider(
      'contour',
      (v) => (v > 0 ? `${number(v)} m` : 'none'),
      (v) => {
        this.#interval = v;
        this.look();
      },
    );
    const setSun = slider('sun', (v) => `${v}° (${windOf(v)})`, (v) => this.look({ azimuth: v }));
    setSun(Array.from({ length: 72 }, (_, i) => 5 * i), this.#way.azimuth);
    const setAltitude = slider('altitude', (v) => `${v}°`, (v) => this.look({ altitude: v }));
    setAltitude(Array.from({ length: 17 }, (_, i) => 5 + 5 * i), this.#way.altitude);
    inputById('show-contours').addEventListener('change', () => this.look());
  }

  /** Looks at the land as the controls say, and as what has changed. */
  look(change = {}) {
    Object.assign(this.#way, change);
    this.view.look({ ...this.#way, contour: inputById('show-contours').checked ? this.#interval : 0 });
  }

  /** Fits the controls to another land. contour: its interval [m]; afresh: what was chosen for another is gone. */
  fit(land, contour, afresh) {
    // Under slopes too gentle to be seen the shade of the map is deepened, as on the printed one.
    const shadeGain = Math.min(12, Math.max(1, 0.5 / Math.max(1e-6, land.steepness())));
    Object.assign(this.#way, { shadeGain });
    if (afresh) {
      Object.assign(this.#way, { exaggeration: this.#setLift(lifts, goodExaggeration(land)) });
      this.#interval = contour;
    }
    this.#interval = this.#setContour(contourSteps(land.max - land.min, this.#interval), this.#interval);
    for (const id of ['exaggeration', 'contour', 'sun', 'altitude', 'show-contours']) {
      inputById(id).disabled = land.level;
    }
    inputById('exaggeration').disabled ||= this.view.mode === '2d';
  }
}
