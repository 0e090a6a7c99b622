// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors
"use strict";

// The sections of the page as tabs. Without JavaScript all are visible.

class Tabs {
  constructor(list) {
    this.sections = [...document.querySelectorAll("section[data-tab]")];
    this.buttons = this.sections.map((section) => {
      const button = document.createElement("button");
      button.type = "button";
      button.id = `tab-${section.id}`;
      button.textContent = section.dataset.tab;
      button.setAttribute("role", "tab");
      button.setAttribute("aria-controls", section.id);
      section.setAttribute("role", "tabpanel");
      section.setAttribute("aria-labelledby", button.id);
      button.addEventListener("click", () => this.show(section.id));
      list.append(button);
      return button;
    });
    list.addEventListener("keydown", (event) => this.key(event));
    this.onShow = () => {};
    const wanted = location.hash.slice(1);
    this.show(this.sections.some((s) => s.id === wanted) ? wanted
      : this.sections[0].id);
  }

  show(id) {
    this.sections.forEach((section, i) => {
      const chosen = section.id === id;
      section.hidden = !chosen;
      this.buttons[i].setAttribute("aria-selected", String(chosen));
      this.buttons[i].tabIndex = chosen ? 0 : -1;
      if (chosen) this.chosen = i;
    });
    this.onShow(id);
  }

  /** Arrow keys go from tab to tab, as the ARIA practices say. */
  key(event) {
    const n = this.buttons.length;
    const next = {ArrowRight: this.chosen + 1, ArrowLeft: this.chosen + n - 1,
      Home: 0, End: n - 1}[event.key];
    if (next === undefined) return;
    event.preventDefault();
    this.show(this.sections[next % n].id);
    this.buttons[this.chosen].focus();
  }
}
