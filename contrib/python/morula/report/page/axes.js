// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors
"use strict";

// Which way the axes point, and how long a length is.

function drawTriad(svg, axes) {
  const [right, up, toViewer] = axes;
  const parts = ["x", "y", "z"].map((name) => ({name,
    across: 26 * right[name], over: -26 * up[name], near: toViewer[name]}));
  parts.sort((a, b) => a.near - b.near);
  svg.innerHTML = parts.map(({name, across, over}) =>
    `<line x1="0" y1="0" x2="${across.toFixed(1)}" y2="${over.toFixed(1)}"/>`
    + `<text x="${(1.28 * across).toFixed(1)}" y="${(1.28 * over).toFixed(1)}"`
    + `>${name}</text>`).join("");
}

/** The length of a bar, 1, 2 or 5 times a power of ten of µm, near a fifth of
 * the width; a pixel is so many µm. */
function scaleLength(pixel, width) {
  const wanted = 0.2 * width * pixel;
  const power = 10 ** Math.floor(Math.log10(wanted));
  return [5, 2, 1].map((n) => n * power).find((n) => n <= wanted);
}

function drawScale(element, pixel, width) {
  const length = scaleLength(pixel, width);
  element.children[0].style.width = `${length / pixel}px`;
  element.children[1].textContent = `${shown(length)} µm`;
}
