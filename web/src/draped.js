// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Lines that lie on the land in 3-D, some pixels wide.
import { Group } from 'three';
import { LineMaterial } from 'three/addons/lines/LineMaterial.js';
import { LineSegments2 } from 'three/addons/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/addons/lines/LineSegmentsGeometry.js';

export class DrapedLines {
  /** rank: of several such, the higher lies on top. */
  constructor(ground, rank) {
    this.ground = ground;
    this.rank = rank;
    this.group = new Group();
    this.ready = new Map(); // line -> its segments in space
  }

  /** Segments of a line in space, cut where it crosses stitches of the mesh, a little above it. */
  #segments(line) {
    if (this.ready.has(line)) return this.ready.get(line);
    const { ground } = this;
    const stitch = Math.min(ground.land.grid.width / ground.columns, ground.land.grid.height / ground.rows);
    const out = [];
    let last = null;
    const add = (x, y) => {
      const p = [x * ground.unit - ground.halfX, ground.meshAt(x, y), y * ground.unit - ground.halfZ];
      if (last) out.push(...last, ...p);
      last = p;
    };
    add(line[0], line[1]);
    for (let i = 2; i < line.length; i += 2) {
      const [ax, ay, bx, by] = line.subarray(i - 2, i + 2);
      const parts = Math.max(1, Math.ceil(Math.hypot(bx - ax, by - ay) / (0.7 * stitch)));
      for (let k = 1; k <= parts; ++k) add(ax + ((bx - ax) * k) / parts, ay + ((by - ay) * k) / parts);
    }
    const segments = Float32Array.from(out);
    this.ready.set(line, segments);
    return segments;
  }

  /** Draws groups of lines [{lines, width [px], colour}] in place of those before; later groups lie on top. */
  show(groups) {
    for (const child of this.group.children) {
      child.geometry.dispose();
      child.material.dispose();
    }
    this.group.clear();
    groups.filter(({ lines }) => lines.length > 0).forEach(({ lines, width, colour }, place) => {
      const rank = this.rank + place;
      const parts = lines.map((line) => this.#segments(line));
      const positions = new Float32Array(parts.reduce((sum, part) => sum + part.length, 0));
      let at = 0;
      for (const part of parts) {
        positions.set(part, at);
        at += part.length;
      }
      if (at === 0) return;
      const geometry = new LineSegmentsGeometry().setPositions(positions);
      const material = new LineMaterial({ linewidth: width, polygonOffset: true, polygonOffsetFactor: -2 - rank,
        polygonOffsetUnits: -4 - 2 * rank });
      material.color.setRGB(...colour.map((c) => c / 255)); // the page paints in the screen's own space
      const object = new LineSegments2(geometry, material);
      object.frustumCulled = false;
      object.renderOrder = 1 + rank;
      this.group.add(object);
    });
  }

  resize(width, height) {
    for (const child of this.group.children) child.material.resolution.set(width, height);
  }
}
