// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The land in 3-D: a mesh whose colour, light, water, contours and lines are computed for every pixel from textures.
import {
  BackSide,
  BufferAttribute,
  BufferGeometry,
  ClampToEdgeWrapping,
  DataTexture,
  DoubleSide,
  FloatType,
  GLSL3,
  Group,
  HalfFloatType,
  LinearFilter,
  LinearMipmapLinearFilter,
  Mesh,
  NearestFilter,
  PlaneGeometry,
  RedFormat,
  RepeatWrapping,
  RGBAFormat,
  RGFormat,
  ShaderMaterial,
  SphereGeometry,
  UnsignedByteType,
  Vector2,
  Vector3,
} from 'three';
import { distanceInside, skyView, slopes, sunlight } from './light.js';
import { LineField } from './riverfield.js';

const farthestShore = 64; // [values] beyond which water is as deep as it gets

// Light is reckoned in linear values; the page paints in the screen's own.
const shared = /* glsl */`
precision highp float;
precision highp sampler2D;
// backdrop: [pixels] height of the view where no sea reaches the horizon
uniform float onMap, unit, dark, near, backdrop;
uniform vec3 sunThere, horizon, zenith;
uniform sampler2D grain;
vec3 linear(vec3 c) { return c * c; }
vec3 screen(vec3 c) { return sqrt(c); }
float noise(vec2 p) { return texture(grain, p / 64.0).r; }
// What is behind the land.
vec3 behind() {
  float up = onMap > 0.5 ? 0.0 : 0.85 * smoothstep(0.25, 1.05, gl_FragCoord.y / max(backdrop, 1.0));
  return mix(linear(horizon), linear(zenith), up);
}
vec3 haze(vec3 c, vec3 at) {
  if (onMap > 0.5) return c;
  float far = max(0.0, distance(at, cameraPosition) - near);
  return mix(c, linear(horizon), 0.96 * (1.0 - exp(-pow(far / 5.0, 1.5))));
}
// shore: distance from the shore [values].
vec3 water(float shore, vec3 at, float lake) {
  vec3 shallow = linear(vec3(0.38, 0.62, 0.66)), deep = linear(vec3(0.07, 0.26, 0.42));
  if (lake > 0.5) { shallow = linear(vec3(0.36, 0.60, 0.70)); deep = linear(vec3(0.12, 0.34, 0.52)); }
  float far = shore * (0.7 + 0.6 * noise(at.xz / unit * 0.11));
  float depth = lake > 0.5 ? 1.0 - exp(-shore / 4.0) : 0.55 * (1.0 - exp(-far / 3.5)) + 0.45 * (1.0 - exp(-far / 26.0));
  vec3 c = mix(shallow, deep, depth);
  if (onMap > 0.5) return linear(mix(vec3(0.74, 0.86, 0.91), vec3(0.49, 0.67, 0.80), depth));
  c *= mix(1.0, 0.55, dark);
  vec3 look = normalize(cameraPosition - at);
  vec2 p = at.xz * 260.0;
  float calm = 0.06 * (1.0 - smoothstep(0.15, 0.8, length(fwidth(p))));
  vec3 normal = normalize(vec3((noise(p) - 0.5) * calm, 1.0, (noise(p + 37.0) - 0.5) * calm));
  float bent = 0.02 + 0.98 * pow(1.0 - max(dot(look, normal), 0.0), 5.0);
  vec3 sky = mix(linear(horizon), linear(zenith), clamp(reflect(-look, normal).y * 1.6, 0.0, 1.0));
  c = mix(c, sky, 0.75 * bent);
  c += vec3(1.0, 0.95, 0.85) * mix(0.35, 0.10, dark) * pow(max(dot(reflect(-look, normal), sunThere), 0.0), 60.0);
  return c;
}`;

const vertexShader = /* glsl */`
out vec2 place; // [values] from the north-west, 0 at the centre of the first
out vec3 at;
uniform vec2 size;
void main() {
  place = uv * size - 0.5;
  vec4 world = modelMatrix * vec4(position, 1.0);
  at = world.xyz;
  gl_Position = projectionMatrix * viewMatrix * world;
}`;

