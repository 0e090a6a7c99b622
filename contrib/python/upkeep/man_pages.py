# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Writes doc/man: a manual page for the program and for each tool that is
installed, from what --help says, by Debian's help2man. Done when the words of a
command line have changed, and for a release.

    contrib/upkeep/man-pages
"""
import re
import tempfile
from pathlib import Path

from . import ROOT, parser, said

# What a page says behind the name.
SUMMARIES = {"morula": "grow and deform tissue of continuum-based cell particles",
             "morula-accuracy": "errors of a scene against what they cost",
             "morula-cell-shapes": "the cells of a run as polyhedra, for ParaView",
             "morula-export": "a run for other programs: tracks, tables, label images",
             "morula-import": "a scene of a label image or a tracker's table",
             "morula-render": "pictures and films of a run's cells",
             "morula-report": "one HTML page about a run",
             "morula-sweep": "many runs of a scene, with their mean and scatter"}
COMMAND = re.compile(r"^  +morula (?:.*\\\n)*.*\n", re.M)
ADDED = """[examples]
.nf
{examples}.fi

[exit status]
0: done; 1: bad input, nothing was computed or written; 2: a run failed, and
\\-\\-resume goes on from its last snapshot; 130: it was stopped.

[see also]
{others}
"""


def help_of(name, morula):
    """With the names of an installation, one line of usage, and GNU's form of options."""
    if name == "morula":
        about, usage, rest = said(morula, "--help").split("\n\n", 2)
        usage = re.sub(r"\n {4,}", "\n  or:  ", usage)
        rest = rest.partition("\nExit codes:")[0]
        rest = re.sub(r"^  (-\w) \[ (--\w+) \] ?", r"  \1, \2 ", rest, flags=re.M)
        rest = re.sub(r"^(  -.*?\w) \[=(\w+)\]", r"\1[=\2]", rest, flags=re.M)
        return f"{usage}\n\n{about}\n\n{rest.replace('KEY=VALUE ', 'KEY=VALUE  ')}"
    text = said(ROOT / "contrib" / name.removeprefix("morula-"), "--help")
    text = re.sub(r"^ *contrib/(?=[a-z-]+ )", "  morula ", text, flags=re.M)
    usage, _, rest = text.partition("\n\n")
    operands = re.sub(r"\[-[^]]*\] ?", "", " ".join(usage.split()[3:]))
    for old, new in (("positional a", "A"), ("options:", "Options:"), ("examples:\n", "")):
        rest = rest.replace(f"\n{old}", f"\n{new}", 1)
    return f"Usage: {' '.join(usage.split()[1:3])} [OPTION]... {operands}\n\n{rest}"


def page_of(name, morula):
    text = help_of(name, morula)
    examples = re.sub("^  ", "", "".join(COMMAND.findall(text)), flags=re.M).replace(
        "\\", "\\\\").replace("-", "\\-")
    others = ", ".join(f"{other}(1)" for other in SUMMARIES)
    added = (ADDED if examples else ADDED.partition(".fi\n\n")[2]).format(
        examples=examples, others=others)
    version, day = re.search(r"version: (\S+)\ndate-released: (\S+)",
                             (ROOT / "CITATION.cff").read_text(encoding="utf-8")).groups()
    with tempfile.TemporaryDirectory() as scratch:
        program, more = Path(scratch) / name, Path(scratch) / "more"
        program.write_text(f"#!/bin/sh\ncat <<'END'\n{COMMAND.sub('', text)}\nEND\n")
        program.chmod(0o755)
        more.write_text(added, encoding="utf-8")
        page = said("help2man", "--no-info", f"--version-string={version}",
                    f"--source=Morula {version}", "--locale=C.UTF-8",
                    "--name", SUMMARIES[name], f"--include={more}", program)
    return re.sub(r'^(\.TH \S+ "1") "[^"]*"', rf'\1 "{day}"', page, flags=re.M) + "\n"


def main():
    tool = parser(__doc__)
    tool.add_argument("--morula", default=ROOT / "build/morula", help="the executable")
    options = tool.parse_args()
    for name in SUMMARIES:
        (ROOT / f"doc/man/{name}.1").write_text(page_of(name, options.morula), encoding="utf-8")
