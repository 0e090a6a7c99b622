// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors
"use strict";

// What contrib/python/morula/report/packing.py has written into the page.

const byId = (id) => document.getElementById(id);

/** An element with its attributes and what is in it, elements or text. Text of
 * a run stays text, whatever stands in it: no part of the page is made of
 * strings with markup in which such text could be. */
function made(name, attributes = {}, ...content) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes))
    element.setAttribute(key, value);
  element.append(...content);
  return element;
}

/** The bytes of a block; null if the page has none of that name. */
async function unpack(name) {
  const element = byId(name);
  if (!element) return null;
  const text = atob(element.textContent);
  const deflated = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) deflated[i] = text.charCodeAt(i);
  const stream = new Blob([deflated]).stream().pipeThrough(
    new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Number i of n that are stored as all low and then all high bytes, the
 * first of them at an offset. */
function twoBytes(bytes, offset, n, i) {
  return bytes[offset + i] | (bytes[offset + n + i] << 8);
}

/** Of n cells: positions and radius, 16 bits each, side by side (`places`),
 * and which can be seen from outside (`shell`). */
function cellsOf(bytes, n) {
  const places = new Uint16Array(4 * n);
  for (let i = 0; i < n; ++i) {
    for (let k = 0; k < 3; ++k)
      places[4 * i + k] = twoBytes(bytes, 2 * k * n, n, i);
    places[4 * i + 3] = 257 * bytes[6 * n + i];
  }
  return {places, shell: bytes.subarray(7 * n, 8 * n)};
}

/** Positions of n boundary points, and in the fourth place their condition. */
function surfaceOf(bytes, n) {
  const points = new Uint16Array(4 * n);
  for (let i = 0; i < n; ++i) {
    for (let k = 0; k < 3; ++k)
      points[4 * i + k] = twoBytes(bytes, 2 * k * n, n, i);
    points[4 * i + 3] = bytes[6 * n + i];
  }
  return points;
}

/** Colours (256 times red, green, blue) from hexadecimal digits. */
function paletteOf(digits) {
  return Uint8Array.from({length: digits.length / 2},
    (_, i) => parseInt(digits.substr(2 * i, 2), 16));
}

/** Four digits, as few as they need. */
function shown(value) {
  return Number.isInteger(value) ? value.toLocaleString("en")
    : String(Number(value.toPrecision(4)));
}
