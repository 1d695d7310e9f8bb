// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The land in 3-D: a mesh whose colour, shade and contours are computed for every pixel from one texture of heights.
import { BufferAttribute, BufferGeometry, ClampToEdgeWrapping, Color, DataTexture, DoubleSide, FloatType, GLSL3, Group,
  LinearFilter, Mesh, MeshBasicMaterial, NearestFilter, RedFormat, ShaderMaterial, UnsignedByteType, Vector2, Vector3 } from 'three';
import { tints } from './colours.js';

const vertexShader = /* glsl */`
out vec2 place; // [values] from the north-west, 0 at the centre of the first
uniform vec2 size;
void main() {
  place = uv * size - 0.5;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;

const fragmentShader = /* glsl */`
precision highp float;
precision highp sampler2D;
in vec2 place;
out vec4 colour;
uniform sampler2D heights;
uniform sampler2D mask;
uniform vec2 size;
uniform float holes, low, high, side, gain, contour, withTint, dpr;
uniform vec3 sun;
uniform vec3 tints[17];

float heightAt(vec2 p) {
  p = clamp(p, vec2(0.0), size - 1.0);
#ifdef LINEAR
  return texture(heights, (p + 0.5) / size).r;
#else
  vec2 corner = floor(p), part = p - corner;
  ivec2 a = ivec2(corner), b = min(a + 1, ivec2(size) - 1);
  return mix(mix(texelFetch(heights, a, 0).r, texelFetch(heights, ivec2(b.x, a.y), 0).r, part.x),
             mix(texelFetch(heights, ivec2(a.x, b.y), 0).r, texelFetch(heights, b, 0).r, part.x), part.y);
#endif
}

