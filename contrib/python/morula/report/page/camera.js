// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors
"use strict";

// The camera: turned, moved and zoomed by mouse and fingers (OrbitControls of
// three.js), and by keys.

class Camera {
  constructor(canvas, about, onChange) {
    const size = new THREE.Vector3(...about.size);
    this.middle = new THREE.Vector3(...about.low).addScaledVector(size, 0.5);
    this.reach = 0.5 * size.length() + about.radii[1];
    this.halfHeight = about.flat
      ? 0.54 * Math.max(size.x, size.y) + about.radii[1]
      : 0.56 * Math.max(size.x, size.y, size.z) + about.radii[1];
    this.flat = about.flat;
    this.camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 0.1, 1);
    this.camera.up.set(0, about.flat ? 1 : 0, about.flat ? 0 : 1);
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    this.controls.enableKeys = false;
    this.controls.screenSpacePanning = true;
    if (about.flat) {  // it is moved, not turned
      this.controls.enableRotate = false;
      this.controls.mouseButtons.LEFT = THREE.MOUSE.PAN;
      this.controls.touches.ONE = THREE.TOUCH.PAN;
    }
    this.controls.minZoom = 0.3;
    this.controls.maxZoom = 60;
    this.controls.addEventListener("change", onChange);
    canvas.addEventListener("keydown", (event) => this.key(event));
    this.look("home");
  }

  /** From an axis, or as at first: as contrib/render looks. */
  look(from) {
    const azimuth = -Math.PI / 3, elevation = 14 * Math.PI / 180;
    const direction = {x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1]}[from]
      || (this.flat ? [0, 0, 1] : [Math.cos(elevation) * Math.cos(azimuth),
        Math.cos(elevation) * Math.sin(azimuth), Math.sin(elevation)]);
    if (from === "home") this.camera.zoom = 1;
    this.controls.target.copy(this.middle);
    this.camera.position.copy(this.middle).addScaledVector(
      new THREE.Vector3(...direction), 3 * this.reach);
    this.camera.near = 0.01 * this.reach;
    this.camera.far = 8 * this.reach;
    this.camera.updateProjectionMatrix();
    this.controls.update();
  }

  resize(width, height) {
    // on a narrow screen the width is what must hold the tissue
    const half = this.halfHeight * Math.max(1, height / width);
    this.camera.top = half;
    this.camera.bottom = -half;
    this.camera.right = half * width / height;
    this.camera.left = -this.camera.right;
    this.height = height;
    this.camera.updateProjectionMatrix();
  }

  /** µm of a pixel of the page. */
  get pixel() {
    return 2 * this.camera.top / this.camera.zoom / this.height;
  }

  /** Unit vectors to the right, up and to the viewer. */
  get axes() {
    this.camera.updateMatrixWorld();
    const m = this.camera.matrixWorld.elements;
    return [0, 4, 8].map((k) => new THREE.Vector3(m[k], m[k + 1], m[k + 2]));
  }

  key(event) {
    const step = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1],
      ArrowDown: [0, 1]}[event.key];
    if (step && (event.shiftKey || this.flat)) this.move(...step);
    else if (step) this.turn(0.12 * step[0], 0.12 * step[1]);
    else if (event.key === "+" || event.key === "=") this.zoom(1.15);
    else if (event.key === "-") this.zoom(1 / 1.15);
    else if (event.key === "0") this.look("home");
    else return;
    event.preventDefault();
  }

  /** Radians round the vertical, and down. */
  turn(across, down) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const toY = new THREE.Quaternion().setFromUnitVectors(this.camera.up,
      new THREE.Vector3(0, 1, 0));
    const angles = new THREE.Spherical().setFromVector3(
      offset.applyQuaternion(toY));
    angles.theta -= across;
    angles.phi += down;
    angles.makeSafe();
    offset.setFromSpherical(angles).applyQuaternion(toY.inverse());
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
  }

  move(across, down) {
    const [right, up] = this.axes;
    const by = right.multiplyScalar(40 * this.pixel * across)
      .addScaledVector(up, -40 * this.pixel * down);
    this.camera.position.sub(by);
    this.controls.target.sub(by);
    this.controls.update();
  }

  zoom(factor) {
    this.camera.zoom = Math.min(60, Math.max(0.3, this.camera.zoom * factor));
    this.camera.updateProjectionMatrix();
    this.controls.dispatchEvent({type: "change"});
  }
}
