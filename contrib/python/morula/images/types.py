# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Types of cells: from a table, or from the mean of a second channel."""
import re

import numpy as np
from scipy import ndimage
from skimage import filters

from morula.refusal import Refused

from .read import read_image
from .table import as_text, names_of

NAME = re.compile("[A-Za-z][A-Za-z0-9_]*")


def types_of_table(file, names, words):
    """The type of each label of `names`, from columns label and type."""
    table = as_text(file)
    found = names_of(table)
    if "id" not in found or "type" not in found:
        raise Refused("--types", file, "columns label and type", "It has " + ", ".join(table) + ".")
    types = dict(zip(table[found["id"]], table[found["type"]]))
    missing = [str(name) for name in names if str(name) not in types]
    if missing:
        raise Refused("--types", file, "a type for each label",
                      f"It has none for {len(missing)}, such as {missing[0]}.")
    return named([types[str(name)] for name in names], words)


def named(types, words):
    """The types by names that Morula can have: letters, digits and '_', a letter first."""
    names = {}
    for kind in sorted({*map(str, types)}, key=lambda kind: (not NAME.fullmatch(kind), kind)):
        plain = re.sub("[^A-Za-z0-9]+", "_", kind).strip("_") if not NAME.fullmatch(kind) else kind
        plain = plain if plain[:1].isalpha() else f"type_{plain}" if plain else "no_type"
        names[kind] = next(name for name in [plain, *(f"{plain}_{n}" for n in range(2, 1000))]
                           if name not in names.values())
    changed = [f"'{kind}' is {name}" for kind, name in names.items() if kind != name]
    if changed:
        words.append("Types get names of letters, digits and '_': " + ", ".join(changed) + ".")
    return [names[str(kind)] for kind in types]


def types_of_marker(cells, options, words):
    """Two types: cells in which the mean of a channel is above a threshold."""
    file = options.marker or options.file
    image = read_image(file, options, options.marker_channel, "--marker")
    if image.array.shape != cells.labels.shape:
        raise Refused("--marker", file, "an image of the same size, "
                      f"{cells.labels.shape}", f"It is {image.array.shape}.")
    below, comma, above = options.marker_names.partition(",")
    names = named([below.strip(), above.strip()], words)
    if not comma or below.strip() == above.strip():
        raise Refused("--marker-names", options.marker_names,
                      "two names that differ, separated by a comma")
    finite = np.isfinite(image.array)
    with np.errstate(invalid="ignore", divide="ignore"):
        means = ndimage.mean(np.where(finite, image.array, 0), cells.labels * finite, cells.numbers)
    if not np.isfinite(means).all():
        raise Refused("--marker", file, "a number in each cell", f"{(~np.isfinite(means)).sum()} "
                      "cells have none but nan: fill them, or leave these labels out.")
    threshold = options.marker_threshold
    if threshold is None:
        threshold = filters.threshold_otsu(means) if np.ptp(means) else means[0]
    high = means > threshold
    words.append(f"The marker's mean is above {threshold:.6g} in {high.sum()} of {len(high)} "
                 f"cells: these are {names[1]}, the others {names[0]}.")
    return [names[int(one)] for one in high]
