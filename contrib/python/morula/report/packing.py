# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Arrays in a page: deflated, and written in base64."""
import base64
import json
import zlib

import numpy as np
from markupsafe import Markup


def packed(*arrays):
    """The bytes of the arrays one after the other, as text. Numbers of two
    bytes are written as all low, then all high bytes, which deflates
    better."""
    parts = []
    for array in arrays:
        array = np.ascontiguousarray(array)
        if array.dtype == np.uint16:
            parts += [(array & 255).astype(np.uint8).tobytes(),
                      (array >> 8).astype(np.uint8).tobytes()]
        else:
            parts.append(array.astype(array.dtype.newbyteorder("<")).tobytes())
    return base64.b64encode(zlib.compress(b"".join(parts), 9)).decode()


def block(name, content):
    """An element that a browser neither shows nor runs; content: base64."""
    return Markup('<script type="text/plain" id="{}">{}</script>\n').format(
        name, content)


def json_block(name, value):
    """A value as JSON in such an element. No "<" stays in it: "</script>"
    would end the element, and after "<!--" and "<script" a browser looks for
    an end that never comes and takes the rest of the page for data."""
    content = json.dumps(value, separators=(",", ":")).replace("<", "\\u003c")
    return Markup('<script type="application/json" id="{}">{}</script>\n'
                  ).format(name, Markup(content))


def quantised(values, low, high, dtype):
    """Values from low to high as whole numbers from 0 to the largest of the
    type; those beyond become the ends."""
    steps = np.iinfo(dtype).max
    scale = steps / (high - low) if high > low else 0.0
    scaled = (np.asarray(values, dtype=float) - low) * scale
    return np.clip(np.rint(scaled), 0, steps).astype(dtype)
