// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors
"use strict";

// What is cut away: all on one side of a plane. It is the side of the viewer,
// as the half behind would be hidden by what is left: where the viewer is when
// the plane is chosen or a view set by a button. While the tissue is turned by
// hand, the same half stays, so that it can be looked at from all sides; a
// plane across the view turns with it.

class Cut {
  constructor(about, camera) {
    this.about = about;
    this.camera = camera;
    this.axis = "off";
    this.side = 1;
  }

  /** Looks from where the viewer is: 1 if that is where the axis points. */
  face(axis) {
    this.side = axis in {x: 0, y: 1, z: 2}
      && this.camera.axes[2][axis] < -1e-6 ? -1 : 1;
  }

  /** The plane at a part (0 to 1) of the tissue's extent; the other half is
   * the one away from the viewer. Returns what is cut away, in words. */
  at(axis, place, other) {
    Object.assign(this, {axis, place, other});
    if (axis === "off") return "";
    const normal = axis === "view" ? this.camera.axes[2]
      : new THREE.Vector3(+(axis === "x"), +(axis === "y"), +(axis === "z"));
    const {size} = this.about;
    const reach = axis === "view" ? 0.5 * Math.hypot(...size)
      : 0.5 * size["xyz".indexOf(axis)];
    const where = this.camera.middle.dot(normal) + (2 * place - 1) * reach;
    const sign = other ? -this.side : this.side;
    this.normal = normal.multiplyScalar(sign);
    this.limit = sign * where;
    return axis === "view" ? (other ? "what is behind it" : "what is before it")
      : `${axis} ${sign > 0 ? ">" : "<"} ${shown(Math.round(where))} µm`;
  }

  /** Turns a plane across the view with it; whether there is one. */
  follows() {
    if (this.axis !== "view") return false;
    this.at("view", this.place, this.other);
    return true;
  }

  /** How far cell i lies before the cut (µm); infinite without one. */
  before(places, i) {
    if (this.axis === "off") return Infinity;
    const {low, size} = this.about, {normal, limit} = this;
    return limit
      - normal.x * (low[0] + size[0] * places[4 * i] / 65535)
      - normal.y * (low[1] + size[1] * places[4 * i + 1] / 65535)
      - normal.z * (low[2] + size[2] * places[4 * i + 2] / 65535);
  }
}
