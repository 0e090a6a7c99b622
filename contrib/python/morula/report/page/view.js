// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors
"use strict";

// The picture of the cells, and the controls beside it.

const byId = (id) => document.getElementById(id);

/** The bytes of a block of the page. */
async function unpack(name) {
  const deflated = Uint8Array.from(atob(byId(name).textContent),
    (letter) => letter.charCodeAt(0));
  const stream = new Blob([deflated]).stream().pipeThrough(
    new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

class View {
  /** Throws if there is no WebGL 2. */
  constructor(about) {
    this.about = about;
    this.canvas = byId("canvas");
    const context = this.canvas.getContext("webgl2");
    if (!context) throw new Error("This browser has no WebGL 2.");
    this.renderer = new THREE.WebGLRenderer({canvas: this.canvas, context});
    this.renderer.setClearColor("white");
    this.spheres = new Spheres(about);
    const size = new THREE.Vector3(...about.size);
    this.low = new THREE.Vector3(...about.low);
    this.middle = this.low.clone().addScaledVector(size, 0.5);
    this.reach = 0.5 * size.length() + about.low[3] + about.size[3];
    const axes = new THREE.AxesHelper(0.5 * this.reach);
    axes.position.copy(this.low);
    this.scene = new THREE.Scene();
    this.scene.add(this.spheres.object, axes);
    this.blocks = new Map();
    this.makeCamera();
    this.listen();
    this.look("home");
    new ResizeObserver(() => this.resize()).observe(this.canvas.parentElement);
    this.resize();
  }

  makeCamera() {
    this.camera = new THREE.OrthographicCamera(-1, 1, 1, -1,
      0.01 * this.reach, 8 * this.reach);
    this.camera.up.set(0, this.about.flat ? 1 : 0, this.about.flat ? 0 : 1);
    this.controls = new THREE.OrbitControls(this.camera, this.canvas);
    this.controls.enableKeys = false;
    this.controls.screenSpacePanning = true;
    if (this.about.flat) {  // it is moved, not turned
      this.controls.enableRotate = false;
      this.controls.mouseButtons.LEFT = THREE.MOUSE.PAN;
      this.controls.touches.ONE = THREE.TOUCH.PAN;
    }
    this.controls.addEventListener("change", () => this.draw());
  }

  listen() {
    const {states, fields, flat} = this.about;
    byId("time").max = byId("time").value = states.length - 1;
    for (const {name} of fields) byId("field").add(new Option(name));
    for (const id of ["time", "field"])
      byId(id).addEventListener("input", () => this.show());
    byId("cut").addEventListener("input", () => this.face());
    for (const id of ["place", "flip"])
      byId(id).addEventListener("input", () => this.cut());
    byId("play").addEventListener("click", () => this.play());
    for (const button of document.querySelectorAll("[data-look]")) {
      button.hidden = flat && button.dataset.look !== "home";
      button.addEventListener("click", () => this.look(button.dataset.look));
    }
    this.canvas.addEventListener("keydown", (event) => this.key(event));
  }

  /** The state and the field that the controls name; the last call wins. */
  async show() {
    const number = Number(byId("time").value);
    const k = byId("field").selectedIndex;
    const state = this.about.states[number], field = this.about.fields[k];
    const wanted = this.wanted = {number, k};
    if (!this.blocks.has(number))
      this.blocks.set(number, await unpack(`cells-${number}`));
    if (this.wanted !== wanted) return;
    byId("time-shown").textContent = `day ${Number(state.time.toPrecision(4))}: `
      + `${state.cells.toLocaleString("en")} cells`;
    byId("bar").src = field.bar;
    this.spheres.show(this.blocks.get(number), state.shown, k, field.shades);
    this.draw();
  }

  /** A state after the other until it is pressed again. */
  play() {
    clearInterval(this.playing);
    const starts = !this.playing;
    byId("play").textContent = starts ? "Pause" : "Play";
    this.playing = starts && setInterval(() => {
      byId("time").value = (Number(byId("time").value) + 1)
        % this.about.states.length;
      this.show();
    }, 700);
  }

  /** Cuts away the half that is now towards the viewer, as what is left would
   * hide the one behind. It stays while the tissue is turned by hand. */
  face() {
    const axis = byId("cut").value;
    this.side = this.camera.position[axis] < this.controls.target[axis]
      ? -1 : 1;
    this.cut();
  }

  /** All on one side of a plane, at a part (0 to 1) of the tissue's extent. */
  cut() {
    const k = "xyz".indexOf(byId("cut").value), plane = [0, 0, 0, 1];
    byId("place-shown").textContent = "";
    if (k >= 0) {
      const where = this.about.low[k]
        + this.about.size[k] * Number(byId("place").value);
      const sign = byId("flip").checked ? -this.side : this.side;
      plane[k] = sign;
      plane[3] = sign * where;
      byId("place-shown").textContent =
        `${"xyz"[k]} ${sign > 0 ? ">" : "<"} ${where.toFixed(1)} µm is cut away`;
    }
    this.spheres.uniforms.cut.value.set(...plane);
    this.draw();
  }

  /** From an axis, or as at first: as contrib/render looks. */
  look(from) {
    const azimuth = -Math.PI / 3, elevation = 14 * Math.PI / 180;
    const direction = {x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1]}[from]
      || (this.about.flat ? [0, 0, 1] : [Math.cos(elevation) * Math.cos(azimuth),
        Math.cos(elevation) * Math.sin(azimuth), Math.sin(elevation)]);
    if (from === "home") this.camera.zoom = 1;
    this.controls.target.copy(this.middle);
    this.camera.position.copy(this.middle).addScaledVector(
      new THREE.Vector3(...direction), 3 * this.reach);
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.face();
  }

  key(event) {
    const step = {ArrowLeft: [-0.12, 0], ArrowRight: [0.12, 0],
      ArrowUp: [0, -0.12], ArrowDown: [0, 0.12]}[event.key];
    if (step && !this.about.flat) this.turn(...step);
    else if (event.key === "+") this.zoom(1.15);
    else if (event.key === "-") this.zoom(1 / 1.15);
    else if (event.key === "0") this.look("home");
    else return;
    event.preventDefault();
  }

  /** Radians round the vertical, and up. */
  turn(across, up) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const right = new THREE.Vector3().crossVectors(this.camera.up, offset);
    offset.applyAxisAngle(right.normalize(), up);
    offset.applyAxisAngle(this.camera.up, across);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
  }

  zoom(factor) {
    this.camera.zoom *= factor;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  resize() {
    const {clientWidth: width, clientHeight: height} = this.canvas.parentElement;
    this.renderer.setPixelRatio(devicePixelRatio);
    this.renderer.setSize(width, height, false);
    // on a narrow screen the width is what must hold the tissue
    const half = 0.56 * Math.max(...this.about.size)
      * Math.max(1, height / width) + this.about.size[3];
    this.camera.top = half;
    this.camera.right = half * width / height;
    this.camera.bottom = -this.camera.top;
    this.camera.left = -this.camera.right;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  /** µm of a pixel of the page. */
  get pixel() {
    return 2 * this.camera.top / this.camera.zoom / this.canvas.clientHeight;
  }

  draw() {
    this.renderer.render(this.scene, this.camera);
    // a bar of 1, 2 or 5 times a power of ten, up to a fifth of the width
    const wanted = 0.2 * this.canvas.clientWidth * this.pixel;
    const power = 10 ** Math.floor(Math.log10(wanted));
    const length = [5, 2, 1].map((n) => n * power).find((n) => n <= wanted);
    byId("scale").style.width = `${length / this.pixel}px`;
    byId("scale").textContent = `${Number(length.toPrecision(1))} µm`;
  }
}

/** For the browser's console, too. */
const report = {};
try {
  report.view = new View(JSON.parse(byId("about").textContent));
  report.ready = report.view.show();
} catch (error) {
  byId("view").hidden = true;
  byId("view-message").textContent =
    `There is no 3-D view here: ${error.message} The rest of the page is complete.`;
}
