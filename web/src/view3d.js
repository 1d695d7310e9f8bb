// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The view by WebGL: orbit around the block of land, or a map with north above.
import { Color, ColorManagement, LinearSRGBColorSpace, MathUtils, OrthographicCamera, PerspectiveCamera, Raycaster, Scene, Spherical,
  Vector2, Vector3, WebGLRenderer } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { Ground } from './ground.js';
import { DrapedLines } from './draped.js';
import { markColour, ridgeColour, riverStyle } from './colours.js';

ColorManagement.enabled = false;

/** What the machine draws with, or null when there is no WebGL 2. */
export function probe() {
  const gl = document.createElement('canvas').getContext('webgl2');
  if (!gl) return null;
  const info = gl.getExtension('WEBGL_debug_renderer_info');
  const name = String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  const largest = gl.getParameter(gl.MAX_TEXTURE_SIZE);
  const linear = gl.getExtension('OES_texture_float_linear') !== null;
  gl.getExtension('WEBGL_lose_context')?.loseContext();
  return { name, largest, linear, software: /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name) };
}

export class View3d {
  mode = 'webgl2';

  constructor(parent, land, rivers, options, gl) {
    this.parent = parent;
    this.land = land;
    this.rivers = rivers;
    this.renderer = new WebGLRenderer({ antialias: options.antialias, preserveDrawingBuffer: true });
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.canvas = this.renderer.domElement;
    parent.append(this.canvas);
    this.scene = new Scene();
    this.ground = new Ground(land, options.segments ?? (gl.software ? 255 : 511), gl.linear);
    this.rivers3d = new DrapedLines(this.ground, 1);
    this.ridges3d = new DrapedLines(this.ground, 0);
    this.mark3d = new DrapedLines(this.ground, 20);
    this.ground.group.add(this.rivers3d.group, this.ridges3d.group, this.mark3d.group);
    this.scene.add(this.ground.group);
    this.perspective = new PerspectiveCamera(32, 1, 0.02, 60);
    this.flat = new OrthographicCamera(-1, 1, 1, -1, 0.02, 60);
    this.controls = new OrbitControls(this.perspective, this.canvas);
    this.controls.maxPolarAngle = 0.495 * Math.PI;
    this.controls.minDistance = 0.05;
    this.controls.maxDistance = 12;
    this.controls.zoomToCursor = true;
    this.controls.addEventListener('change', () => this.redraw());
    this.canvas.addEventListener('webglcontextlost', (event) => {
      event.preventDefault();
      this.onlost?.();
    });
    this.onmap = false;
    this.showsRidges = true;
  }

  get aspect() {
    return this.parent.clientWidth / Math.max(1, this.parent.clientHeight);
  }

  /** The first view: from the south, with the whole block in sight. */
  home() {
    const { ground } = this;
    const centre = new Vector3(0, ground.meshAt(this.land.grid.width / 2, this.land.grid.height / 2) * ground.lift, 0);
    this.controls.target.copy(centre);
    const camera = this.perspective;
    camera.aspect = this.aspect;
    camera.updateProjectionMatrix();
    // As near as shows every corner of the block.
    for (let away = 1.2; away < 12; away *= 1.03) {
      camera.position.setFromSpherical(new Spherical(away, MathUtils.degToRad(50), MathUtils.degToRad(18))).add(centre);
      camera.lookAt(centre);
      camera.updateMatrixWorld();
      if (ground.corners().every((p) => (p.project(camera), Math.abs(p.x) < 0.97 && Math.abs(p.y) < 0.95 && p.z < 1))) break;
    }
    this.flat.zoom = 1;
    this.flat.position.set(centre.x, 20, centre.z);
    this.controls.update();
    this.resize();
  }

  map(on) {
    this.onmap = on;
    const { target } = this.controls;
    this.controls.object = on ? this.flat : this.perspective;
    this.controls.enableRotate = !on;
    if (on) {
      target.set(0, 0, 0);
      this.flat.up.set(0, 0, -1);
      this.flat.position.set(0, 20, 0);
      this.flat.lookAt(target);
      this.controls.mouseButtons.LEFT = 2; // pan
      this.controls.touches.ONE = 1;
    } else {
      this.controls.mouseButtons.LEFT = 0;
      this.controls.touches.ONE = 0;
      this.home();
    }
    this.controls.update();
    this.resize();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.parent;
    if (width === 0 || height === 0) return;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height);
    this.ground.uniforms.dpr.value = ratio;
    this.perspective.aspect = width / height;
    this.perspective.updateProjectionMatrix();
    const fit = 1.04 * Math.max(this.ground.halfZ, this.ground.halfX / this.perspective.aspect);
    Object.assign(this.flat, { left: -fit * this.perspective.aspect, right: fit * this.perspective.aspect, top: fit, bottom: -fit });
    this.flat.updateProjectionMatrix();
    for (const lines of [this.rivers3d, this.ridges3d, this.mark3d]) lines.resize(width, height);
    this.draw();
  }

  look({ exaggeration, contour, azimuth, altitude, tint, shadeGain, ridges }) {
    const u = this.ground.uniforms;
    const ground = this.land.level ? 1 : exaggeration;
    if (ground !== this.ground.lift) {
      const before = this.ground.lift;
      this.ground.raise(ground);
      if (before) this.controls.target.y *= ground / before;
    }
    u.contour.value = this.land.level ? 0 : contour;
    u.withTint.value = tint && !this.land.level ? 1 : 0;
    u.gain.value = shadeGain;
    const a = MathUtils.degToRad(azimuth);
    const h = MathUtils.degToRad(altitude);
    u.sun.value.set(Math.sin(a) * Math.cos(h), Math.cos(a) * Math.cos(h), Math.sin(h));
    this.ridges3d.group.visible = ridges;
    this.controls.update();
    this.redraw();
  }

  showRivers(orders, highest) {
    const groups = Array.from({ length: highest }, (_, i) => ({ lines: [], ...riverStyle(i + 1, highest) }));
    orders.forEach((order, k) => order > 0 && groups[order - 1].lines.push(this.rivers.lines[k]));
    this.rivers3d.show(groups);
    if (this.rivers.ridges.length && !this.ridges3d.group.children.length) {
      this.ridges3d.show([{ lines: this.rivers.ridges, width: 1.2, colour: ridgeColour }]);
    }
    this.#fitLines();
  }

  mark(lines) {
    this.mark3d.show(lines.length ? [{ lines, width: 2.4, colour: markColour }] : []);
    this.#fitLines();
  }

  #fitLines() {
    const { clientWidth: width, clientHeight: height } = this.parent;
    for (const lines of [this.rivers3d, this.ridges3d, this.mark3d]) lines.resize(width, height);
    this.redraw();
  }

  background(colour) {
    this.scene.background = new Color(...colour.map((c) => c / 255));
    this.redraw();
  }

  redraw() {
    this.waiting ??= requestAnimationFrame(() => this.draw());
  }

  draw() {
    if (this.waiting) cancelAnimationFrame(this.waiting);
    this.waiting = undefined;
    this.renderer.render(this.scene, this.controls.object);
    this.ondraw?.(this.controls.getAzimuthalAngle());
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
