# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""How all figures look."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402,F401 (after the backend)
from matplotlib.ticker import FuncFormatter, LogLocator  # noqa: E402

# Colours that people who see few colours can tell apart (Okabe & Ito 2008).
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9",
           "#8B4513", "#444444")
MARKERS = "osD^vP<>"
RC = {"font.family": "sans-serif", "font.size": 9, "axes.titlesize": 9,
      "axes.spines.top": False, "axes.spines.right": False,
      "axes.linewidth": 0.8, "legend.frameon": False, "savefig.dpi": 120,
      "figure.facecolor": "white"}


def colour(number):
    return COLOURS[number % len(COLOURS)]


def marker(number):
    return MARKERS[number % len(MARKERS)]


def log_ticks(axis, low, high, short=False):
    """Ticks at 1, 2, 5 where an axis has few decades, at powers of ten where
    it has many, or is short; written plainly."""
    ratio = high / low
    subs = (1, 2, 5) if ratio < (30 if short else 300) else (1,)
    if ratio < 5:
        subs = (1, 1.5, 2, 3, 4, 6, 8)
    axis.set_major_locator(LogLocator(subs=subs, numticks=4 if short else 12))
    axis.set_major_formatter(FuncFormatter(lambda x, _: plain(x)))
    axis.set_minor_formatter(FuncFormatter(lambda *_: ""))


def plain(number):
    """5e6 and 1e-9 instead of 5e+06 and 1e-09."""
    mantissa, _, power = f"{number:.6g}".partition("e")
    return mantissa + (f"e{int(power)}" if power else "")


def padded(numbers):
    """Limits of a logarithmic axis that holds the numbers."""
    low, high = min(numbers), max(numbers)
    factor = max((high / low) ** 0.12, 1.15)
    return low / factor, high * factor


class Labels:
    """Words beside points, left out where they would lie on each other."""

    PLACES = ((5, 4, "left"), (-5, 4, "right"), (5, -11, "left"),
              (-5, -11, "right"))

    def __init__(self, axes, size=7):
        self.axes, self.size, self.taken = axes, size, []

    def block(self, x, y, radius=5):
        """Keeps words off a point."""
        px, py = self.axes.transData.transform((x, y))
        self.taken.append((px - radius, py - radius, px + radius, py + radius))

    def add(self, x, y, text, colour):
        scale = self.axes.figure.dpi / 72
        px, py = self.axes.transData.transform((x, y))
        width = 0.62 * self.size * len(text) * scale
        for dx, dy, side in self.PLACES:
            left = px + dx * scale - (width if side == "right" else 0)
            low = py + dy * scale
            box = (left, low, left + width, low + self.size * scale)
            if not any(self._overlap(box, other) for other in self.taken):
                self.taken.append(box)
                self.axes.annotate(text, (x, y), xytext=(dx, dy), ha=side,
                                   textcoords="offset points", color=colour,
                                   fontsize=self.size, zorder=6)
                return

    @staticmethod
    def _overlap(a, b):
        return a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]
