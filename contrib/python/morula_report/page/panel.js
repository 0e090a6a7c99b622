// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors
"use strict";

// The controls beside the 3-D view.

const PHASES = {0: "G0", 1: "S", 2: "G2", 3: "M", 4: "G1",
  9: "does not proliferate"};
const CLONES = {name: "clone", label: "Clone: cells of one founder", unit: "",
  clone: true, palette: "hsv"};

class Panel {
  constructor(view, lineage) {
    this.view = view;
    this.lineage = lineage;
    this.about = view.about;
    this.fields = [...this.about.fields];
    const known = lineage && this.about.states.every(
      (state) => state.divisions !== null);
    if (known) this.fields.push(CLONES);
    for (const id of ["clone", "clone-on"]) byId(id).disabled = !known;
    byId("clone").max = known ? lineage.founders - 1 : 0;
    for (const field of this.fields)
      byId("field").add(new Option(field.label, field.name));
    byId("time").max = this.about.states.length - 1;
    byId("time").value = this.about.states.length - 1;
    byId("play").disabled = this.about.states.length < 2;
    byId("surface-on").disabled = !this.about.states.some((s) => s.surface);
    this.listen();
    this.chooseField();
  }

  listen() {
    const on = (id, name, does) => byId(id).addEventListener(name, does);
    on("time", "input", () => this.show());
    on("play", "click", () => this.play());
    on("field", "change", () => this.chooseField());
    for (const id of ["lowest", "highest"])
      on(id, "change", () => this.setRange());
    on("full-range", "click", () => this.fullRange());
    for (const id of ["cut", "place", "flip"])
      on(id, "input", () => this.cut());
    on("cells-on", "change", () => this.visible());
    on("surface-on", "change", () => this.visible());
    on("clone-on", "change", () => this.show());
    on("clone", "change", () => this.show());
    on("save", "click", () => this.save());
    for (const button of document.querySelectorAll("[data-look]"))
      button.addEventListener("click",
        () => this.view.camera.look(button.dataset.look));
    on("canvas", "keydown", (event) => {
      if (event.key === "[") this.go(-1);
      if (event.key === "]") this.go(1);
    });
    on("canvas", "pointerdown", (e) => { this.down = [e.clientX, e.clientY]; });
    on("canvas", "click", (event) => this.click(event));
  }

  get number() { return Number(byId("time").value); }

  chooseField() {
    this.field = this.fields[byId("field").selectedIndex];
    const fixed = Boolean(this.field.clone || this.field.whole);
    for (const id of ["lowest", "highest", "full-range"])
      byId(id).disabled = fixed;
    if (this.field.clone) this.wholeRange();
    else this.fullRange();
    this.show();
  }

  fullRange() {
    byId("lowest").value = plainNumber(this.field.low);
    byId("highest").value = plainNumber(this.field.high);
    this.setRange();
  }

  /** Colours that stand for no number. */
  wholeRange() {
    for (const id of ["lowest", "highest"]) byId(id).value = "";
    this.view.range(0, 1);
    this.bar();
  }

  setRange() {
    const {low, high} = this.field;
    const part = (id) => (Number(byId(id).value) - low) / (high - low);
    this.view.range(part("lowest"), part("highest"));
    this.bar();
  }

  async show() {
    const state = this.about.states[this.number];
    const founder = Math.min(Math.max(0, Math.floor(
      Number(byId("clone").value) || 0)), Number(byId("clone").max));
    byId("clone").value = founder;
    byId("time-shown").textContent = `day ${shown(state.time)}: `
      + `${state.cells.toLocaleString("en")} cells`;
    await this.view.show(this.number, this.field, founder,
      byId("clone-on").checked);
  }

  go(by) {
    const n = this.about.states.length;
    byId("time").value = (this.number + by + n) % n;
    return this.show();
  }

  /** A state after the other until it is pressed again. */
  async play() {
    this.playing = !this.playing;
    byId("play").textContent = this.playing ? "Pause" : "Play";
    byId("play").setAttribute("aria-pressed", String(this.playing));
    while (this.playing) {
      await this.go(1);
      await new Promise((done) => setTimeout(done, 700));
    }
  }

  cut() {
    const axis = byId("cut").value;
    const where = this.view.cutAt(axis, Number(byId("place").value),
      byId("flip").checked);
    byId("place-shown").textContent = where === null ? ""
      : `${shown(Math.round(where))} µm`;
    for (const id of ["place", "flip"]) byId(id).disabled = axis === "off";
  }

  visible() {
    this.view.spheres.object.visible = byId("cells-on").checked;
    this.view.surface.object.visible = byId("surface-on").checked;
    byId("surface-key").hidden = !byId("surface-on").checked;
    this.view.request();
  }

  save() {
    const link = document.createElement("a");
    link.href = this.view.picture();
    link.download = `${this.field.name}-day-${
      this.about.states[this.number].time}.png`;
    link.click();
  }

  /** The bar of colours, with the range of the values themselves. */
  bar() {
    const field = this.field;
    const colours = this.view.palettes[field.palette];
    const colour = (t) => {
      const k = 3 * Math.min(255, Math.floor(256 * t));
      return `rgb(${colours[k]},${colours[k + 1]},${colours[k + 2]})`;
    };
    const title = made("b", {}, field.label + (field.unit && ", ")
      + field.unit);
    if (field.clone) {
      byId("bar").replaceChildren(title, " (colours repeat)");
    } else if (field.whole && field.high - field.low < 16) {
      const n = field.high - field.low + 1, parts = [title];
      for (let i = 0; i < n; ++i) {
        const value = field.low + i;
        const word = field.name === "phase" ? PHASES[value] : value;
        if (word !== undefined)
          parts.push(made("span", {class: "swatch",
            style: `background:${colour((i + 0.5) / n)}`}), String(word));
      }
      byId("bar").replaceChildren(...parts);
    } else {
      const stops = Array.from({length: 17}, (_, i) => colour(i / 16));
      const ends = [byId("lowest").value, "all values: "
        + `${shown(field.min)} to ${shown(field.max)}`, byId("highest").value];
      byId("bar").replaceChildren(title,
        made("div", {class: "ramp",
          style: `background:linear-gradient(to right,${stops})`}),
        made("div", {class: "ends"}, ...ends.map((end) =>
          made("span", {}, end))));
    }
  }

  click(event) {
    if (this.down && Math.hypot(event.clientX - this.down[0],
      event.clientY - this.down[1]) > 4) return;
    const i = this.view.at(event.clientX, event.clientY);
    if (i < 0) return;
    const {ids, field, values} = this.view, words = [];
    if (ids) {
      const id = ids[i], founder = this.lineage.founder[id];
      words.push(`Cell ${id}`, `founder ${founder}`,
        `generation ${this.lineage.generation[id]}`,
        `born day ${shown(this.lineage.birth(id))}`);
      byId("clone").value = founder;
      byId("founder").value = founder;
      byId("founder").dispatchEvent(new Event("change"));
      if (byId("clone-on").checked) this.show();
      else this.view.show(this.number, field, founder, false);
    }
    if (!field.clone) {
      const step = (field.high - field.low) / 255;
      const value = field.low + step * values[i];
      words.push(`${field.label.toLowerCase()} ${field.whole
        ? Math.round(value) : shown(value)} ${field.unit}`);
    }
    byId("picked").textContent = `${words.join(", ")}.`;
  }
}

/** As few digits as tell a number of a colour bar. */
function plainNumber(value) {
  return String(Number(value.toPrecision(4)));
}
