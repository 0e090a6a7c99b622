// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors
"use strict";

// Every cell is a triangle that faces the viewer, on which the sphere is
// computed: exact at any size, and three corners a cell.

const CELL_VERTEX = `
attribute vec4 cell;
attribute float value;
uniform vec3 low, size;
uniform vec2 radii, range;
uniform float steps, swell;
uniform sampler2D palette;
varying vec3 colour;
varying vec2 corner;
varying float depth, halfDepth;

void main() {
  vec3 centre = low + size * cell.xyz;
  float radius = swell * mix(radii.x, radii.y, cell.w);
  corner = position.xy;
  vec4 seen = modelViewMatrix * vec4(centre, 1.0);
  seen.xy += radius * corner;
  gl_Position = projectionMatrix * seen;
  // a parallel camera: depth is linear
  depth = 0.5 * (projectionMatrix[2][2] * seen.z + projectionMatrix[3][2])
    + 0.5;
  halfDepth = 0.5 * projectionMatrix[2][2] * radius;
  float t = steps > 0.5
    ? (floor(value * (steps - 1.0) + 0.5) + 0.5) / steps
    : clamp((value - range.x) / (range.y - range.x), 0.002, 0.998);
  colour = texture2D(palette, vec2(t, 0.5)).rgb;
}`;

// Cells of a 2-D run are discs: their colours are those of the legend, without
// light and shade, and their rims darker.
const CELL_FRAGMENT = `
uniform float disc;
varying vec3 colour;
varying vec2 corner;
varying float depth, halfDepth;

void main() {
  float square = dot(corner, corner);
  if (square > 1.0) discard;
  float height = sqrt(1.0 - square);
  gl_FragDepthEXT = depth + halfDepth * height;
  if (disc > 0.5) {
    gl_FragColor = vec4(colour * (square > 0.85 ? 0.62 : 1.0), 1.0);
    return;
  }
  vec3 normal = vec3(corner, height);
  float light = 0.85 * max(0.0, dot(normal, vec3(-0.37, 0.60, 0.71)))
    + 0.18 * max(0.0, dot(normal, vec3(0.80, 0.10, 0.59)));
  // the rim lies between other cells, where less light comes
  float gap = 0.55 + 0.45 * height;
  gl_FragColor = vec4(colour * gap * (0.34 + light), 1.0);
}`;

const POINT_VERTEX = `
attribute vec4 cell;
uniform vec3 low, size;
uniform float lift, pixels;
varying vec3 colour;

void main() {
  vec4 seen = modelViewMatrix * vec4(low + size * cell.xyz, 1.0);
  seen.z += lift;  // before the cells below it
  gl_Position = projectionMatrix * seen;
  gl_PointSize = pixels;
  float condition = cell.w * 65535.0;
  colour = condition < 0.5 ? vec3(0.54, 0.56, 0.60)
    : condition < 1.5 ? vec3(0.84, 0.18, 0.18)
    : condition < 2.5 ? vec3(0.23, 0.49, 0.88) : vec3(0.88, 0.63, 0.0);
}`;

const POINT_FRAGMENT = `
varying vec3 colour;
void main() {
  if (length(gl_PointCoord - 0.5) > 0.5) discard;
  gl_FragColor = vec4(colour, 1.0);
}`;

/** The cells of one state at a time. */
class Spheres {
  constructor(about) {
    const texture = new THREE.DataTexture(new Uint8Array(768), 256, 1,
      THREE.RGBFormat);
    texture.magFilter = texture.minFilter = THREE.NearestFilter;
    this.uniforms = {
      low: {value: new THREE.Vector3(...about.low)},
      size: {value: new THREE.Vector3(...about.size)},
      radii: {value: new THREE.Vector2(...about.radii)},
      range: {value: new THREE.Vector2(0, 1)},
      disc: {value: about.flat ? 1 : 0}, steps: {value: 0}, swell: {value: 1}, palette: {value: texture}};
    this.material = new THREE.ShaderMaterial({
      uniforms: this.uniforms, vertexShader: CELL_VERTEX,
      fragmentShader: CELL_FRAGMENT, extensions: {fragDepth: true}});
    this.object = new THREE.Mesh(new THREE.BufferGeometry(), this.material);
    this.object.frustumCulled = false;
    this.count = 0;
  }

  /** Takes over the cells with these numbers: positions and radii (see
   * cellsOf), and values, a byte each. */
  show(places, values, numbers) {
    const n = numbers.length;
    const cell = new Uint16Array(4 * n), value = new Uint8Array(n);
    for (let j = 0; j < n; ++j) {
      const i = numbers[j];
      for (let k = 0; k < 4; ++k) cell[4 * j + k] = places[4 * i + k];
      value[j] = values[i];
    }
    const geometry = new THREE.InstancedBufferGeometry();
    const root = Math.sqrt(3);  // round the unit circle
    geometry.setAttribute("position", new THREE.BufferAttribute(
      new Float32Array([-root, -1, 0, root, -1, 0, 0, 2, 0]), 3));
    const each = (array, size) =>
      new THREE.InstancedBufferAttribute(array, size, true);
    geometry.setAttribute("cell", each(cell, 4));
    geometry.setAttribute("value", each(value, 1));
    this.object.geometry.dispose();
    this.object.geometry = geometry;
    this.count = n;
    this.thin(1);
  }

  /** Draws one of so many cells, the larger for it. */
  thin(by) {
    this.object.geometry.maxInstancedCount = Math.ceil(this.count / by);
    this.uniforms.swell.value = Math.sqrt(Math.min(by, 4));
  }

  palette(colours) {
    this.uniforms.palette.value.image.data.set(colours);
    this.uniforms.palette.value.needsUpdate = true;
  }
}

/** The boundary points of one state. */
class SurfacePoints {
  constructor(spheres, radius) {
    const {low, size} = spheres.uniforms;
    this.uniforms = {low, size, lift: {value: radius}, pixels: {value: 4}};
    this.object = new THREE.Points(new THREE.BufferGeometry(),
      new THREE.ShaderMaterial({uniforms: this.uniforms,
        vertexShader: POINT_VERTEX, fragmentShader: POINT_FRAGMENT}));
    this.object.frustumCulled = false;
    this.object.visible = false;
  }

  show(points) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(
      new Float32Array(0.75 * points.length), 3));
    geometry.setAttribute("cell", new THREE.BufferAttribute(points, 4, true));
    this.object.geometry.dispose();
    this.object.geometry = geometry;
  }
}
