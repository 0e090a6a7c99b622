// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors
"use strict";

// Who descends from whom, and the tree of one founder.

/** Daughters of division k have the ids founders + 2k and the next one. */
class Lineage {
  constructor(about, bytes, types, deaths) {
    const n = about.divisions;
    this.founders = about.founders;
    this.end = about.end;
    this.mothers = new Uint32Array(bytes.buffer, 0, n);
    this.times = new Float32Array(bytes.buffer, 4 * n, n);
    const ever = this.founders + 2 * n;
    this.division = new Int32Array(ever).fill(-1);
    this.founder = new Uint32Array(ever);
    this.generation = new Uint16Array(ever);
    for (let id = 0; id < this.founders; ++id) this.founder[id] = id;
    this.mothers.forEach((mother, k) => {
      this.division[mother] = k;
      for (const id of this.daughters(k)) {
        this.founder[id] = this.founder[mother];
        this.generation[id] = this.generation[mother] + 1;
      }
    });
    this.typeNames = about.types || [];
    if (types) this.readTypes(types);
    this.readDeaths(deaths || new Uint8Array(0), about.deaths);
  }

  /** Who died, and when, then who was removed, in the order of the removals. */
  readDeaths(bytes, n) {
    const ids = new Uint32Array(bytes.buffer, 0, n);
    const times = new Float32Array(bytes.buffer, 4 * n, n);
    this.deaths = new Map();
    ids.forEach((id, k) => this.deaths.set(id, times[k]));
    this.removed = new Uint32Array(bytes.buffer, 8 * n);
  }

  /** Whose type changed, when and to which, then the types at birth. */
  readTypes(bytes) {
    const ever = this.founder.length, n = (bytes.length - ever) / 9;
    const ids = new Uint32Array(bytes.buffer, 0, n);
    const times = new Float32Array(bytes.buffer, 4 * n, n);
    this.bornAs = bytes.subarray(9 * n);
    this.changes = new Map();
    ids.forEach((id, k) => {
      if (!this.changes.has(id)) this.changes.set(id, []);
      this.changes.get(id).push({time: times[k], type: bytes[8 * n + k]});
    });
  }

  /** {time, type} from which day on a cell had which type (its number);
   * nothing if cells have no types. */
  history(id) {
    return !this.bornAs ? [] : [{time: this.birth(id), type: this.bornAs[id]},
      ...this.changes.get(id) || []];
  }

  /** The name of a cell's type at a time; nothing without types. */
  typeAt(id, day) {
    const had = this.history(id).filter(({time}) => time <= day);
    return had.length ? this.typeNames[had[had.length - 1].type] : "";
  }

  daughters(k) {
    const id = this.founders + 2 * k;
    return [id, id + 1];
  }

  birth(id) {
    return id < this.founders ? 0
      : this.times[(id - this.founders) >> 1];
  }

  /** Ids of the cells that a state has, every n-th: after so many divisions
   * and removals. */
  present({divisions, removed}, every) {
    const ids = [], gone = new Set(this.removed.subarray(0, removed));
    const ever = this.founders + 2 * divisions;
    for (let id = 0, i = 0; id < ever; ++id) {
      const k = this.division[id];
      if (gone.has(id) || k >= 0 && k < divisions) continue;
      if (i++ % every === 0) ids.push(id);
    }
    return Uint32Array.from(ids);
  }

  /** A colour (0 to 255) for every cell, that of its founder. */
  colours(ids) {
    // multiples of the golden ratio differ much from each other
    return Uint8Array.from(ids, (id) =>
      (this.founder[id] * 0.6180339887 % 1) * 256);
  }

  membersOf(founder, ids) {
    return Uint8Array.from(ids, (id) => this.founder[id] === founder);
  }
}

const ROWS = 400;
const SERIES = 8;  // colours of types; more types get them again, dashed

class Tree {
  constructor(lineage, about) {
    this.lineage = lineage;
    byId("tree-part").hidden = false;
    byId("founder").max = lineage.founders - 1;
    this.legend(lineage.typeNames);
    byId("founder").addEventListener("change", () => this.draw());
    byId("largest").addEventListener("click", () => this.of(about.largest));
    byId("another").addEventListener("click", () =>
      this.of(Math.floor(Math.random() * lineage.founders)));
    this.of(about.largest);
  }

  /** Which line means which type. */
  legend(names) {
    byId("tree-types").hidden = !names.length;
    byId("tree-types").append("Types:", ...names.flatMap((name, type) =>
      [made("span", {class: `swatch type-${type % SERIES}`}), name]),
      "; a dot is a change of type.");
  }

  get founder() { return Number(byId("founder").value); }

  of(founder) {
    byId("founder").value = founder;
    this.draw();
  }

  /** The cells of the clone: id, born, end, place from above, in the order
   * in which they are drawn. */
  cells() {
    const lineage = this.lineage, cells = new Map(), order = [];
    const stack = [this.founder];
    while (stack.length) {
      const id = stack.pop(), k = lineage.division[id];
      const died = lineage.deaths.has(id);
      const cell = {id, born: lineage.birth(id), divided: k >= 0, died,
        end: k >= 0 ? lineage.times[k]
          : died ? lineage.deaths.get(id) : lineage.end,
        daughters: k >= 0 ? lineage.daughters(k) : []};
      cells.set(id, cell);
      order.push(cell);
      stack.push(...[...cell.daughters].reverse());
    }
    let leaves = 0;
    for (const cell of order) if (!cell.divided) cell.row = leaves++;
    // daughters come after their mother: from the last to the first
    for (const cell of [...order].reverse()) {
      if (!cell.divided) continue;
      cell.rows = cell.daughters.map((id) => cells.get(id).row);
      cell.row = (cell.rows[0] + cell.rows[1]) / 2;
    }
    return {order, leaves};
  }

