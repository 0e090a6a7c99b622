# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The whole page from its parts. The templates escape all text of a run, which
may come from somebody else."""
import base64
import hashlib

from morula.run import NoStates

from . import accuracy, curves, effort, lineage, pictures, scene
from .cells import Packed, fields_of, palettes
from .libraries import three
from .markup import PAGE, TEMPLATES, Markup, joined, paragraph
from .packing import json_block
from .selection import DEFAULT_FIELDS

SCRIPTS = ("data.js", "tabs.js", "spheres.js", "axes.js", "camera.js",
           "cut.js", "view.js", "legend.js", "saving.js", "panel.js",
           "tree.js", "start.js")


def page(run, program, options, say):
    """The page as text."""
    cells, left_out = pack_cells(run, options)
    family, blocks = pack_lineage(run)
    about = {"name": run.name, "view": cells and cells.about,
             "lineage": family,
             "palettes": palettes(cells.meanings if cells else {})}
    if cells:
        blocks += cells.blocks
        left_out = [*cells.selection.words, *left_out]
    last, code = run.statistics.iloc[-1], scripts(cells is not None)
    parts = {
        "title": run.name, "flat": run.dimension == 2,
        "subtitle": f"{last['cells']:,.0f} cells at day {last['time']:g}",
        "style": Markup((PAGE / "style.css").read_text(encoding="utf-8")),
        "glance": scene.at_a_glance(run),
        "keys": scene.changed_keys(run, program),
        "effects": scene.effects(run, program),
        "log": log(run), "pictures": options.pictures
        and pictures.pictures(run, say) or "",
        "curves": curves.figures(run, curves.results(run)),
        "effort_curves": curves.figures(run, curves.effort(run)),
        "timings": effort.timings(run), "counters": effort.counters(run),
        "accuracy": accuracy.numbers(run), "notes": accuracy.notes(run),
        "lineage": family_part(run, family),
        "left_out": left_out,
        "view_state": "" if cells else "hidden",
        "no_view": why_no_view(run, options) if not cells else "",
        "blocks": joined([json_block("about", about), *blocks]),
        "script_digests": Markup(" ".join(map(digest, code))),
        "scripts": Markup("\n".join(f"<script>{script}</script>"
                                    for script in code))}
    return TEMPLATES.get_template("template.html").render(parts)


def pack_cells(run, options):
    """The packed states, or None, and what was left out, in sentences."""
    if not len(run.times) or options.states == 0:
        return None, []
    there = fields_of(run.cells(-1))
    fields = options.fields or [f for f in DEFAULT_FIELDS if f in there]
    packed = Packed(run, fields, options.states, options.limit * 1e6)
    rest = [name for name in there if name not in fields]
    words = [
        "Positions are rounded to 1/65,535 of the box round the tissue, "
        f"{max(packed.high - packed.low) / 65535:.2g} µm, radii and fields "
        "to 1/255 of their range; the files of the run have all digits."]
    if rest:
        words.append(f"Columns that are not here: {', '.join(rest)} "
                     "(--fields).")
    return packed, words


def pack_lineage(run):
    try:
        return lineage.about(run), lineage.blocks(run)
    except NoStates:
        return None, []


def family_part(run, family):
    if family is None:
        return paragraph("There is no lineage.csv.")
    return (lineage.summary(run) + Markup('<div class="figures">')
            + lineage.histograms(run) + Markup("</div>"))


def why_no_view(run, options):
    if options.states == 0:
        return "The page was made without the 3-D view (--states 0)."
    return ("No cells were written (Output/Formats = none), so that there is "
            "nothing to show in 3-D. The curves, the lineage and the costs "
            "are complete.")


def log(run):
    lines = scene.log_lines(run)
    return "\n".join(lines) or "It has only a line a step."


def scripts(with_view):
    """The library, if there is a view, then the page's own."""
    found = three() if with_view else []
    found += [(PAGE / name).read_text(encoding="utf-8") for name in SCRIPTS]
    for script in found:
        if "</script" in script.lower() or "<!--" in script:
            raise ValueError("a script would end its own element, or hide it")
    return [f"\n{script}\n" for script in found]


def digest(script):
    """What the page's policy knows a script by: a browser runs these scripts
    and no other, not even one that gets into the page past the templates."""
    sha = hashlib.sha256(script.encode()).digest()
    return f"'sha256-{base64.b64encode(sha).decode()}'"