const fragmentShader = /* glsl */`
${shared}
in vec2 place;
in vec3 at;
out vec4 colour;
uniform sampler2D heights, surf, cover, shadow, values, palette, nearest, segments, styles, part;
uniform vec2 size, fine;
uniform float holes, sea, low, high, gain, contour, index, dpr, byClass, withLines, lineByClass, level, withPart;
uniform vec3 sun, lineColours[8];

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

// The lines about a place: their colour, and how much of the pixel they cover.
vec4 linesAt(vec2 across, vec2 down) {
  vec2 finer = fine / size, place_ = (place + 0.5) * finer - 0.5;
  across *= finer;
  down *= finer;
  ivec2 corner = ivec2(floor(place_)), last = ivec2(fine) - 1;
  if (texelFetch(nearest, clamp(ivec2(place_ + 0.5), ivec2(0), last), 0).r == 0.0) return vec4(0.0);
  float covered = 0.0, best = -1.0;
  vec3 c = vec3(0.0);
  for (int k = 0; k < 4; ++k) {
    int number = int(texelFetch(nearest, clamp(corner + ivec2(k & 1, k >> 1), ivec2(0), last), 0).r);
    if (number == 0) continue;
    ivec2 row = ivec2((number - 1) % ${LineField.columns}, (number - 1) / ${LineField.columns});
    vec4 s = texelFetch(segments, row, 0), style = texelFetch(styles, row, 0);
    vec2 along = s.zw - s.xy, off = place_ - s.xy;
    off -= along * clamp(dot(off, along) / max(dot(along, along), 1e-12), 0.0, 1.0);
    float away = length(off);
    vec2 normal = away > 1e-6 ? off / away : vec2(1.0, 0.0);
    float pixel = max(length(vec2(dot(normal, across), dot(normal, down))), 1e-6);
    float half_ = min(max(style.x, 0.5 * style.y * dpr * pixel), 4.5);
    float share = clamp((half_ - away) / pixel + 0.5, 0.0, 1.0);
    if (share > 0.0 && (style.w + 0.05 * style.z > best || share > covered + 0.2)) {
      best = style.w + 0.05 * style.z;
      covered = max(covered, share);
      c = style.w > 1.5 ? vec3(1.0, 0.47, 0.0) : style.w > 0.5 ? vec3(0.47, 0.29, 0.16)
        : lineByClass > 0.5 ? lineColours[int(style.z)]
        : mix(vec3(0.29, 0.57, 0.83), vec3(0.04, 0.23, 0.57), style.z);
    }
  }
  return vec4(c, covered);
}

vec3 landAt(vec2 uv, vec4 ground4) {
  float z = heightAt(place);
  vec3 ground = vec3(0.80, 0.78, 0.73);
  if (level < 0.5) {
    float v = texture(values, uv).r;
    float share = byClass > 0.5 ? (v + 0.5) / 256.0
      : high > low ? clamp((v - low) / (high - low), 0.0, 1.0) * 255.0 / 256.0 + 0.5 / 256.0 : 0.4;
    ground = texture(palette, vec2(share, 0.5)).rgb;
  }
  // East, up, south: as the space of the view.
  vec3 normal = normalize(vec3(-ground4.x * gain, 1.0, -ground4.y * gain));
  float lit = texture(shadow, uv).r;
  float open_ = ground4.z;
  vec3 light;
  if (onMap > 0.5) {
    float beside = dot(normal, sun) - sun.y;
    vec3 c = beside < 0.0 ? mix(ground, ground * vec3(0.34, 0.37, 0.47), min(1.0, -beside / max(sun.y, 0.2)))
                          : mix(ground, vec3(1.0, 1.0, 0.96), 0.55 * min(1.0, beside / max(1.0 - sun.y, 0.2)));
    light = linear(c) * mix(0.78, 1.0, open_);
  } else {
    float direct = max(dot(normal, sun), 0.0) * lit;
    float skyward = open_ * (0.65 + 0.35 * normal.y);
    vec3 albedo = linear(ground) * mix(ground, vec3(1.0), 0.3) * (0.93 + 0.14 * noise(place * 0.7));
    light = albedo *
      (vec3(1.98, 1.87, 1.66) * direct + vec3(0.40, 0.52, 0.74) * skyward * skyward + vec3(0.06, 0.05, 0.035));
    light *= mix(1.0, 0.62, dark);
    light = light * (1.0 + light / 6.0) / (1.0 + 0.55 * light);
  }
  if (contour > 0.0) {
    float rise = z / contour;
    float wide = max(fwidth(rise), 1e-9);
    float off = abs(fract(rise - 0.5) - 0.5) / wide;
    float five = abs(fract(rise / index - 0.5) - 0.5) * index / wide;
    float line = onMap > 0.5
      ? (1.0 - smoothstep(0.2 * dpr, 0.2 * dpr + 0.8, off)) * 0.22 * (1.0 - smoothstep(0.15, 0.40, wide)) : 0.0;
    float heavy = (1.0 - smoothstep(0.4 * dpr, 0.4 * dpr + 0.9, five)) * (onMap > 0.5 ? 0.42 : 0.36) *
      (1.0 - smoothstep(0.7, 2.0, wide));
    light = mix(light, linear(vec3(0.40, 0.25, 0.14)), max(line, heavy));
  }
  return light;
}

void main() {
  vec2 across = dFdx(place), down = dFdy(place);
  vec2 uv = (place + 0.5) / size;
  vec2 covers = texture(cover, uv).rg;
  float edge = max(length(across), length(down));
  if (holes > 0.5 && sea < 0.5 && covers.r < 0.02) discard;
  vec4 ground4 = texture(surf, uv);
  float wet = sea > 0.5 ? 1.0 - covers.r : 0.0;
  vec3 light = vec3(0.0);
  if (max(wet, covers.g) < 0.999) light = landAt(uv, ground4);
  float shoreline = 0.0;
  if (wet > 0.0 || covers.g > 0.0) {
    float isLake = covers.g > wet ? 1.0 : 0.0;
    float share = max(wet, covers.g);
    float blur = clamp(edge * 0.5, 0.02, 0.5);
    float in_ = smoothstep(0.5 - blur, 0.5 + blur, share);
    vec3 w = water(max(ground4.w, 0.0), at, isLake);
    light = mix(light, w, in_);
    shoreline = 1.0 - smoothstep(0.0, 1.0, abs(share - 0.5) / max(fwidth(share), 1e-4) - 0.2 * dpr);
    vec3 foam = onMap > 0.5 ? linear(vec3(0.20, 0.38, 0.55)) : vec3(0.86, 0.86, 0.80) * mix(1.0, 0.5, dark);
    light = mix(light, foam, shoreline * (onMap > 0.5 ? 0.7 : 0.5));
  }
  light = haze(light, at);
  if (holes > 0.5 && sea < 0.5) light = mix(behind(), light, smoothstep(0.02, 0.9, covers.r));
  if (withPart > 0.5) {
    float in_ = texture(part, uv).r;
    vec2 right = across * 0.8 * dpr / size, under = down * 0.8 * dpr / size;
    vec4 beside = vec4(texture(part, uv + right).r, texture(part, uv - right).r,
                       texture(part, uv + under).r, texture(part, uv - under).r);
    float step_ = max(max(beside.x, beside.y), max(beside.z, beside.w)) -
      min(min(beside.x, beside.y), min(beside.z, beside.w));
    float rim = max(smoothstep(0.3, 0.6, step_),
                    1.0 - smoothstep(0.0, 1.0, abs(in_ - 0.5) / max(fwidth(in_), 1e-4) - 0.7 * dpr));
    light = mix(light, haze(linear(vec3(1.0, 0.47, 0.0)), at), max(0.9 * rim, 0.2 * smoothstep(0.3, 0.7, in_)));
  }
  if (withLines > 0.5) {
    vec4 line = linesAt(across, down);
    light = mix(light, haze(linear(line.rgb), at), line.a);
  }
  colour = vec4(screen(light), 1.0);
}`;

