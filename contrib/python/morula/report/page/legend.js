// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors
"use strict";

// What the colours mean, below the view and in saved pictures.

const SWATCHES = 16;  // more whole numbers without names get a ramp

/** {title, note} and either swatches {colour, word} or a ramp of colours with
 * its ends. Ends beyond which there are values say so. */
function legendOf(field, palette, lowest, highest) {
  const colour = (t) => {
    const k = 3 * Math.min(255, Math.floor(256 * t));
    return `rgb(${palette[k]},${palette[k + 1]},${palette[k + 2]})`;
  };
  const title = field.label + (field.unit && `, ${field.unit}`);
  if (field.clone) return {title, note: "colours repeat", swatches: []};
  const n = field.high - field.low + 1;
  if (field.whole && (n <= SWATCHES || named(field))) {
    const numbers = Array.from({length: n}, (_, i) => field.low + i);
    const swatches = numbers.map((number, i) => ({
      colour: colour((i + 0.5) / n), word: wordOf(field, number)}));
    return {title, note: "", swatches: swatches.filter((s) => s.word)};
  }
  const below = field.min < lowest - 1e-3 * Math.abs(highest - lowest);
  const above = field.max > highest + 1e-3 * Math.abs(highest - lowest);
  const note = `all values: ${shown(field.min)} to ${shown(field.max)}`;
  return {title, note: below || above ? `clipped; ${note}` : note,
    stops: Array.from({length: 17}, (_, i) => colour(i / 16)),
    ends: [(below ? "≤ " : "") + plainNumber(lowest),
      (above ? "≥ " : "") + plainNumber(highest)]};
}

/** The name of a number that stands for something, or the number. */
function wordOf(field, number) {
  return named(field) ? field.names[number] || "" : String(number);
}

/** Whether numbers of a field stand for something. */
function named(field) {
  return Object.keys(field.names || {}).length > 0;
}

function drawLegend(element, {title, note, swatches, stops, ends}) {
  const parts = [made("b", {}, title)];
  if (swatches && note) parts.push(` (${note})`);
  for (const {colour, word} of swatches || [])
    parts.push(made("span", {class: "swatch", style: `background:${colour}`}),
      word);
  if (stops) {
    parts.push(made("div", {class: "ramp",
      style: `background:linear-gradient(to right,${stops})`}));
    parts.push(made("div", {class: "ends"}, ...[ends[0], note, ends[1]].map(
      (words) => made("span", {}, words))));
  }
  element.replaceChildren(...parts);
}

/** As few digits as tell a number of a colour bar. */
function plainNumber(value) {
  return String(Number(value.toPrecision(4)));
}
