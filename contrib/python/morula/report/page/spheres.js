// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors
"use strict";

// Every cell is a triangle that faces the viewer, on which the sphere is
// computed: exact at any size, and three corners a cell.

const VERTEX = `
attribute vec4 cell;
attribute float value;
uniform vec4 low, size, cut;
uniform sampler2D palette;
varying vec3 colour;
varying vec2 corner;
varying float depth, halfDepth;

void main() {
  vec4 place = low + size * cell;
  corner = position.xy;
  vec4 seen = modelViewMatrix * vec4(place.xyz, 1.0);
  seen.xy += place.w * corner;
  gl_Position = projectionMatrix * seen;
  if (dot(cut.xyz, place.xyz) > cut.w) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  // a parallel camera: depth is linear
  depth = 0.5 * (projectionMatrix[2][2] * seen.z + projectionMatrix[3][2])
    + 0.5;
  halfDepth = 0.5 * projectionMatrix[2][2] * place.w;
  colour = texture2D(palette, vec2((255.0 * value + 0.5) / 256.0, 0.5)).rgb;
}`;

// Cells of a 2-D run are discs: their colours are those of the legend, without
// light and shade, and their rims darker.
const FRAGMENT = `
uniform bool disc;
varying vec3 colour;
varying vec2 corner;
varying float depth, halfDepth;

void main() {
  float square = dot(corner, corner);
  if (square > 1.0) discard;
  float height = sqrt(1.0 - square);
  gl_FragDepthEXT = depth + halfDepth * height;
  vec3 normal = vec3(corner, height);
  float light = 0.85 * max(0.0, dot(normal, vec3(-0.37, 0.60, 0.71)))
    + 0.18 * max(0.0, dot(normal, vec3(0.80, 0.10, 0.59)));
  // the rim lies between other cells, where less light comes
  float shade = disc ? (square > 0.85 ? 0.62 : 1.0)
    : (0.55 + 0.45 * height) * (0.34 + light);
  gl_FragColor = vec4(colour * shade, 1.0);
}`;

/** The cells of one state at a time. */
class Spheres {
  constructor(about) {
    this.texture = new THREE.DataTexture(null, 256, 1, THREE.RGBFormat);
    this.uniforms = {
      low: {value: new THREE.Vector4(...about.low)},
      size: {value: new THREE.Vector4(...about.size)},
      cut: {value: new THREE.Vector4(0, 0, 0, 1)},
      disc: {value: about.flat}, palette: {value: this.texture}};
    this.object = new THREE.Mesh(new THREE.BufferGeometry(),
      new THREE.ShaderMaterial({
        uniforms: this.uniforms, vertexShader: VERTEX,
        fragmentShader: FRAGMENT, extensions: {fragDepth: true}}));
    this.object.frustumCulled = false;
  }

  /** Takes over n cells from a block of cells.py, with the colours of field
   * number k. */
  show(bytes, n, k, shades) {
    const geometry = new THREE.InstancedBufferGeometry();
    const root = Math.sqrt(3);  // round the unit circle
    geometry.setAttribute("position", new THREE.BufferAttribute(
      new Float32Array([-root, -1, 0, root, -1, 0, 0, 2, 0]), 3));
    geometry.setAttribute("cell", new THREE.InstancedBufferAttribute(
      new Uint16Array(bytes.buffer, 0, 4 * n), 4, true));
    geometry.setAttribute("value", new THREE.InstancedBufferAttribute(
      bytes.subarray((8 + k) * n, (9 + k) * n), 1, true));
    this.object.geometry.dispose();
    this.object.geometry = geometry;
    this.texture.image.data = Uint8Array.from(shades);
    this.texture.needsUpdate = true;
  }
}
