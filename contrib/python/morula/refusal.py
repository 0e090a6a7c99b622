# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Mistakes in what the user asked for."""


# Of a text that messages show; source/base/input_error.cc does the same.
LONGEST = 400


def shown(text):
    """A text of the user's: the beginning of a long one, and what cannot be printed as \\x00."""
    text = str(text)
    start = "".join(f"\\x{ord(c):02x}" if ord(c) < 32 or ord(c) == 127 else c
                    for c in text[:LONGEST])
    return start + ("..." if len(text) > LONGEST else "")


class Refused(Exception):
    """What was given, its value, what is allowed, what to do; or a sentence alone. It is found
    before anything is computed."""

    def __init__(self, what, value=None, allowed="", remedy=""):
        super().__init__(what if value is None else f"{shown(what)} = '{shown(value)}': "
                         f"allowed is {allowed}." + (f" {remedy}" if remedy else ""))
