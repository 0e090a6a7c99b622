// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors
"use strict";

// Starts every part. `report` is there for the browser's console.

const report = {about: JSON.parse(byId("about").textContent)};

async function start() {
  const {about} = report;
  report.tabs = new Tabs(document.querySelector("nav"));
  if (typeof DecompressionStream === "undefined") {
    sayOfView("This browser cannot unpack the cells and the lineage (it has "
      + "no DecompressionStream; all current ones do). The rest of the page "
      + "is complete.");
    return;
  }
  if (about.lineage) {
    report.lineage = new Lineage(about.lineage,
      await unpack("lineage-packed"), await unpack("types-packed"),
      await unpack("deaths-packed"));
    report.tree = new Tree(report.lineage, about.lineage);
    byId("to-view").addEventListener("click", showClone);
  }
  if (about.view) await startView(about);
  byId("to-view").disabled = !report.panel;
}

async function startView(about) {
  const palettes = Object.fromEntries(Object.entries(about.palettes)
    .map(([name, digits]) => [name, paletteOf(digits)]));
  try {
    report.view = new View(byId("stage"), about.view, palettes,
      report.lineage);
  } catch (error) {
    sayOfView(`There is no 3-D view here: ${error.message}. The rest of the `
      + "page is complete.");
    return;
  }
  byId("canvas").addEventListener("webglcontextlost", () => sayOfView(
    "The graphics card has given up; load the page again."));
  report.panel = new Panel(report.view, report.lineage);
  report.panel.faceCut();
  report.panel.cut();
  report.tabs.onShow = () => report.view.resize();
}

function sayOfView(words) {
  byId("view").hidden = true;
  byId("view-message").textContent = words;
}

/** The founder of the tree, alone, in the 3-D view. */
function showClone() {
  byId("clone").value = byId("founder").value;
  byId("clone-on").checked = true;
  report.panel.show();
  report.tabs.show("three");
}

report.ready = start();
