# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The files of a scene: cells, surface, .prm."""
import itertools
import re

import numpy as np

from morula.files import replaced, write, write_csv
from morula.refusal import Refused, shown

NAMES = "xyz"


def write_cells(file, places, volumes, others):
    """cells.csv; places (n, dim) in the order x, y, z; `others` are further
    columns by their names: lists, or None for a column that is not there."""
    names = [*NAMES[:places.shape[1]], "volume"]
    rows = [[format(number, ".9g") for number in (*place, volume)]
            for place, volume in zip(places, volumes)]
    for name, entries in others.items():
        if entries:
            names.append(name)
            rows = [[*row, entry] for row, entry in zip(rows, entries)]
    write_csv(file, [names, *rows])


def write_off(file, parts):
    """The parts as one OFF file."""
    with replaced(file) as aside, aside.open("w", encoding="ascii") as stream:
        stream.write(f"OFF\n{sum(len(part.vertices) for part in parts)} "
                     f"{sum(len(part.facets) for part in parts)} 0\n")
        for part in parts:
            np.savetxt(stream, part.vertices[:, ::-1], "%.9g")
        before = 0
        for part in parts:
            np.savetxt(stream, np.insert(part.facets + before, 0, 3, axis=1), "%d")
            before += len(part.vertices)


def write_wkt(file, parts):
    """Outlines as a MULTIPOLYGON: each body with the cavities in it."""
    from .surface import contains
    bodies = [[part] for part in parts if part.volume > 0]
    for cavity in (part for part in parts if part.volume < 0):
        around = [body for body in bodies if contains(body[0], cavity.vertices[:1])[0]]
        min(around, key=lambda body: body[0].volume).append(cavity)
    text = ",\n".join("(" + ",\n ".join(map(_ring, body)) + ")" for body in bodies)
    write(file, f"MULTIPOLYGON({text})\n")


def _ring(part):
    line = np.concatenate([part.vertices, part.vertices[:1]])[:, ::-1]
    return "(" + ", ".join(f"{x:.9g} {y:.9g}" for x, y in line) + ")"


def refuse_signs(what, value, remedy):
    """Refuses what a .prm file would read otherwise: no sign can be quoted in it."""
    found = re.search(r"[#\x00-\x1f\x7f]|\\\s*$", str(value))
    if found:
        raise Refused(what, value, f"a text without '{shown(found[0])}'"
                      + (" at its end" if found[0][0] == "\\" else ""), remedy)


def prm(keys, comments):
    """A .prm text of keys by full path; comments stand at its begin. Keys that
    follow each other in a section share it."""
    for path, value in keys.items():
        refuse_signs(path, value, "A .prm file cannot hold this sign.")
    lines = [*(f"# {shown(line)}" for line in comments), ""]
    for sections, group in itertools.groupby(keys.items(), lambda item: item[0].split("/")[:-1]):
        lines += ["  " * depth + f"subsection {section}" for depth, section in enumerate(sections)]
        lines += ["  " * len(sections) + f"set {path.split('/')[-1]} = {value}"
                  for path, value in group]
        lines += ["  " * depth + "end" for depth in reversed(range(len(sections)))]
    return "\n".join(lines) + "\n"
