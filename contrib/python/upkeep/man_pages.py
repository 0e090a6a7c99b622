# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Writes doc/man: a manual page for the program and for each tool that is
installed, from what --help says, by Debian's help2man. Done when the words of a
command line have changed, and for a release.

    contrib/upkeep/man-pages
"""
import argparse
import datetime
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from morula.__main__ import TOOLS
from morula.execute import call

from .version_data import ROOT, version

FOLDER = "doc/man"
# What a page says behind the name.
SUMMARIES = {
    "morula": "grow and deform tissue of continuum-based cell particles",
    "accuracy": "errors of a scene against what they cost",
    "cell-shapes": "the cells of a run as polyhedra, for ParaView",
    "export": "a run for other programs: tracks, tables, label images",
    "import": "a scene of a label image or a tracker's table",
    "render": "pictures and films of a run's cells",
    "report": "one HTML page about a run",
    "sweep": "many runs of a scene, with their mean and scatter"}
EXIT_STATUS = {True: "0: finished; 1: bad input, nothing was computed or written; 2: "
                     "the run\nfailed, and \\-\\-resume goes on from its last snapshot.",
               False: "0: done; 1: what was asked for makes no sense, or a file is "
                      "missing; 130:\nit was stopped."}


def names():
    """Of the commands that are installed: morula, morula-accuracy, ..."""
    return ["morula", *(f"morula-{name}" for name, module in TOOLS.items()
                        if module.startswith("morula."))]


def release_date(root=ROOT):
    """That of CITATION.cff, for pages that do not change from day to day."""
    text = (root / "CITATION.cff").read_text(encoding="utf-8")
    return datetime.date.fromisoformat(
        re.search(r"^date-released: (\S+)$", text, re.M)[1])


def help_of(name, morula):
    """What a command says for --help, with the names of an installation."""
    tool = name.removeprefix("morula").removeprefix("-")
    words = [ROOT / "contrib" / tool] if tool else [morula]
    with_names = {**os.environ, "COLUMNS": "80"}
    found = call([*words, "--help"], env=with_names)
    if found.code:
        raise RuntimeError(f"{name} --help: {found.text}")
    text = re.sub(rf"^usage: (contrib/)?{tool}\b" if tool else "^$",
                  f"usage: {name}", found.stdout)
    return re.sub(r"contrib/(?:python/)?([a-z-]+)(?=[\s.,;])",
                  lambda match: f"morula-{match[1]}"
                  if match[1] in TOOLS else match[0], text)


def parts_of(text):
    """The help as help2man wants it, with one line of usage and the options of
    Boost as those of GNU; and the lines of the examples, which stand in a list
    `examples:` or are indented by four."""
    usage, _, rest = text.partition("\n\n")
    lines, examples = [], []
    if usage.startswith("usage: "):
        usage = " ".join(usage.split()).replace("usage", "Usage")
        usage = re.sub(r"( \[-[^]]*\])+", " [OPTION]...", usage, count=1)
        usage = re.sub(r" \[-[^]]*\]", "", usage)
        rest = re.sub(r"^positional arguments:", "Arguments:", rest, flags=re.M)
        rest = re.sub(r"^options:", "Options:", rest, flags=re.M)
    else:  # the program says first what it is
        about, (usage, _, rest) = usage, rest.partition("\n\n")
        usage = re.sub(r"\n {4,}", "\n  or:  ", usage)
        rest = f"{about}\n\n{rest}"
        rest = rest.partition("\nExit codes:")[0]
        rest = re.sub(r"^  (-\w) \[ (--\w+) \] ?", r"  \1, \2 ", rest, flags=re.M)
        rest = re.sub(r"^(  -.*?\w) \[=(\w+)\]", r"\1[=\2]", rest, flags=re.M)
        rest = re.sub(r"^(  -s, --set KEY=VALUE) ", r"\1\n" + 25 * " ", rest,
                      flags=re.M)
    option = named = False  # within an option; within a list of examples
    for line in rest.splitlines():
        named = line == "examples:" or (named and line != "")
        if named:
            examples += [f"  {line}"] if line.startswith("  ") else []
            continue
        option = line.startswith("  ") and not line.startswith("    ") or (
            option and line.startswith("    "))
        example = not option and re.match(r"    +\S", line)
        (examples if example else lines).append(line)
    body = re.sub(r"\n{3,}", "\n\n", "\n".join(lines))
    return f"{usage}\n\n{body}\n", examples


def page_of(name, morula):
    """The page, as troff."""
    text, examples = parts_of(help_of(name, morula))
    others = ", ".join(f"\\fB{other}\\fR(1)" for other in names()
                       if other != name)
    added = f"[exit status]\n{EXIT_STATUS[name == 'morula']}\n\n"
    if examples:
        shown = "\n".join(line[2:].replace("\\", "\\\\").replace("-", "\\-")
                          for line in examples)
        added += f"[examples]\n.nf\n{shown}\n.fi\n\n"
    added += f"[see also]\n{others},\n/usr/share/doc/morula\n"
    with tempfile.TemporaryDirectory() as scratch:
        program, more = Path(scratch) / name, Path(scratch) / "more"
        (Path(scratch) / "help").write_text(text, encoding="utf-8")
        program.write_text('#!/bin/sh\ncat "$(dirname "$0")/help"\n')
        program.chmod(0o755)
        more.write_text(added, encoding="utf-8")
        page = subprocess.run(
            ["help2man", "--no-info", f"--version-string={version()}",
             "--source=Morula " + version(), "--locale=C.UTF-8",
             "--name", SUMMARIES[name.removeprefix("morula-")],
             f"--include={more}", program],
            check=True, text=True, stdout=subprocess.PIPE).stdout
    page = re.sub(r'^(\.TH \S+ "1") "[^"]*"', rf'\1 "{release_date()}"', page,
                  flags=re.M)
    return ('.\\" SPDX-License-Identifier: GPL-3.0-or-later\n'
            '.\\" Copyright (C) 2026 by the Morula authors\n'
            '.\\" Written by contrib/upkeep/man-pages with help2man; not edited.\n'
            + page.partition("\n")[2])


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--morula", default=ROOT / "build/morula",
                        help="the executable")
    parser.add_argument("--output", type=Path, default=ROOT / FOLDER,
                        help=f"a directory; default: {FOLDER}")
    options = parser.parse_args()
    if not shutil.which("help2man"):
        return "man-pages: help2man is missing; contrib/setup installs it."
    options.output.mkdir(parents=True, exist_ok=True)
    for name in names():
        file = options.output / f"{name}.1"
        file.write_text(page_of(name, options.morula), encoding="utf-8")
        print(f"man-pages: {file}", file=sys.stderr)
    return 0
