// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors
"use strict";

// The picture: which state it shows, in which colours, what is cut away.

class View {
  /** Throws if there is no WebGL 2. */
  constructor(stage, about, palettes, lineage) {
    this.canvas = stage.querySelector("canvas");
    const context = this.canvas.getContext("webgl2", {antialias: false});
    if (!context) throw new Error("this browser has no WebGL 2");
    this.stage = stage;
    this.about = about;
    this.lineage = lineage;
    this.palettes = palettes;
    this.renderer = new THREE.WebGLRenderer({canvas: this.canvas, context});
    this.spheres = new Spheres(about);
    this.surface = new SurfacePoints(this.spheres,
      3 * about.radii[1]);
    this.scene = new THREE.Scene();
    this.scene.add(this.spheres.object, this.surface.object);
    this.camera = new Camera(this.canvas, about, () => this.turned());
    this.cut = new Cut(about, this.camera);
    this.bytes = new Map();
    this.frames = 0;
    this.coarse = 1;  // one of so many cells while a slow picture moves
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change",
      () => this.request());
    new ResizeObserver(() => this.resize()).observe(stage);
    this.resize();
  }

  /** Loads what a state needs; the last call wins. */
  async show(number, field, founder, onlyClone) {
    const wanted = this.wanted = {number, field, founder, onlyClone};
    const state = this.about.states[number];
    const cells = await this.once(`cells-${number}`,
      (bytes) => cellsOf(bytes, state.shown));
    const ids = this.lineage && state.divisions !== null
      ? this.lineage.present(state, this.about.stride) : null;
    const values = field.clone ? this.lineage.colours(ids)
      : await this.once(`field-${field.name}-${number}`, (bytes) => bytes);
    const surface = state.surface && await this.once(`surface-${number}`,
      (bytes) => surfaceOf(bytes, state.surface));
    if (this.wanted !== wanted) return false;
    Object.assign(this, {state, cells, ids, values, field});
    this.members = ids && onlyClone ? this.lineage.membersOf(founder, ids)
      : null;
    this.surface.show(surface || new Uint16Array(0));
    this.spheres.uniforms.steps.value = field.whole
      ? field.high - field.low + 1 : 0;
    this.spheres.palette(this.palettes[field.palette]);
    this.choose();
    return true;
  }

  /** A block, decoded once. */
  async once(name, decode) {
    if (!this.bytes.has(name)) this.bytes.set(name, decode(await unpack(name)));
    return this.bytes.get(name);
  }

  /** Ends of the colours as parts (0 to 1) of what the values can be. */
  range(low, high) {
    this.spheres.uniforms.range.value.set(low, Math.max(high, low + 1e-4));
    this.request();
  }

  /** Whether a cell is drawn: it belongs to what is asked for, is not cut
   * away, and is not buried below others. */
  visible(i) {
    if (this.members && !this.members[i]) return false;
    const before = this.cut.before(this.cells.places, i);
    return before >= 0 && (this.members !== null || before < this.state.shell
      || this.cells.shell[i] === 1);
  }

  /** The visible cells in an order in which every part of them is spread
   * over the whole tissue. */
  choose() {
    if (!this.state) return;
    const n = this.state.shown, numbers = [];
    const step = coprime(Math.round(0.6180339887 * n), n);
    for (let j = 0, i = 0; j < n; ++j, i = (i + step) % n)
      if (this.visible(i)) numbers.push(i);
    this.numbers = numbers;
    this.spheres.show(this.cells.places, this.values, numbers);
    this.request();
  }

  turned() {
    if (this.cut && this.cut.follows()) this.choose();
    this.request(true);
  }

  /** Why nothing can be seen, or nothing if something can. */
  get emptiness() {
    if (!this.state) return "";
    if (this.surface.object.visible && this.state.surface) return "";
    if (!this.spheres.object.visible)
      return "Nothing is shown: tick cells or surface points.";
    if (this.numbers.length) return "";
    if (this.members && !this.members.includes(1))
      return "No cell of this clone lives at this time.";
    return "Everything is cut away: move the place of the cut.";
  }

  resize() {
    const {clientWidth: width, clientHeight: height} = this.stage;
    if (!width || !height) return;
    this.renderer.setPixelRatio(devicePixelRatio);
    this.renderer.setSize(width, height, false);
    this.surface.uniforms.pixels.value = 5 * devicePixelRatio;
    this.camera.resize(width, height);
    this.request();
  }

  /** Draws before the next frame. */
  request(moving = false) {
    if (moving) {
      clearTimeout(this.rest);
      // a slow picture may take longer than that itself
      this.rest = setTimeout(() => this.refine(),
        Math.max(400, 2.5 * (this.since || 0)));
    }
    if (this.requested) return;
    this.requested = true;
    requestAnimationFrame((now) => {
      this.requested = false;
      if (moving) this.pace(now);
      this.draw();
    });
  }

  /** Below ten pictures a second, moving ones show half of the cells, a
   * quarter if that is not enough, and so on. */
  pace(now) {
    const since = now - this.before;
    this.before = now;
    this.since = since < 5000 ? since : 0;
    this.slow = this.since > 100 ? (this.slow || 0) + 1 : 0;
    if (this.slow < 2 || this.coarse > 8) return;
    this.coarse *= 2;
    this.slow = 0;
  }

  /** All cells again, once nothing moves. */
  refine() {
    if (this.coarse === 1) return;
    this.coarse = 1;
    this.request();
  }

  draw() {
    if (!this.stage.clientWidth) return;  // in a tab that is not shown
    const style = getComputedStyle(document.documentElement);
    this.spheres.thin(this.coarse);
    this.renderer.setClearColor(style.getPropertyValue("--canvas").trim());
    this.renderer.render(this.scene, this.camera.camera);
    const empty = this.stage.querySelector("#empty");
    empty.textContent = this.emptiness;
    empty.hidden = !empty.textContent;
    drawTriad(this.stage.querySelector("#triad"), this.camera.axes);
    drawScale(this.stage.querySelector("#scale"), this.camera.pixel,
      this.stage.clientWidth);
    ++this.frames;
  }

  /** The picture of all cells as a PNG in a data: address, without bars and
   * words. */
  picture() {
    this.coarse = 1;
    this.draw();
    return this.canvas.toDataURL("image/png");
  }

  /** Number of the cell in the state that is seen at a place of the page,
   * or -1. */
  at(clientX, clientY) {
    const box = this.canvas.getBoundingClientRect();
    const [right, up, near] = this.camera.axes;
    const pixel = this.camera.pixel, target = this.camera.controls.target;
    const across = pixel * (clientX - box.left - box.width / 2);
    const over = pixel * (box.top + box.height / 2 - clientY);
    const {low, size, radii} = this.about, point = new THREE.Vector3();
    const places = this.cells.places;
    let found = -1, nearest = -Infinity;
    for (const i of this.numbers) {
      point.set(...[0, 1, 2].map((k) =>
        low[k] + size[k] * places[4 * i + k] / 65535)).sub(target);
      const radius = radii[0] + (radii[1] - radii[0])
        * places[4 * i + 3] / 65535;
      const square = radius * radius - (point.dot(right) - across) ** 2
        - (point.dot(up) - over) ** 2;
      if (square < 0) continue;
      const height = point.dot(near) + Math.sqrt(square);
      if (height > nearest) [found, nearest] = [i, height];
    }
    return found;
  }
}

/** The first number from this one on that has no divisor in common with n. */
function coprime(number, n) {
  const divisor = (a, b) => b ? divisor(b, a % b) : a;
  let found = Math.max(1, number);
  while (divisor(found, n) > 1) ++found;
  return found;
}
