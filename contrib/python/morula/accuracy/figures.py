# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""All figures of a request: NAME.png, error against cost, for every measure
(and time, if there are several), and alone.png, or alone-day-T.png."""
import re

from morula.style import RC, plt

from .figure_alone import alone_figure
from .figure_cost import cost_figure
from .figure_offsets import offsets_figure


def draw(findings, directory):
    with plt.rc_context(RC):
        for estimate in findings.estimates:
            name = re.sub(r"[^A-Za-z0-9]+", "-", estimate.measure.text)
            save(cost_figure(findings, estimate), directory,
                 name.strip("-") + suffix(findings, estimate.time))
        for time in findings.request.times:
            if any(s.time == time for s in findings.scatters):
                save(offsets_figure(findings, time), directory,
                     "offsets" + suffix(findings, time))
            estimates = [e for e in findings.estimates
                         if e.time == time and e.parts]
            if estimates:
                save(alone_figure(findings, estimates), directory,
                     "alone" + suffix(findings, time))


def suffix(findings, time):
    return f"-day-{time:g}" if len(findings.request.times) > 1 else ""


def save(figure, directory, name):
    figure.savefig(directory / f"{name}.png")
    plt.close(figure)