const wallShader = /* glsl */`
${shared}
in vec3 at;
in vec2 depth;
in float wet;
out vec4 colour;
void main() {
  float below = depth.x - at.y; // under the rim
  float layer = noise(vec2(at.y * 90.0 + 2.0 * noise(at.xz * 7.0), 0.5)) * 0.6 +
    noise(vec2(at.y * 31.0 + noise(at.xz * 3.0), 7.0)) * 0.4;
  vec3 rock = mix(vec3(0.46, 0.40, 0.33), vec3(0.66, 0.59, 0.49), layer);
  rock = mix(vec3(0.40, 0.36, 0.25), rock, smoothstep(0.0, 0.012, below));
  vec3 outwards = normalize(vec3(dFdx(at.z), 0.0, -dFdx(at.x)) + 1e-9);
  float side = 0.55 + 0.45 * max(dot(outwards, vec3(sunThere.x, 0.0, sunThere.z)), 0.0);
  vec3 depths = mix(vec3(0.30, 0.52, 0.62), vec3(0.10, 0.26, 0.40), smoothstep(0.0, 0.06, below));
  vec3 c = linear(mix(rock, depths, step(0.5, wet))) * side * mix(1.0, 0.6, dark);
  c *= 0.55 + 0.45 * smoothstep(0.0, 0.06, at.y - depth.y);
  colour = vec4(screen(haze(c, at)), 1.0);
}`;

const wallVertexShader = /* glsl */`
in vec3 rim; // height of the rim and of the foot, and whether the sea is there
out vec3 at;
out vec2 depth;
out float wet;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  at = world.xyz;
  depth = (modelMatrix * vec4(0.0, rim.x, 0.0, 1.0)).yy;
  wet = rim.z;
  depth.y = (modelMatrix * vec4(0.0, rim.y, 0.0, 1.0)).y;
  gl_Position = projectionMatrix * viewMatrix * world;
}`;

const skyShader = /* glsl */`
${shared}
in vec3 at;
out vec4 colour;
void main() {
  float up = normalize(at - cameraPosition).y;
  vec3 c = mix(linear(horizon), linear(zenith), smoothstep(0.0, 0.55, up));
  if (backdrop > 0.0) c = behind();
  float towards = max(dot(normalize(at - cameraPosition), normalize(vec3(sunThere.x, 0.12, sunThere.z))), 0.0);
  c += vec3(0.9, 0.75, 0.5) * 0.10 * pow(towards, 6.0) * (1.0 - dark);
  colour = vec4(screen(c), 1.0);
}`;

