# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Types of cells: from a table, or from the mean of a second channel."""
import re

import numpy as np
from scipy import ndimage
from skimage import filters

from morula.refusal import Refused

from .read import read_image

NAME = re.compile("[A-Za-z][A-Za-z0-9_]*")


def types_of_table(file, names, words):
    """The type of each label of `names`, from columns label and type."""
    import pandas
    try:
        table = pandas.read_csv(file, sep=None, engine="python", dtype=str)
    except (OSError, ValueError) as error:
        raise Refused("--types", file, "a CSV file with columns label and type",
                      f"{error}.") from None
    table.columns = [name.strip().lower() for name in table]
    key = "label" if "label" in table else "id"
    if key not in table or "type" not in table:
        raise Refused("--types", file, "columns label and type", "It has " + ", ".join(table) + ".")
    types = dict(zip(table[key].str.strip(), table["type"].str.strip()))
    missing = [str(name) for name in names if str(name) not in types]
    if missing:
        raise Refused("--types", file, "a type for each label",
                      f"It has none for {len(missing)}, such as {missing[0]}.")
    return checked([types[str(name)] for name in names], "--types", file)


def checked(types, option, file):
    """Refuses types that no type of Morula's can have."""
    for name in types:
        if not NAME.fullmatch(str(name)):
            raise Refused(option, f"{name} in {file}", "names of letters, "
                          "digits and '_' that begin with a letter")
    return [str(name) for name in types]


def types_of_marker(cells, options, words):
    """Two types: cells in which the mean of a channel is above a threshold."""
    file = options.marker or options.file
    image = read_image(file, options.marker_channel, options.frame, "--marker")
    if image.array.shape != cells.labels.shape:
        raise Refused("--marker", file, "an image of the same size, "
                      f"{cells.labels.shape}", f"It is {image.array.shape}.")
    below, comma, above = options.marker_names.partition(",")
    names = checked([below.strip(), above.strip()], "--marker-names", file)
    if not comma or names[0] == names[1]:
        raise Refused("--marker-names", options.marker_names,
                      "two names that differ, separated by a comma")
    means = ndimage.mean(image.array, cells.labels, cells.numbers)
    threshold = options.marker_threshold
    if threshold is None:
        threshold = filters.threshold_otsu(means) if np.ptp(means) else means[0]
    high = means > threshold
    words.append(f"The marker's mean is above {threshold:.6g} in {high.sum()} of {len(high)} "
                 f"cells: these are {names[1]}, the others {names[0]}.")
    return [names[int(one)] for one in high]
