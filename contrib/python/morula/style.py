# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""How all figures look."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402,F401 (after the backend)
import numpy as np  # noqa: E402
from matplotlib.ticker import FuncFormatter, LogLocator  # noqa: E402

# Colours that people who see few colours can tell apart (Okabe & Ito 2008).
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#8B4513", "#444444")
MARKERS = "osD^vP<>"
RC = {"font.family": "sans-serif", "font.size": 9, "axes.titlesize": 9, "axes.spines.top": False,
      "axes.spines.right": False, "axes.linewidth": 0.8, "legend.frameon": False,
      "savefig.dpi": 120, "figure.facecolor": "white"}


def colour(number):
    return COLOURS[number % len(COLOURS)]


def marker(number):
    return MARKERS[number % len(MARKERS)]


def pixels(figure):
    """The picture (height, width, 3), bytes, of a figure, which is closed."""
    figure.canvas.draw()
    picture = np.array(figure.canvas.buffer_rgba())[:, :, :3]
    plt.close(figure)
    return picture


def log_ticks(axis, low, high):
    """Ticks at 1, 2, 5 where an axis has few decades, at powers of ten where
    it has many; written plainly."""
    ratio = high / low
    subs = (1, 1.5, 2, 3, 4, 6, 8) if ratio < 5 else (1, 2, 5) if ratio < 300 else (1,)
    axis.set_major_locator(LogLocator(subs=subs, numticks=12))
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