const seaShader = /* glsl */`
${shared}
in vec3 at;
out vec4 colour;
uniform vec2 half_;
uniform sampler2D surf;
void main() {
  vec2 inside = clamp(at.xz, -half_, half_);
  float shore = texture(surf, 0.5 + 0.499 * inside / half_).w + length(at.xz - inside) / unit;
  colour = vec4(screen(haze(water(shore, at, 0.0), at)), 1.0);
}`;

const plainVertexShader = /* glsl */`
out vec3 at;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  at = world.xyz;
  gl_Position = projectionMatrix * viewMatrix * world;
}`;

function texture(data, width, height, format, type, filter) {
  const t = new DataTexture(data, width, height, format, type);
  t.magFilter = t.minFilter = filter;
  t.wrapS = t.wrapT = ClampToEdgeWrapping;
  t.unpackAlignment = 1;
  t.needsUpdate = true;
  return t;
}

/** Smooth noise, 64 x 64 knots that repeat, four texels a knot. */
function grain() {
  const knots = 64;
  const fine = 4;
  let seed = 1;
  const height = Float32Array.from({ length: knots * knots }, () => (seed = (seed * 16807) % 2147483647) / 2147483647);
  const size = knots * fine;
  const bytes = new Uint8Array(size * size);
  const ease = (f) => f * f * (3 - 2 * f);
  for (let r = 0, i = 0; r < size; ++r) {
    const [r0, fr] = [Math.floor(r / fine), ease((r % fine) / fine)];
    const [north, south] = [r0 * knots, ((r0 + 1) % knots) * knots];
    for (let c = 0; c < size; ++c, ++i) {
      const [c0, fc] = [Math.floor(c / fine), ease((c % fine) / fine)];
      const c1 = (c0 + 1) % knots;
      bytes[i] =
        255 *
        ((height[north + c0] * (1 - fc) + height[north + c1] * fc) * (1 - fr) +
          (height[south + c0] * (1 - fc) + height[south + c1] * fc) * fr);
    }
  }
  const t = texture(bytes, size, size, RedFormat, UnsignedByteType, LinearFilter);
  t.wrapS = t.wrapT = RepeatWrapping;
  t.minFilter = LinearMipmapLinearFilter;
  t.generateMipmaps = true;
  return t;
}

/** 16-bit floats, rounded; smaller than 6e-5 as 0. */
function halves(data) {
  const out = new Uint16Array(data.length);
  const bits = new Uint32Array(data.buffer, data.byteOffset, data.length);
  for (let i = 0; i < out.length; ++i) {
    const b = bits[i] + 0x1000;
    const exponent = (b >>> 23) & 255;
    if (exponent > 112) {
      out[i] = ((b >>> 16) & 0x8000) | (exponent > 142 ? 0x7bff : ((exponent - 112) << 10) | ((b >>> 13) & 0x3ff));
    }
  }
  return out;
}

/** Half a raster's sides, means of four, for a texture of `parts` numbers a value. */
function halved(data, width, height, parts) {
  const w = Math.max(1, width >> 1);
  const h = Math.max(1, height >> 1);
  const out = new Float32Array(w * h * parts);
  for (let r = 0, i = 0; r < h; ++r) {
    const north = Math.min(2 * r, height - 1) * width;
    const south = Math.min(2 * r + 1, height - 1) * width;
    for (let c = 0; c < w; ++c) {
      const west = Math.min(2 * c, width - 1);
      const east = Math.min(2 * c + 1, width - 1);
      for (let k = 0; k < parts; ++k, ++i) {
        out[i] =
          (data[(north + west) * parts + k] +
            data[(north + east) * parts + k] +
            data[(south + west) * parts + k] +
            data[(south + east) * parts + k]) /
          4;
      }
    }
  }
  return { data: out, width: w, height: h };
}

/** Land in a space where its longer side measures 2: x to the east, z to the south, y up (scaled by `lift`). */
export class Ground {
  #seen = null; // how much of the sky each place sees: skyView()

