# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The library for the 3-D view: three.js, as Debian packages it."""
import re
from pathlib import Path

from morula.refusal import Refused

DIRECTORY = Path("/usr/share/javascript/three")
LICENCE = Path("/usr/share/doc/libjs-three/copyright")
FILES = ("build/three.min.js", "examples/js/controls/OrbitControls.js")


def three():
    """Its scripts, in order, with the licence that must go with every copy.
    Throws Refused if the package is missing."""
    for name in FILES:
        if not (DIRECTORY / name).is_file():
            raise Refused("three.js", DIRECTORY / name, "Debian's package "
                          "libjs-three", "contrib/setup installs it; "
                          "--states 0 makes a page without the 3-D view.")
    scripts = [(DIRECTORY / name).read_text(encoding="utf-8")
               for name in FILES]
    return [f"/* {licence()} */\n{scripts[0]}", *scripts[1:]]


def licence():
    """Whose three.js is, and under which terms, from the package's own
    file."""
    if not LICENCE.is_file():
        return "three.js, by the three.js authors, MIT licence"
    text = LICENCE.read_text(encoding="utf-8")
    whose = re.search(r"^Files: \*\nCopyright: (.*)$", text, re.MULTILINE)
    terms = re.search(r"^License: Expat\n((?: .*\n)+)", text, re.MULTILINE)
    return "three.js, {}, MIT licence:\n{}".format(
        whose[1] if whose else "the three.js authors",
        terms[1] if terms else "").replace("*/", "* /")
