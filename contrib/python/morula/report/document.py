# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The whole page from its parts. The template escapes all text of a run, which
may come from somebody else."""
import base64
import hashlib
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from morula.refusal import Refused

from . import curves, lineage, numbers, scene
from .cells import DEFAULT_FIELDS, Packed, fields_of
from .pictures import pictures

PAGE = Path(__file__).with_name("page")
TEMPLATES = Environment(loader=FileSystemLoader(PAGE), autoescape=True, undefined=StrictUndefined)
# Debian's package; its own files hold the notice of its licence.
THREE = Path("/usr/share/javascript/three")
LIBRARIES = (THREE / "build/three.min.js", THREE / "examples/js/controls/OrbitControls.js")
LICENCE = Path("/usr/share/doc/libjs-three/copyright")


def page(run, program, options):
    """The page as text."""
    cells = pack_cells(run, options)
    code = scripts() if cells else []
    return TEMPLATES.get_template("template.html").render(
        run=run, program=program, cells=cells, numbers=numbers, scene=scene,
        why_no_view="" if cells else
        "The page was made without the 3-D view (--states 0)." if options.states == 0 else
        "No cells were written (Output/Formats = none).",
        pictures=pictures(run) if options.pictures else [],
        curves=curves.figures(run, curves.results(run)),
        effort=curves.figures(run, curves.effort(run)),
        lineage=(run.directory / "lineage.csv").is_file() and len(run.lineage) and lineage,
        style=(PAGE / "style.css").read_text(encoding="utf-8"),
        scripts=code, digests=[digest(script) for script in code])


def pack_cells(run, options):
    """The packed states, or None."""
    if not len(run.times) or options.states == 0:
        return None
    there = fields_of(run.cells(-1))
    fields = options.fields or [f for f in DEFAULT_FIELDS if f in there]
    return Packed(run, fields, options.states, options.limit * 1e6)


def scripts():
    """The library with its licence, which must go with every copy, then the page's own."""
    if not all(file.is_file() for file in LIBRARIES):
        raise Refused("three.js", LIBRARIES[0], "Debian's package libjs-three",
                      "contrib/setup installs it; --states 0 makes a page without the 3-D view.")
    files = [*LIBRARIES, PAGE / "spheres.js", PAGE / "view.js"]
    found = [file.read_text(encoding="utf-8") for file in files]
    if LICENCE.is_file():
        terms = LICENCE.read_text(encoding="utf-8").replace("*/", "* /")
        found[0] = f"/* {terms} */\n{found[0]}"
    for script in found:
        if "</script" in script.lower() or "<!--" in script:
            raise ValueError("a script would end its own element, or hide it")
    return found


def digest(script):
    """What the page's policy knows a script by: a browser runs these scripts
    and no other, not even one that gets into the page past the template."""
    sha = hashlib.sha256(script.encode()).digest()
    return f"'sha256-{base64.b64encode(sha).decode()}'"