  /** sky: values along the longer side by which the sky's share is reckoned. */
  constructor(land, segments, linear, lakes, sea, sky) {
    this.segments = segments;
    this.skyValues = sky;
    this.linear = linear;
    this.#measure(land, lakes, sea);
    this.group = new Group();
    this.geometry = new BufferGeometry();
    this.#stitch();
    this.air = {
      onMap: { value: 0 },
      unit: { value: this.unit * land.cells },
      near: { value: 0 },
      backdrop: { value: 0 },
      dark: { value: 0 },
      sunThere: { value: new Vector3(0, 1, 0) },
      horizon: { value: new Vector3(1, 1, 1) },
      zenith: { value: new Vector3(1, 1, 1) },
      grain: { value: grain() },
    };
    this.group.add(new Mesh(this.geometry, this.#material()));
    this.walls = new Mesh(
      this.#wallsGeometry(),
      new ShaderMaterial({
        glslVersion: GLSL3,
        vertexShader: wallVertexShader,
        fragmentShader: wallShader,
        uniforms: this.air,
        side: DoubleSide,
      }),
    );
    this.group.add(this.walls);
    this.sky = new Mesh(new SphereGeometry(40, 24, 16), this.#plain(skyShader, { depthWrite: false, side: BackSide }));
    this.sky.renderOrder = 2; // where nothing else is
    this.sky.frustumCulled = false;
    this.half = { value: new Vector2(this.halfX, this.halfZ) };
    this.ocean = new Mesh(
      new PlaneGeometry(70, 70).rotateX(-Math.PI / 2),
      this.#plain(seaShader, {}, { half_: this.half, surf: this.uniforms.surf }),
    );
    this.ocean.renderOrder = 1;
  }

  #measure(land, lakes, sea) {
    this.land = land;
    this.lakes = lakes;
    this.sea = sea;
    const { width, height } = land.grid;
    this.unit = 2 / Math.max(width, height); // of space a cell
    this.halfX = (width * this.unit) / 2;
    this.halfZ = (height * this.unit) / 2;
    this.perMetre = this.unit / land.grid.cell_m;
    if (this.field?.of !== `${width} ${height}`) {
      this.field = Object.assign(new LineField(land.grid), { of: `${width} ${height}` });
    }
    // As many stitches as asked along the longer side, never more than values.
    const most = Math.max(land.width, land.height);
    this.columns = Math.max(1, Math.min(land.width, Math.round((this.segments * land.width) / most)));
    this.rows = Math.max(1, Math.min(land.height, Math.round((this.segments * land.height) / most)));
  }

  /** Puts other land in the place of this: raise(), shine(), paint() and lines() must follow. */
  replace(land, lakes, sea) {
    const before = { grid: this.land.grid, columns: this.columns, rows: this.rows };
    const sameFrame = ['width', 'height'].every((key) => before.grid[key] === land.grid[key]);
    this.#measure(land, lakes, sea);
    // Coarse land is laid on the finer mesh that is there already.
    if (sameFrame && before.columns >= this.columns && before.rows >= this.rows) {
      Object.assign(this, { columns: before.columns, rows: before.rows });
    }
    if (sameFrame && before.columns === this.columns && before.rows === this.rows) {
      this.#lay();
      for (const name of ['position', 'uv']) this.geometry.getAttribute(name).needsUpdate = true;
    } else {
      this.geometry.dispose();
      this.#stitch();
      this.walls.geometry.dispose();
      this.walls.geometry = this.#wallsGeometry();
    }
    this.geometry.boundingSphere = null; // reckoned when it is next drawn
    const u = this.uniforms;
    const { width, height } = land;
    if (u.values.value !== u.heights.value) u.values.value.dispose();
    const { image } = u.heights.value;
    if (image.width === width && image.height === height) {
      image.data = land.z;
      u.heights.value.needsUpdate = true;
    } else {
      u.heights.value.dispose();
      u.heights.value = texture(
        land.z,
        width,
        height,
        RedFormat,
        FloatType,
        this.linear ? LinearFilter : NearestFilter,
      );
    }
    u.values.value = u.heights.value;
    this.slope = slopes(land);
    u.cover.value.dispose();
    u.cover.value = this.#cover();
    u.size.value.set(width, height);
    u.fine.value.set(this.field.width, this.field.height);
    Object.assign(u.holes, { value: land.has ? 1 : 0 });
    Object.assign(u.sea, { value: sea && land.has ? 1 : 0 });
    Object.assign(u.level, { value: land.level ? 1 : 0 });
    u.withPart.value = 0;
    this.air.unit.value = this.unit * land.cells;
    this.half.value.set(this.halfX, this.halfZ);
  }

  #plain(fragment, options, uniforms = {}) {
    return new ShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: plainVertexShader,
      fragmentShader: fragment,
      uniforms: { ...this.air, ...uniforms },
      ...options,
    });
  }

  #stitch() {
    const { columns, rows } = this;
    this.positions = new Float32Array((columns + 1) * (rows + 1) * 3);
    this.uvs = new Float32Array((columns + 1) * (rows + 1) * 2);
    this.#lay();
    const index = new Uint32Array(columns * rows * 6);
    for (let r = 0, k = 0; r < rows; ++r) {
      for (let c = 0; c < columns; ++c) {
        const a = r * (columns + 1) + c;
        const b = a + columns + 1;
        index.set([a, b, a + 1, b, b + 1, a + 1], k);
        k += 6;
      }
    }
    this.geometry.setAttribute('position', new BufferAttribute(this.positions, 3));
    this.geometry.setAttribute('uv', new BufferAttribute(this.uvs, 2));
    this.geometry.setIndex(new BufferAttribute(index, 1));
  }

  /** The mesh's places on the land. */
  #lay() {
    const { columns, rows, land, positions, uvs } = this;
    const { width, height } = land.grid;
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
  }

  #material() {
    const { land, linear } = this;
    const { width, height } = land;
    const filter = linear ? LinearFilter : NearestFilter;
    const heights = texture(land.z, width, height, RedFormat, FloatType, filter);
    this.slope = slopes(land);
    const one = new Float32Array(4);
    this.uniforms = {
      ...this.air,
      heights: { value: heights },
      values: { value: heights },
      surf: { value: null },
      cover: { value: this.#cover() },
      shadow: { value: texture(new Uint8Array([255]), 1, 1, RedFormat, UnsignedByteType, LinearFilter) },
      palette: { value: null },
      size: { value: new Vector2(width, height) },
      fine: { value: new Vector2(this.field.width, this.field.height) },
      nearest: { value: texture(new Float32Array(1), 1, 1, RedFormat, FloatType, NearestFilter) },
      segments: { value: texture(one, 1, 1, RGBAFormat, FloatType, NearestFilter) },
      styles: { value: texture(one, 1, 1, RGBAFormat, FloatType, NearestFilter) },
      holes: { value: land.has ? 1 : 0 },
      sea: { value: this.sea && land.has ? 1 : 0 },
      low: { value: land.min },
      high: { value: land.max },
      gain: { value: 1 },
      contour: { value: 0 },
      index: { value: 5 },
      dpr: { value: 1 },
      byClass: { value: 0 },
      withLines: { value: 0 },
      lineByClass: { value: 0 },
      part: { value: texture(new Uint8Array(1), 1, 1, RedFormat, UnsignedByteType, LinearFilter) },
      withPart: { value: 0 },
      lineColours: { value: Array.from({ length: 8 }, () => new Vector3()) },
      level: { value: land.level ? 1 : 0 },
      sun: { value: new Vector3(0, 1, 0) },
    };
    return new ShaderMaterial({
      glslVersion: GLSL3,
      vertexShader,
      fragmentShader,
      uniforms: this.uniforms,
      side: DoubleSide,
      defines: linear ? { LINEAR: 1 } : {},
    });
  }

  /** Land (blurred where it fades at a mask) and lakes, and how far water is from its shore. */
  #cover() {
    const { land, lakes } = this;
    const { width, height } = land;
    this.shore = null;
    if (!land.has && !lakes) return texture(new Uint8Array([255, 0]), 1, 1, RGFormat, UnsignedByteType, LinearFilter);
    const bytes = new Uint8Array(2 * width * height);
    this.shore = new Float32Array(width * height);
    if (land.has) {
      const dry = this.sea ? null : distanceInside(land.has, width, height, 8);
      for (let i = 0; i < land.has.length; ++i) bytes[2 * i] = this.sea ? land.has[i] : Math.min(255, 36 * dry[i]);
      if (this.sea) this.shore = distanceInside(land.has.map((h) => (h ? 0 : 1)), width, height, farthestShore);
    } else {
      for (let i = 0; i < width * height; ++i) bytes[2 * i] = 255;
    }
    if (lakes) {
      const inside = distanceInside(lakes, width, height, farthestShore);
      for (let i = 0; i < lakes.length; ++i) {
        bytes[2 * i + 1] = lakes[i];
        if (lakes[i]) this.shore[i] = inside[i];
      }
    }
    return texture(bytes, width, height, RGFormat, UnsignedByteType, LinearFilter);
  }

  /** Slopes, sky view and distance from the shore as one texture with its mipmaps. */
  #surface() {
    const { land, shore, lift } = this;
    const { width, height } = land;
    const { east, south } = this.slope;
    // A draft has the sky of the land before it, which is nearly the same and costs nothing.
    if (!land.level && !(land.draft && this.#seen)) this.#seen = skyView(land, lift, this.skyValues);
    const sky = land.level ? null : this.#seen;
    let at = { data: new Float32Array(4 * width * height), width, height };
    for (let r = 0, i = 0; r < height; ++r) {
      const v = sky ? Math.min(Math.max(((r + 0.5) * sky.height) / height - 0.5, 0), sky.height - 1) : 0;
      const r0 = Math.floor(v);
      const r1 = sky ? Math.min(r0 + 1, sky.height - 1) : 0;
      for (let c = 0; c < width; ++c, ++i) {
        let seen = 1;
        if (sky) {
          const u = Math.min(Math.max(((c + 0.5) * sky.width) / width - 0.5, 0), sky.width - 1);
          const c0 = Math.floor(u);
          const c1 = Math.min(c0 + 1, sky.width - 1);
          const s = sky.seen;
          const fu = u - c0;
          const fv = v - r0;
          seen =
            (s[r0 * sky.width + c0] * (1 - fu) + s[r0 * sky.width + c1] * fu) * (1 - fv) +
            (s[r1 * sky.width + c0] * (1 - fu) + s[r1 * sky.width + c1] * fu) * fv;
        }
        at.data[4 * i] = east[i];
        at.data[4 * i + 1] = south[i];
        at.data[4 * i + 2] = seen;
        at.data[4 * i + 3] = shore ? shore[i] : 0;
      }
    }
    const mipmaps = [];
    for (;;) {
      mipmaps.push({ data: halves(at.data), width: at.width, height: at.height });
      if (at.width === 1 && at.height === 1) break;
      at = halved(at.data, at.width, at.height, 4);
    }
    const t = texture(mipmaps[0].data, width, height, RGBAFormat, HalfFloatType, LinearFilter);
    t.mipmaps = mipmaps;
    t.minFilter = LinearMipmapLinearFilter;
    t.generateMipmaps = false;
    this.uniforms.surf.value?.dispose();
    this.uniforms.surf.value = t;
  }

  /** azimuth and altitude of the sun [rad]. */
  shine(azimuth, altitude) {
    const there = new Vector3(
      Math.sin(azimuth) * Math.cos(altitude),
      Math.sin(altitude),
      -Math.cos(azimuth) * Math.cos(altitude),
    );
    this.uniforms.sun.value.copy(there);
    this.air.sunThere.value.copy(there);
    if (this.land.level) return;
    const light = sunlight(this.land, azimuth, altitude, this.lift);
    this.uniforms.shadow.value.dispose();
    this.uniforms.shadow.value = texture(
      light,
      this.land.width,
      this.land.height,
      RedFormat,
      UnsignedByteType,
      LinearFilter,
    );
  }

  /**
   * Colours the ground by one number a value. palette: bytes of 256 colours RGBA; by class: the number is a colour's.
   */
  paint({ values, low, high, palette, byClass }) {
    const u = this.uniforms;
    const { width, height } = this.land;
    if (u.values.value !== u.heights.value) u.values.value.dispose();
    u.values.value = values
      ? texture(values, width, height, RedFormat, FloatType, byClass || !this.linear ? NearestFilter : LinearFilter)
      : u.heights.value;
    u.palette.value?.dispose();
    u.palette.value = texture(palette, 256, 1, RGBAFormat, UnsignedByteType, byClass ? NearestFilter : LinearFilter);
    Object.assign(u.low, { value: low });
    Object.assign(u.high, { value: high });
    u.byClass.value = byClass ? 1 : 0;
  }

  /** Shows a part of the land, 255 by value within it; null: none. */
  emphasize(inside) {
    const u = this.uniforms;
    u.withPart.value = inside ? 1 : 0;
    if (!inside) return;
    u.part.value.dispose();
    u.part.value = texture(inside, this.land.width, this.land.height, RedFormat, UnsignedByteType, LinearFilter);
  }

  /** Draws groups of lines (riverfield.js) on the land in place of those before. */
  lines(groups) {
    const u = this.uniforms;
    const { field } = this;
    u.withLines.value = groups.some(({ lines }) => lines.length) ? 1 : 0;
    if (!u.withLines.value) return;
    field.build(groups);
    /** @type {[string, Float32Array, number, number, any][]} */
    const tables = [
      ['nearest', field.nearest, field.width, field.height, RedFormat],
      ['segments', field.segments, LineField.columns, field.rows, RGBAFormat],
      ['styles', field.styles, LineField.columns, field.rows, RGBAFormat],
    ];
    for (const [name, data, width, height, format] of tables) {
      u[name].value.dispose();
      u[name].value = texture(data, width, height, format, FloatType, NearestFilter);
    }
  }

  /** Walls from the border down to a base, so that the land reads as a block. */
  #wallsGeometry() {
    const { columns, rows } = this;
    const rim = [];
    for (let c = 0; c <= columns; ++c) rim.push(c);
    for (let r = 1; r <= rows; ++r) rim.push(r * (columns + 1) + columns);
    for (let c = columns - 1; c >= 0; --c) rim.push(rows * (columns + 1) + c);
    for (let r = rows - 1; r >= 0; --r) rim.push(r * (columns + 1));
    this.rim = rim;
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(new Float32Array(rim.length * 6), 3));
    geometry.setAttribute('rim', new BufferAttribute(new Float32Array(rim.length * 6), 3));
    const index = [];
    for (let i = 0; i + 1 < rim.length; ++i) index.push(2 * i, 2 * i + 1, 2 * i + 2, 2 * i + 1, 2 * i + 3, 2 * i + 2);
    geometry.setIndex(index);
    return geometry;
  }

  /** Vertical exaggeration. */
  raise(lift) {
    this.lift = lift;
    this.group.scale.y = lift;
    const depth = Math.max(0.05, 0.12 * (this.land.max - this.land.min) * this.perMetre * lift);
    const base = -depth / lift; // the plinth keeps its height
    const wall = this.walls.geometry.getAttribute('position');
    const edge = this.walls.geometry.getAttribute('rim');
    this.rim.forEach((at, i) => {
      const [x, y, z] = this.positions.subarray(3 * at, 3 * at + 3);
      wall.array.set([x, y, z, x, base, z], 6 * i);
      const wet =
        this.sea &&
        !this.land.known(
          Math.min((x + this.halfX) / this.unit, this.land.grid.width - 1e-6),
          Math.min((z + this.halfZ) / this.unit, this.land.grid.height - 1e-6),
        )
          ? 1
          : 0;
      edge.array.set([y, base, wet, y, base, wet], 6 * i);
    });
    wall.needsUpdate = edge.needsUpdate = true;
    this.walls.geometry.computeBoundingSphere();
    this.walls.visible = (this.land.holes === 0 || Boolean(this.sea)) && !this.land.level && !this.sea?.around;
    this.ocean.position.y = this.sea ? (this.sea.level - this.land.min) * this.perMetre * lift - 2e-4 : 0;
    this.ocean.visible = Boolean(this.sea?.around);
    this.#surface();
  }

  /**
   * Places that must be in sight, in space as raised: the rim and the foot of the corners, or the edge of land in the
   * sea.
   */
  corners() {
    const out = [];
    const { land } = this;
    if (land.has) {
      const stride = Math.max(1, Math.floor(Math.max(land.width, land.height) / 64));
      for (let r = 0; r < land.height; r += stride) {
        for (let c = 0; c < land.width; c += stride) {
          const i = r * land.width + c;
          if (!land.has[i]) continue;
          out.push(
            new Vector3(
              (c + 0.5) * land.cells * this.unit - this.halfX,
              (land.z[i] - land.min) * this.perMetre * this.lift,
              (r + 0.5) * land.cells * this.unit - this.halfZ,
            ),
          );
        }
      }
      return out;
    }
    const wall = this.walls.geometry.getAttribute('position').array;
    const stride = 6 * Math.max(1, Math.floor(this.rim.length / 200));
    for (let i = 0; i < wall.length; i += stride) {
      out.push(
        new Vector3(wall[i], wall[i + 1] * this.lift, wall[i + 2]),
        new Vector3(wall[i + 3], wall[i + 4] * this.lift, wall[i + 5]),
      );
    }
    return out;
  }

  /** A place of the land [cells] in space, as raised. */
  spot(x, y) {
    return new Vector3(
      x * this.unit - this.halfX,
      (this.land.heightAt(x, y) - this.land.min) * this.perMetre * this.lift,
      y * this.unit - this.halfZ,
    );
  }

  /** Where a ray first meets the land: {x, y} [cells], or null. Straight steps of half a value, then bisection. */
  meet(ray, pace = 0.5) {
    const { origin, direction } = ray;
    const roof = (this.land.max - this.land.min) * this.perMetre * this.lift + 1e-6;
    let from = 0;
    let to = Infinity;
    for (const [o, d, least, most] of [
      [origin.x, direction.x, -this.halfX, this.halfX],
      [origin.y, direction.y, -1e-6, roof],
      [origin.z, direction.z, -this.halfZ, this.halfZ],
    ]) {
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
    /** @type {(t: number) => [number, number]} */
    const place = (t) => [
      (origin.x + t * direction.x + this.halfX) / this.unit,
      (origin.z + t * direction.z + this.halfZ) / this.unit,
    ];
    const above = (t) =>
      origin.y + t * direction.y - (this.land.heightAt(...place(t)) - this.land.min) * this.perMetre * this.lift;
    const step = pace * this.land.cells * this.unit;
    let before = from;
    for (let t = from; ; t = Math.min(t + step, to)) {
      if (above(t) <= 1e-9 && this.#solid(place(t))) {
        let out = before;
        let into = t;
        for (let k = 0; k < 40; ++k) {
          const middle = (out + into) / 2;
          if (above(middle) > 0) out = middle;
          else into = middle;
        }
        const [x, y] = place(into);
        return { x, y, t: into };
      }
      before = t;
      if (t >= to) return null;
    }
  }

  #solid([x, y]) {
    return (
      this.land.level ||
      Boolean(this.sea) ||
      this.land.known(Math.min(x, this.land.grid.width - 1e-6), Math.min(y, this.land.grid.height - 1e-6))
    );
  }
}