void main() {
  if (holes > 0.5 && texture(mask, (place + 0.5) / size).r < 0.5) discard;
  float z = heightAt(place);
  float apart = 1.0;
  vec2 slope = vec2(heightAt(place + vec2(apart, 0.0)) - heightAt(place - vec2(apart, 0.0)),
                    heightAt(place + vec2(0.0, apart)) - heightAt(place - vec2(0.0, apart))) / (2.0 * apart * side);
  vec3 ground = vec3(0.87, 0.86, 0.82);
  if (withTint > 0.5) {
    float at = high > low ? clamp((z - low) / (high - low), 0.0, 1.0) * 16.0 : 6.4;
    int k = min(int(at), 15);
    ground = mix(tints[k], tints[k + 1], at - float(k));
  }
  // East, north, up; the light beside that of level ground.
  vec3 normal = normalize(vec3(-slope.x * gain, slope.y * gain, 1.0));
  float light = dot(normal, sun) - sun.z;
  vec3 lit = light < 0.0 ? mix(ground, ground * vec3(0.26, 0.29, 0.40), min(1.0, -light / max(sun.z, 0.2)))
                         : mix(ground, vec3(1.0, 1.0, 0.96), 0.55 * min(1.0, light / max(1.0 - sun.z, 0.2)));
  if (contour > 0.0) {
    float level = z / contour;
    float wide = max(fwidth(level), 1e-9);
    float off = abs(fract(level - 0.5) - 0.5) / wide;
    float five = abs(fract(level / 5.0 - 0.5) - 0.5) * 5.0 / wide;
    float line = (1.0 - smoothstep(0.2 * dpr, 0.2 * dpr + 0.8, off)) * 0.42 * (1.0 - smoothstep(0.18, 0.45, wide));
    float heavy = (1.0 - smoothstep(0.45 * dpr, 0.45 * dpr + 0.9, five)) * 0.55 * (1.0 - smoothstep(0.9, 2.2, wide));
    lit = mix(lit, vec3(0.44, 0.27, 0.14), max(line, heavy));
  }
  colour = vec4(lit, 1.0);
}`;

/** Land in a space where its longer side measures 2: x to the east, z to the south, y up (scaled by `lift`). */
export class Ground {
  constructor(land, segments, linear) {
    this.land = land;
    const { width, height } = land.grid;
    this.unit = 2 / Math.max(width, height); // of space a cell
    this.halfX = (width * this.unit) / 2;
    this.halfZ = (height * this.unit) / 2;
    this.perMetre = this.unit / land.grid.cell_m;
    // As many stitches as asked along the longer side, never more than values.
    const most = Math.max(land.width, land.height);
    this.columns = Math.max(1, Math.min(land.width, Math.round((segments * land.width) / most)));
    this.rows = Math.max(1, Math.min(land.height, Math.round((segments * land.height) / most)));
    this.group = new Group();
    this.#stitch();
    this.group.add(new Mesh(this.geometry, this.#material(linear)));
    this.walls = this.#walls();
    this.group.add(this.walls);
  }

  #stitch() {
    const { columns, rows, land } = this;
    const { width, height } = land.grid;
    const positions = new Float32Array((columns + 1) * (rows + 1) * 3);
    const uvs = new Float32Array((columns + 1) * (rows + 1) * 2);
    for (let r = 0, i = 0; r <= rows; ++r) {
      for (let c = 0; c <= columns; ++c, ++i) {
        const x = (c / columns) * width;
        const y = (r / rows) * height;
        positions[3 * i] = x * this.unit - this.halfX;
        positions[3 * i + 1] = (land.heightAt(x, y) - land.min) * this.perMetre;
        positions[3 * i + 2] = y * this.unit - this.halfZ;
        uvs[2 * i] = x / land.cells / land.width;
        uvs[2 * i + 1] = y / land.cells / land.height;
      }
    }
    const index = new Uint32Array(columns * rows * 6);
    for (let r = 0, k = 0; r < rows; ++r) {
      for (let c = 0; c < columns; ++c) {
        const a = r * (columns + 1) + c;
        const b = a + columns + 1;
        index.set([a, b, a + 1, b, b + 1, a + 1], k);
        k += 6;
      }
    }
    this.positions = positions;
    this.geometry = new BufferGeometry();
    this.geometry.setAttribute('position', new BufferAttribute(positions, 3));
    this.geometry.setAttribute('uv', new BufferAttribute(uvs, 2));
    this.geometry.setIndex(new BufferAttribute(index, 1));
  }

  #material(linear) {
    const { land } = this;
    const heights = new DataTexture(land.z, land.width, land.height, RedFormat, FloatType);
    heights.internalFormat = 'R32F';
    heights.magFilter = heights.minFilter = linear ? LinearFilter : NearestFilter;
    heights.wrapS = heights.wrapT = ClampToEdgeWrapping;
    heights.needsUpdate = true;
    const mask = new DataTexture(land.has ?? new Uint8Array([255]), land.has ? land.width : 1, land.has ? land.height : 1,
      RedFormat, UnsignedByteType);
    mask.unpackAlignment = 1;
    mask.magFilter = mask.minFilter = NearestFilter;
    mask.needsUpdate = true;
    const { min, max } = land;
    this.uniforms = {
      heights: { value: heights }, mask: { value: mask }, size: { value: new Vector2(land.width, land.height) },
      holes: { value: land.has ? 1 : 0 }, low: { value: min }, high: { value: max },
      side: { value: land.cells * land.grid.cell_m }, gain: { value: 1 }, contour: { value: 0 }, withTint: { value: 1 },
      dpr: { value: 1 }, sun: { value: new Vector3(0, 0, 1) },
      tints: { value: tints.map((c) => new Vector3(...c.map((v) => v / 255))) },
    };
    return new ShaderMaterial({ glslVersion: GLSL3, vertexShader, fragmentShader, uniforms: this.uniforms, side: DoubleSide,
      defines: linear ? { LINEAR: 1 } : {}, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 2 });
  }

  /** Walls from the border down to a base, so that the land reads as a block. */
  #walls() {
    const { columns, rows } = this;
    const rim = [];
    for (let c = 0; c <= columns; ++c) rim.push(c);
    for (let r = 1; r <= rows; ++r) rim.push(r * (columns + 1) + columns);
    for (let c = columns - 1; c >= 0; --c) rim.push(rows * (columns + 1) + c);
    for (let r = rows - 1; r >= 0; --r) rim.push(r * (columns + 1));
    this.rim = rim;
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(new Float32Array(rim.length * 6), 3));
    const index = [];
    for (let i = 0; i + 1 < rim.length; ++i) index.push(2 * i, 2 * i + 1, 2 * i + 2, 2 * i + 1, 2 * i + 3, 2 * i + 2);
    geometry.setIndex(index);
    return new Mesh(geometry, new MeshBasicMaterial({ color: new Color(0xb3a795), side: DoubleSide }));
  }

  /** Vertical exaggeration. */
  raise(lift) {
    this.lift = lift;
    this.group.scale.y = lift;
    const base = -0.035 / lift; // the plinth keeps its height
    const wall = this.walls.geometry.getAttribute('position');
    this.rim.forEach((at, i) => {
      const [x, y, z] = this.positions.subarray(3 * at, 3 * at + 3);
      wall.array.set([x, y, z, x, base, z], 6 * i);
    });
    wall.needsUpdate = true;
    this.walls.geometry.computeBoundingSphere();
    this.walls.visible = this.land.holes === 0 && !this.land.level;
  }

  /** The rim at some places and the foot of the corners, in space as raised. */
  corners() {
    const wall = this.walls.geometry.getAttribute('position').array;
    const out = [];
    const stride = 6 * Math.max(1, Math.floor(this.rim.length / 200));
    for (let i = 0; i < wall.length; i += stride) {
      out.push(new Vector3(wall[i], wall[i + 1] * this.lift, wall[i + 2]), new Vector3(wall[i + 3], wall[i + 4] * this.lift, wall[i + 5]));
    }
    return out;
  }

  /** Height of the mesh itself (space, before exaggeration) at a place [cells]: what lies on it must not sink in. */
  meshAt(x, y) {
    const { columns, rows, positions } = this;
    const u = Math.min(Math.max((x / this.land.grid.width) * columns, 0), columns);
    const v = Math.min(Math.max((y / this.land.grid.height) * rows, 0), rows);
    const c = Math.min(Math.floor(u), columns - 1);
    const r = Math.min(Math.floor(v), rows - 1);
    const fx = u - c;
    const fy = v - r;
    const at = (i, j) => positions[3 * ((r + j) * (columns + 1) + c + i) + 1];
    // The two triangles of a stitch, split from north-east to south-west.
    return fx + fy <= 1 ? at(0, 0) + fx * (at(1, 0) - at(0, 0)) + fy * (at(0, 1) - at(0, 0))
      : at(1, 1) + (1 - fx) * (at(0, 1) - at(1, 1)) + (1 - fy) * (at(1, 0) - at(1, 1));
  }

  /** Where a ray first meets the land: {x, y} [cells], or null. Straight steps of half a value, then bisection. */
  meet(ray) {
    const { origin, direction } = ray;
    const roof = (this.land.max - this.land.min) * this.perMetre * this.lift + 1e-6;
    let from = 0;
    let to = Infinity;
    for (const [o, d, least, most] of [[origin.x, direction.x, -this.halfX, this.halfX], [origin.y, direction.y, -1e-6, roof],
      [origin.z, direction.z, -this.halfZ, this.halfZ]]) {
      if (Math.abs(d) < 1e-12) {
        if (o < least || o > most) return null;
        continue;
      }
      const a = (least - o) / d;
      const b = (most - o) / d;
      from = Math.max(from, Math.min(a, b));
      to = Math.min(to, Math.max(a, b));
    }
    if (from > to) return null;
    const place = (t) => [(origin.x + t * direction.x + this.halfX) / this.unit, (origin.z + t * direction.z + this.halfZ) / this.unit];
    const above = (t) => origin.y + t * direction.y - (this.land.heightAt(...place(t)) - this.land.min) * this.perMetre * this.lift;
    const pace = 0.5 * this.land.cells * this.unit;
    let before = from;
    for (let t = from; ; t = Math.min(t + pace, to)) {
      if (above(t) <= 1e-9 && this.#solid(place(t))) {
        let out = before;
        let into = t;
        for (let k = 0; k < 40; ++k) {
          const middle = (out + into) / 2;
          if (above(middle) > 0) out = middle;
          else into = middle;
        }
        const [x, y] = place(into);
        return { x, y };
      }
      before = t;
      if (t >= to) return null;
    }
  }

  #solid([x, y]) {
    return this.land.level || this.land.known(Math.min(x, this.land.grid.width - 1e-6), Math.min(y, this.land.grid.height - 1e-6));
  }
}