  draw() {
    const last = this.lineage.founders - 1;
    byId("founder").value = Math.min(Math.max(0,
      Math.floor(this.founder) || 0), last);
    const {order, leaves} = this.cells();
    const deaths = order.filter(({died}) => died).length;
    byId("tree-words").textContent = `Founder ${this.founder}: `
      + `${leaves - deaths} living cells after ${leaves - 1} divisions`
      + (deaths ? `; ${deaths} died (crosses).` : ".");
    this.picture(order, leaves);
    this.table(order);
  }

  picture(order, leaves) {
    const width = 760, left = 16, right = 70, foot = 34;
    const height = leaves > 60 ? 5 : 20;
    const x = (time) => left + (width - left - right) * time
      / (this.lineage.end || 1);
    const y = (row) => 14 + height * row;
    const bottom = y(leaves - 1) + 12, parts = [];
    for (let i = 0; i <= 5; ++i) {
      const time = this.lineage.end * i / 5;
      parts.push(line(x(time), 4, x(time), bottom, "axis"),
        `<text x="${x(time)}" y="${bottom + 14}" text-anchor="middle">`
        + `${shown(time)}</text>`);
    }
    parts.push(`<text x="${x(this.lineage.end) + 8}" y="${bottom + 14}">`
      + "day</text>");
    for (const cell of order) {
      parts.push(...this.lifeline(cell, x, y(cell.row), height > 5 ? 4 : 2));
      if (cell.divided)
        parts.push(line(x(cell.end), y(cell.rows[0]), x(cell.end),
          y(cell.rows[1]), "ended"));
      else if (cell.died)
        parts.push(...cross(x(cell.end), y(cell.row), height > 5 ? 4 : 2));
      else if (leaves <= 60)
        parts.push(`<text x="${x(cell.end) + 6}" y="${y(cell.row) + 4}">`
          + `${cell.id}</text>`);
    }
    // of numbers alone, which need no escaping
    byId("tree").innerHTML = `<svg width="${width}" height="${bottom + foot}" `
      + `role="img" aria-label="${byId("tree-words").textContent}">`
      + `${parts.join("")}</svg>`;
  }

  /** A cell's line; with types in pieces, and a dot where they meet. */
  lifeline(cell, x, y, radius) {
    const kind = cell.divided || cell.died ? "ended" : "living";
    const history = this.lineage.history(cell.id);
    if (!history.length) return [line(x(cell.born), y, x(cell.end), y, kind)];
    return history.flatMap(({time, type}, i) => {
      const next = history[i + 1] || {time: cell.end};
      const colour = `type-${type % SERIES}`;
      const again = type < SERIES ? "" : " again";
      const piece = line(x(time), y, x(next.time), y,
        `${kind} of-type ${colour}${again}`);
      return i === 0 ? [piece] : [piece, `<circle cx="${x(time).toFixed(1)}" `
        + `cy="${y.toFixed(1)}" r="${radius}" class="${colour}"/>`];
    });
  }

  /** Of the type at birth, and every change. */
  lifeInWords(id) {
    return this.lineage.history(id).map(({time, type}, i) =>
      this.lineage.typeNames[type] + (i ? ` from day ${shown(time)}` : ""))
      .join(", ");
  }

  table(order) {
    const typed = this.lineage.typeNames.length > 0;
    const mortal = this.lineage.deaths.size > 0;
    const head = ["cell", "generation", "born, day", "divided, day",
      ...mortal ? ["died, day"] : [], ...typed ? ["type"] : []];
    const rows = [...order].sort((a, b) => a.id - b.id).slice(0, ROWS)
      .map((cell) => [cell.id, this.lineage.generation[cell.id],
        shown(cell.born),
        cell.divided ? shown(cell.end) : cell.died ? "" : "lives",
        ...mortal ? [cell.died ? shown(cell.end) : ""] : [],
        ...typed ? [this.lifeInWords(cell.id)] : []]);
    const row = (name, fields, attributes) => made("tr", {},
      ...fields.map((field) => made(name, attributes, field)));
    byId("tree-table").replaceChildren(made("table", {},
      made("thead", {}, row("th", head, {scope: "col"})),
      made("tbody", {}, ...rows.map((fields) => row("td", fields, {})))),
      order.length > ROWS
        ? made("p", {}, `The first ${ROWS} of ${order.length}.`) : "");
  }
}

function cross(x, y, size) {
  return [-size, size].map((across) =>
    line(x - size, y - across, x + size, y + across, "died"));
}

function line(x1, y1, x2, y2, kind) {
  const [a, b, c, d] = [x1, y1, x2, y2].map((n) => n.toFixed(1));
  return `<line x1="${a}" y1="${b}" x2="${c}" y2="${d}" class="${kind}"/>`;
}
