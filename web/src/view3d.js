// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The view by WebGL: orbit around the land, or a map with north above.
import {
  ColorManagement,
  LinearSRGBColorSpace,
  MathUtils,
  OrthographicCamera,
  PerspectiveCamera,
  Raycaster,
  Scene,
  Spherical,
  Vector2,
  Vector3,
  WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { Ground } from './ground.js';
import { contourPlaces, Labels } from './labels.js';
import { riverWidth } from './riverfield.js';

ColorManagement.enabled = false;

/** What the machine draws with, on the canvas of the view to be, or null when there is no WebGL 2. */
export function probe(antialias) {
  const make = (smooth) => {
    const canvas = document.createElement('canvas');
    const context = canvas.getContext('webgl2', { antialias: smooth, preserveDrawingBuffer: true, alpha: false });
    return /** @type {WebGL2RenderingContext | null} */ (context);
  };
  const gl = make(false); // in software smoothing costs more than all else
  if (!gl) return null;
  const info = gl.getExtension('WEBGL_debug_renderer_info');
  const name = String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  const largest = gl.getParameter(gl.MAX_TEXTURE_SIZE);
  const linear = gl.getExtension('OES_texture_float_linear') !== null;
  const software = /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
  let context = gl;
  if (antialias && !software) {
    context = make(true) ?? gl;
    if (context !== gl) gl.getExtension('WEBGL_lose_context')?.loseContext();
  }
  return { context, name, largest, linear, software };
}

const skies = {
  light: { horizon: [222, 230, 236], zenith: [142, 178, 212], dark: 0 },
  dark: { horizon: [58, 66, 78], zenith: [20, 25, 34], dark: 1 },
};

export class View3d {
  mode = 'webgl2';
  onmap = false;
  /** Of the sun [°]. @type {number | undefined} */
  azimuth;
  /** @type {number | undefined} */
  altitude;
  /** The view has been drawn, turned by an angle. @type {((turn: number) => void) | undefined} */
  ondraw;
  /** Gives the boxes that labels keep out of. @type {(() => object[]) | undefined} */
  keepOut;
  /** The graphics device was lost. @type {(() => void) | undefined} */
  onlost;
  /** It is there again. @type {(() => void) | undefined} */
  onfound;
  marks = []; // places [cells] shown by a ring
  #hurried = false;
  #patience;

  constructor(parent, land, rivers, options, gl) {
    this.software = gl.software;
    this.parent = parent;
    this.land = land;
    this.rivers = rivers;
    this.renderer = new WebGLRenderer({ canvas: gl.context.canvas, context: gl.context });
    this.renderer.debug.checkShaderErrors = false;
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.canvas = this.renderer.domElement;
    parent.append(this.canvas);
    this.labels = new Labels(parent);
    this.scene = new Scene();
    this.ground = new Ground(
      land,
      options.segments ?? (gl.software ? 255 : 1023),
      gl.linear,
      options.lakes,
      options.sea,
      gl.software ? 256 : 512,
    );
    this.scene.add(this.ground.group, this.ground.sky, this.ground.ocean);
    this.perspective = new PerspectiveCamera(32, 1, 0.02, 90);
    this.flat = new OrthographicCamera(-1, 1, 1, -1, 0.02, 60);
    /** @type {any} */
    this.controls = new OrbitControls(this.perspective, this.canvas);
    this.controls.maxPolarAngle = 0.495 * Math.PI;
    this.controls.minDistance = 0.05;
    this.controls.maxDistance = 12;
    this.controls.zoomToCursor = true;
    this.controls.addEventListener('change', () => this.redraw());
    this.canvas.addEventListener('webglcontextlost', (event) => {
      event.preventDefault(); // then the browser gives it back
      this.onlost?.();
    });
    this.canvas.addEventListener('webglcontextrestored', () => {
      this.onfound?.();
      this.redraw();
    });
    this.names = [];
    this.contour = 0;
  }

  /**
   * Shows other land or rivers from where the view stands; look(), paint() and showLines() must follow, and home()
   * where the grid is another. Heights that stay the same stay where they are on the screen.
   */
  replace(land, rivers, { lakes, sea }) {
    this.rivers = rivers;
    const { ground } = this;
    if (land === this.land && lakes === ground.lakes) return;
    const lift = land.level ? 1 : (ground.lift ?? 1);
    const sunk = (this.land.min - land.min) * ground.perMetre * lift;
    const near = Math.abs(this.land.min - land.min) < 0.1 * (land.max - land.min);
    this.land = land;
    ground.replace(land, lakes, sea);
    if (near && !this.onmap) {
      this.controls.target.y += sunk;
      this.perspective.position.y += sunk;
    }
    ground.raise(lift);
    this.azimuth = undefined; // look() shades it
    this.places = undefined;
  }

  get aspect() {
    return this.parent.clientWidth / Math.max(1, this.parent.clientHeight);
  }

  /** The first view: from the south, as near as shows all of the land; lower over wide windows. */
  home() {
    const { ground, land } = this;
    const centre = ground.spot(land.grid.width / 2, land.grid.height / 2);
    const camera = this.perspective;
    camera.aspect = this.aspect;
    camera.updateProjectionMatrix();
    const above = MathUtils.clamp(
      Math.asin(Math.min(1, (0.78 * land.grid.width) / land.grid.height / this.aspect)),
      MathUtils.degToRad(27),
      MathUtils.degToRad(58),
    );
    const corners = ground.corners();
    const p = new Vector3();
    const room = -0.03; // for the buttons above
    const { target } = this.controls;
    target.copy(centre);
    const box = { left: 0, right: 0, top: 0, bottom: 0 };
    const stand = (away) => {
      camera.position.setFromSpherical(new Spherical(away, Math.PI / 2 - above, MathUtils.degToRad(14))).add(target);
      camera.lookAt(target);
      camera.updateMatrixWorld();
    };
    let away = 9;
    let held = target.clone();
    for (let next = away; next > 0.5; next *= 0.98) {
      // The land's frame comes to the middle of the view.
      for (let turn = 0; turn < 2; ++turn) {
        stand(next);
        Object.assign(box, { left: Infinity, right: -Infinity, top: -Infinity, bottom: Infinity });
        for (const corner of corners) {
          p.copy(corner).project(camera);
          box.left = Math.min(box.left, p.x);
          box.right = Math.max(box.right, p.x);
          box.top = Math.max(box.top, p.y);
          box.bottom = Math.min(box.bottom, p.y);
        }
        const half = next * Math.tan(MathUtils.degToRad(camera.fov / 2));
        const sideways = new Vector3().setFromMatrixColumn(camera.matrixWorld, 0);
        const ahead = new Vector3().crossVectors(new Vector3(0, 1, 0), sideways);
        target.add(sideways.multiplyScalar(((box.left + box.right) / 2) * half * camera.aspect));
        target.add(ahead.multiplyScalar(((box.top + box.bottom) / 2 - room) * (half / Math.sin(above))));
      }
      if (box.right - box.left > 1.94 || box.top - box.bottom > 1.86) break;
      away = next;
      held = target.clone();
    }
    target.copy(held);
    stand(away);
    this.flat.zoom = 1;
    this.flat.position.set(centre.x, 20, centre.z);
    this.controls.update();
    this.moved = true;
    this.resize();
  }

  map(on) {
    this.onmap = on;
    const { target } = this.controls;
    this.controls.object = on ? this.flat : this.perspective;
    this.controls.enableRotate = !on;
    this.ground.air.onMap.value = on ? 1 : 0;
    this.ground.sky.visible = !on;
    if (on) {
      target.set(0, 0, 0);
      this.flat.up.set(0, 0, -1);
      this.flat.position.set(0, 20, 0);
      this.flat.zoom = 1;
      this.flat.lookAt(target);
      this.controls.mouseButtons.LEFT = 2; // pan
      this.controls.touches.ONE = 1;
    } else {
      this.controls.mouseButtons.LEFT = 0;
      this.controls.touches.ONE = 0;
      this.home();
    }
    this.controls.update();
    this.moved = true;
    this.resize();
  }

  /** Turns the view to a place [cells] and comes near. */
  fly(x, y) {
    const { ground } = this;
    const to = ground.spot(x, y);
    const { object, target } = this.controls;
    const by = to.clone().sub(target);
    object.position.add(this.onmap ? by.setY(0) : by);
    target.copy(this.onmap ? to.setY(0) : to);
    if (this.onmap) {
      this.flat.zoom = Math.max(this.flat.zoom, 4);
      this.flat.updateProjectionMatrix();
    } else {
      const arm = new Spherical().setFromVector3(object.position.clone().sub(target));
      arm.radius = Math.min(arm.radius, 0.9);
      object.position.setFromSpherical(arm).add(target);
    }
    this.controls.update();
    this.redraw();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.parent;
    const frame = `${width} ${height}`;
    if (width === 0 || height === 0 || (frame === this.frame && !this.moved)) return;
    this.frame = frame;
    this.moved = false;
    this.perspective.aspect = width / height;
    this.perspective.updateProjectionMatrix();
    const fit = 1.02 * Math.max(this.ground.halfZ, this.ground.halfX / this.perspective.aspect);
    Object.assign(this.flat, {
      left: -fit * this.perspective.aspect,
      right: fit * this.perspective.aspect,
      top: fit,
      bottom: -fit,
    });
    this.flat.updateProjectionMatrix();
    this.draw();
  }

  look({ exaggeration, contour, azimuth, altitude, shadeGain }) {
    const { ground, land } = this;
    const lift = land.level ? 1 : exaggeration;
    const raised = lift !== ground.lift;
    if (raised) {
      const before = ground.lift;
      ground.raise(lift);
      if (before) {
        const y = this.controls.target.y * (lift / before - 1);
        this.controls.target.y += y;
        this.perspective.position.y += y;
      }
    }
    this.shadeGain = shadeGain;
    this.contour = land.level ? 0 : contour;
    if (raised || azimuth !== this.azimuth || altitude !== this.altitude) {
      Object.assign(this, { azimuth, altitude });
      ground.shine(MathUtils.degToRad(azimuth), MathUtils.degToRad(altitude));
    }
    this.controls.update();
    this.redraw();
  }

  paint(painted) {
    this.ground.paint(painted);
    this.redraw();
  }

  /** Shows a part of the land, 255 by value within it; null: none. Other land in its place shows none. */
  emphasize(inside) {
    this.ground.emphasize(inside);
    this.redraw();
  }

  /**
   * orders: by arc, 0: not shown. styles: by order {width, share}; ridges: whether to draw them; marked: lines to mark.
   */
  showLines({ orders, styles, ridges, marked, byClass, colours }) {
    const { rivers, land, ground } = this;
    const groups = styles.map(({ width, share }) => ({ lines: [], arcs: [], pixels: width, share, kind: 0 }));
    orders.forEach((order, k) => {
      if (order <= 0) return;
      const group = groups[Math.min(order, groups.length) - 1];
      group.lines.push(rivers.lines[k]);
      group.arcs.push(k);
    });
    const side = 2 * ground.field.cells * land.grid.cell_m;
    for (const group of groups) {
      group.half = (l) =>
        riverWidth((rivers.arcs.us_area[group.arcs[l]] + rivers.arcs.ds_area[group.arcs[l]]) / 2) / side;
    }
    if (ridges && rivers.ridges.length) {
      groups.unshift({ lines: rivers.ridges, half: 0, pixels: 1.3, share: 0, kind: 1 });
    }
    groups.push({ lines: marked, half: 0, pixels: 3.2, share: 1, kind: 2 });
    this.ground.uniforms.lineByClass.value = byClass ? 1 : 0;
    if (byClass) this.ground.uniforms.lineColours.value = colours.map((c) => new Vector3(...c.map((v) => v / 255)));
    this.ground.lines(groups);
    this.redraw();
  }

  theme(name) {
    const { horizon, zenith, dark } = skies[name];
    const { air } = this.ground;
    air.horizon.value.fromArray(horizon.map((c) => c / 255));
    air.zenith.value.fromArray(zenith.map((c) => c / 255));
    air.dark.value = dark;
    this.labels.dark = dark === 1;
    this.renderer.setClearColor((horizon[0] << 16) | (horizon[1] << 8) | horizon[2]);
    this.redraw();
  }

  redraw() {
    this.waiting ??= requestAnimationFrame(() => this.draw());
  }

  /** While more is to come, for a second and a half at most, a renderer in software draws no fine pictures. */
  hurry(on) {
    clearTimeout(this.#patience);
    if (on) {
      this.resting = undefined; // what waits is drawn later
      this.#patience = setTimeout(() => this.hurry(false), 1500);
    } else if (this.#hurried) this.redraw();
    this.#hurried = on;
  }

  /** Draws; a renderer in software draws coarsely while the view moves, and finely when it rests. */
  draw(fine = !this.software) {
    if (this.waiting) cancelAnimationFrame(this.waiting);
    this.waiting = undefined;
    const rest = (this.resting = fine || this.#hurried ? undefined : {});
    if (rest) {
      // The coarse picture is shown before the fine one is begun.
      const wait = (frames) => {
        if (this.resting !== rest) return;
        if (frames > 0) requestAnimationFrame(() => wait(frames - 1));
        else setTimeout(() => this.resting === rest && this.draw(true), 160);
      };
      wait(2);
    }
    this.ratio = Math.min(window.devicePixelRatio || 1, 2) * (fine ? 1 : this.size ? 0.55 : 0.4);
    const { clientWidth: width, clientHeight: height } = this.parent;
    const size = `${width} ${height} ${this.ratio}`;
    if (size !== this.size) this.renderer.setDrawingBufferSize(width, height, this.ratio);
    this.size = size;
    this.ground.uniforms.dpr.value = this.ratio;
    const { ground } = this;
    const u = ground.uniforms;
    const lift = ground.lift ?? 1;
    u.gain.value = this.onmap ? this.shadeGain ?? 1 : lift;
    // On the map contours thin out until they have room: 1, 2, 5, 10, …
    let step = this.contour;
    if (this.onmap && step > 0) {
      const steep = Math.max(this.land.steepness(), 1e-6) * this.land.grid.cell_m;
      while (step / steep / this.cellsPerPixel < 5) {
        step *= Math.floor(step / 10 ** Math.floor(Math.log10(step) + 1e-9) + 1e-9) === 2 ? 2.5 : 2;
      }
    }
    u.contour.value = step;
    // Every fifth is heavier and labelled, as before they thinned out where that is one of those drawn.
    const index = step > 0 && Number.isInteger((5 * this.contour) / step) ? 5 * this.contour : 5 * step;
    u.index.value = step > 0 ? index / step : 5;
    if (this.places?.index !== index) this.places = { index, list: contourPlaces(this.land, index, 40) };
    this.drawn = { step, index };
    ground.air.near.value = Math.max(0, this.perspective.position.distanceTo(this.controls.target) - 0.7);
    ground.air.backdrop.value = ground.sea?.around ? 0 : this.renderer.domElement.height;
    if (this.onmap) ground.ocean.visible = false;
    else ground.ocean.visible = Boolean(ground.sea?.around);
    this.renderer.render(this.scene, this.controls.object);
    this.#write();
    this.ondraw?.(this.controls.getAzimuthalAngle());
  }

  /** When nothing waits to be drawn. */
  async still() {
    while (this.waiting || this.resting) await new Promise((done) => setTimeout(done, 30));
  }

  /**
   * A place [cells] on the page [pixels], {x, y}, behind what stands before it and beside the view too; null: behind
   * the camera.
   */
  place(x, y) {
    const p = this.ground.spot(x, y).project(this.controls.object);
    return p.z > 1
      ? null
      : { x: ((p.x + 1) / 2) * this.parent.clientWidth, y: ((1 - p.y) / 2) * this.parent.clientHeight };
  }

  /** A place [cells] on the page [pixels], {x, y}, or null where it is not in sight. */
  project(x, y) {
    const camera = this.controls.object;
    const spot = this.ground.spot(x, y);
    const p = spot.clone().project(camera);
    if (Math.abs(p.x) > 1 || Math.abs(p.y) > 1 || p.z > 1) return null;
    if (!this.onmap) {
      const ray = { origin: camera.position, direction: spot.clone().sub(camera.position).normalize() };
      const met = this.ground.meet(ray, 3);
      if (met && met.t < spot.distanceTo(camera.position) - 5 * this.ground.unit * this.land.cells) return null;
    }
    return { x: ((p.x + 1) / 2) * this.parent.clientWidth, y: ((1 - p.y) / 2) * this.parent.clientHeight };
  }

  #write() {
    const labels = [];
    this.controls.object.updateMatrixWorld();
    // The nearer, the more is named.
    const room = Math.round(
      8 *
        Math.max(
          1,
          Math.max(this.land.grid.width, this.land.grid.height) / this.parent.clientWidth / this.cellsPerPixel,
        ),
    );
    let named = 0;
    for (const { x, y, text, kind } of this.names) {
      if (named >= room) break;
      const at = this.project(x, y);
      if (at) labels.push({ text, kind, ...at });
      named += at ? 1 : 0;
    }
    if (this.contour > 0 && this.places) {
      let written = 0;
      for (const { x, y, z, dx, dy } of this.places.list) {
        if (written >= 1.5 * room) break;
        const at = this.project(x, y);
        const length = Math.hypot(dx, dy) || 1;
        const on = at && this.project(x + (2 * dx) / length, y + (2 * dy) / length);
        if (!on) continue;
        let angle = Math.atan2(on.y - at.y, on.x - at.x);
        if (angle > Math.PI / 2) angle -= Math.PI;
        if (angle < -Math.PI / 2) angle += Math.PI;
        labels.push({ text: String(Math.round(z * 1000) / 1000), kind: 'contour', angle, ...at });
        ++written;
      }
    }
    const marks = this.marks.map(([x, y]) => this.project(x, y)).filter(Boolean).map(({ x, y }) => [x, y]);
    this.labels.draw(
      labels,
      this.cellsPerPixel * this.land.grid.cell_m,
      marks,
      Math.min(window.devicePixelRatio || 1, 2),
      this.keepOut?.() ?? [],
    );
  }

  /** The place under a pixel of the canvas, {x, y} in cells, or null. */
  under(px, py) {
    const pointer = new Vector2((2 * px) / this.parent.clientWidth - 1, 1 - (2 * py) / this.parent.clientHeight);
    const caster = new Raycaster();
    this.controls.object.updateMatrixWorld();
    caster.setFromCamera(pointer, this.controls.object);
    return this.ground.meet(caster.ray);
  }

  /** Cells that one pixel covers about the middle of the view. */
  get cellsPerPixel() {
    const camera = this.controls.object;
    const high = this.onmap ? (camera.top - camera.bottom) / camera.zoom
      : 2 * camera.position.distanceTo(this.controls.target) * Math.tan(MathUtils.degToRad(camera.fov / 2));
    return high / this.parent.clientHeight / this.ground.unit;
  }

  /** Moves the view: turns [rad] to the side and up, pans [share of the view], zooms [factor]. */
  move({ turn = 0, tip = 0, right = 0, up = 0, zoom = 1 }) {
    const { object, target } = this.controls;
    if (right || up) {
      const reach = this.cellsPerPixel * this.parent.clientHeight * this.ground.unit;
      const sideways = new Vector3().setFromMatrixColumn(object.matrixWorld, 0).setY(0).normalize();
      const forward = new Vector3().crossVectors(new Vector3(0, 1, 0), sideways);
      const by = sideways.multiplyScalar(right * reach).add(forward.multiplyScalar(up * reach));
      object.position.add(by);
      target.add(by);
    }
    if (this.onmap) {
      object.zoom = MathUtils.clamp(object.zoom * zoom, 0.2, 60);
      object.updateProjectionMatrix();
    } else {
      const arm = new Spherical().setFromVector3(object.position.clone().sub(target));
      arm.theta += turn;
      arm.phi = MathUtils.clamp(arm.phi + tip, 0.02, this.controls.maxPolarAngle);
      arm.radius = MathUtils.clamp(arm.radius / zoom, this.controls.minDistance, this.controls.maxDistance);
      object.position.setFromSpherical(arm).add(target);
    }
    this.controls.update();
    this.redraw();
  }
}
