// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors
"use strict";

// The controls beside the 3-D view.

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
    byId("film").disabled = this.about.states.length < 2 || !canRecord();
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
    on("cut", "input", () => { this.faceCut(); this.cut(); });
    for (const id of ["place", "flip"]) on(id, "input", () => this.cut());
    on("cells-on", "change", () => this.visible());
    on("surface-on", "change", () => this.visible());
    on("clone-on", "change", () => this.show());
    on("clone", "change", () => this.show());
    on("save", "click", () => this.save());
    on("film", "click", () => this.saveFilm());
    for (const button of document.querySelectorAll("[data-look]")) {
      button.hidden = this.about.flat && button.dataset.look !== "home";
      button.addEventListener("click", () => {
        this.view.camera.look(button.dataset.look);
        this.faceCut();
        this.cut();
      });
    }
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

  /** From here on, the half towards the viewer is the one cut away. */
  faceCut() {
    this.view.cut.face(byId("cut").value);
  }

  cut() {
    const axis = byId("cut").value;
    const gone = this.view.cut.at(axis, Number(byId("place").value),
      byId("flip").checked);
    byId("place-shown").textContent = gone && `${gone} is cut away`;
    for (const id of ["place", "flip"]) byId(id).disabled = axis === "off";
    this.view.choose();
  }

  visible() {
    this.view.spheres.object.visible = byId("cells-on").checked;
    this.view.surface.object.visible = byId("surface-on").checked;
    byId("surface-key").hidden = !byId("surface-on").checked;
    this.view.request();
  }

  /** The picture with what is written round it, on a canvas. */
  draw(canvas) {
    const state = this.about.states[this.number];
    const words = [`day ${shown(state.time)}`,
      `${state.cells.toLocaleString("en")} cells`, report.about.name];
    if (byId("clone-on").checked)
      words.splice(2, 0, `clone of founder ${byId("clone").value}`);
    drawWhole(canvas, this.view, words.join(", "), this.legend);
  }

  async save() {
    const canvas = document.createElement("canvas");
    this.draw(canvas);
    const blob = await new Promise((done) => canvas.toBlob(done));
    handOver(blob, `${this.field.name}-day-${
      this.about.states[this.number].time}.png`);
    return blob;
  }

  async saveFilm() {
    const canvas = document.createElement("canvas"), before = this.number;
    const words = byId("film").textContent;
    this.playing = true;
    this.play();
    byId("film").disabled = true;
    const blob = await recorded(canvas, this.about.states.length,
      async (i) => {
        byId("film").textContent = `Recording ${i + 1} of ${
          this.about.states.length}`;
        byId("time").value = i;
        await this.show();
        this.draw(canvas);
      });
    byId("film").textContent = words;
    byId("film").disabled = false;
    byId("time").value = before;
    await this.show();
    handOver(blob, `${this.field.name}.webm`);
    return blob;
  }

  /** What the colours mean, now. */
  get legend() {
    return legendOf(this.field, this.view.palettes[this.field.palette],
      Number(byId("lowest").value), Number(byId("highest").value));
  }

  bar() {
    drawLegend(byId("bar"), this.legend);
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
      const type = this.lineage.typeAt(id,
        this.about.states[this.number].time);
      if (type && field.name !== "type") words.push(`type ${type}`);
      byId("clone").value = founder;
      byId("founder").value = founder;
      byId("founder").dispatchEvent(new Event("change"));
      if (byId("clone-on").checked) this.show();
      else this.view.show(this.number, field, founder, false);
    }
    if (!field.clone) {
      const step = (field.high - field.low) / 255;
      const value = field.low + step * values[i];
      const said = field.whole ? wordOf(field, Math.round(value))
        : `${shown(value)} ${field.unit}`;
      words.push(`${field.label.toLowerCase()} ${said}`.trim());
    }
    byId("picked").textContent = `${words.join(", ")}.`;
  }
}
