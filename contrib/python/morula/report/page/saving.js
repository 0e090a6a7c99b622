// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors
"use strict";

// Pictures and films to keep: what is seen, with its time, what the colours
// mean, and how long a length is.

const FILM = {type: "video/webm", still: 600, last: 1200, refresh: 100};

/** The view with all that is written round it, drawn on a canvas. Heights are
 * those of the page, times the pixels of the screen in one of the page. */
function drawWhole(canvas, view, words, legend) {
  view.coarse = 1;
  view.draw();
  const style = getComputedStyle(document.documentElement);
  const value = (name) => style.getPropertyValue(name).trim();
  const ratio = view.canvas.width / view.stage.clientWidth;
  const [top, foot] = [36, 62];
  // videos want even numbers
  const width = 2 * Math.floor(view.canvas.width / 2);
  const height = 2 * Math.ceil((view.canvas.height + ratio * (top + foot)) / 2);
  if (canvas.width !== width) canvas.width = width;
  if (canvas.height !== height) canvas.height = height;
  const context = canvas.getContext("2d");
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.fillStyle = value("--canvas");
  context.fillRect(0, 0, width, height);
  context.drawImage(view.canvas, 0, Math.round(ratio * top));
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  const area = {context, text: value("--text"), width: width / ratio,
    bottom: height / ratio};
  context.fillStyle = area.text;
  write(area, words, 12, 24, "left", 16);
  writeScale(area, view.camera.pixel, view.stage.clientWidth);
  writeLegend(area, legend);
}

function write({context}, words, x, y, align = "left", size = 13) {
  context.font = `${size}px sans-serif`;
  context.textAlign = align;
  context.fillText(words, x, y);
  return context.measureText(words).width;
}

function writeScale(area, pixel, width) {
  const length = scaleLength(pixel, width), long = length / pixel;
  const left = area.width - 14 - long, y = area.bottom - 34;
  area.context.fillRect(left, y, long, 3);
  write(area, `${shown(length)} µm`, left + long / 2, y + 18, "center");
}

function writeLegend(area, {title, note, swatches, stops, ends}) {
  const {context, bottom} = area;
  const heading = note ? `${title} (${note})` : title;
  write(area, heading, 12, bottom - 44);
  if (stops) {
    const wide = 0.5 * area.width;
    const ramp = context.createLinearGradient(12, 0, 12 + wide, 0);
    stops.forEach((colour, i) =>
      ramp.addColorStop(i / (stops.length - 1), colour));
    context.fillStyle = ramp;
    context.fillRect(12, bottom - 38, wide, 14);
    context.fillStyle = area.text;
    write(area, ends[0], 12, bottom - 9);
    write(area, ends[1], 12 + wide, bottom - 9, "right");
  }
  writeSwatches(area, swatches || []);
}

/** In one line, left of the scale: in smaller letters if there are many. */
function writeSwatches(area, swatches) {
  const {context, width, bottom} = area;
  context.font = "13px sans-serif";
  const wide = swatches.reduce((sum, {word}) =>
    sum + 36 + context.measureText(word).width, 12);
  const size = 13 * Math.min(1, 0.75 * width / wide);
  let x = 12;
  for (const {colour, word} of swatches) {
    context.fillStyle = colour;
    context.fillRect(x, bottom - 36, size + 1, size + 1);
    context.fillStyle = area.text;
    x += 1.5 * size + write(area, word, x + 1.5 * size, bottom - 24, "left",
      size) + 1.25 * size;
  }
}

/** All states as a film. `show` shows state i and draws it on the canvas. */
async function recorded(canvas, states, show) {
  await show(0);
  const recorder = new MediaRecorder(canvas.captureStream(),
    {mimeType: FILM.type, videoBitsPerSecond: 8e6});
  const parts = [];
  recorder.addEventListener("dataavailable", (e) => parts.push(e.data));
  const stopped = new Promise((done) =>
    recorder.addEventListener("stop", done));
  recorder.start();
  for (let i = 0; i < states; ++i) {
    await show(i);
    // a canvas on which nothing is drawn gives no frames
    const until = performance.now()
      + (i + 1 < states ? FILM.still : FILM.last);
    while (performance.now() < until) {
      canvas.getContext("2d").fillRect(-2, -2, 1, 1);
      await new Promise((done) => setTimeout(done, FILM.refresh));
    }
  }
  recorder.stop();
  await stopped;
  return new Blob(parts, {type: FILM.type});
}

function canRecord() {
  return typeof MediaRecorder !== "undefined"
    && MediaRecorder.isTypeSupported(FILM.type)
    && Boolean(HTMLCanvasElement.prototype.captureStream);
}

/** Hands a file to the user. */
function handOver(blob, name) {
  const address = URL.createObjectURL(blob);
  made("a", {href: address, download: name}).click();
  setTimeout(() => URL.revokeObjectURL(address), 60000);
}
