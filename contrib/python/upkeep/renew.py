# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Measures all tables of doc/results.md and writes that page, in some hours, on a
machine with nothing else to do. Done for a version, not for a change.

    contrib/upkeep/renew                the whole page, and the pictures of doc/images
    contrib/upkeep/renew steps speed    prints these sections; the page stays

A section that fails says so in the page, and gives exit code 1; the others are there.
"""
import datetime
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from morula.execute import cores, overrides
from morula.program import Program
from morula.run import Run
from morula.tables import markdown

from . import ROOT, accuracy, parser, said

OUTPUT = ROOT / "output/renew"


def deeper(text, level):
    """Markdown whose highest headings are of this level, and the others below."""
    highest = min((len(marks) for marks in re.findall("^#+(?= )", text, re.M)), default=0)
    return re.sub("^#+(?= )", lambda marks: "#" * (len(marks[0]) - highest + level),
                  text, flags=re.M)


def paper():
    return deeper(said("contrib/reproduce", "--fresh", "--document", "--morula", "build/morula"), 3)


def ladders():
    parts = []
    for name, words in accuracy.LADDERS.items():
        output = OUTPUT / "accuracy" / name
        said("contrib/accuracy", *words, "--again", "--output", output)
        for picture in output.glob("*.png"):
            shutil.copy(picture, ROOT / f"doc/images/accuracy/{name}-{picture.name}")
        tables = (output / "table.md").read_text(encoding="utf-8").partition("\n## ")
        parts += [f"### Error against seconds: {name}",
                  f"```\n{accuracy.wrapped(words)}\n```", deeper("## " + tables[2], 4)]
    return "\n\n".join(parts)


def cases(kind, title):
    """What the cases below tests/KIND write at full length, whether limits are met or not."""
    tables = OUTPUT / kind
    shutil.rmtree(tables, ignore_errors=True)
    subprocess.run(["/usr/bin/python3", "-m", "pytest", "-q", f"tests/{kind}", "--ring=release",
                    f"--work={OUTPUT}/runs", f"--tables={tables}"], cwd=ROOT, stdout=sys.stderr)
    found = sorted(tables.glob("*.md"))
    if not found:
        raise RuntimeError(f"pytest has written no tables of tests/{kind}")
    return "\n\n".join(f"### {title}: {file.stem.replace('_', ' ')}\n\n"
                       + file.read_text(encoding="utf-8").strip() for file in found)


def step(number, **keys):
    """What a step program prints, but for what the run inside it says."""
    text = said(f"build/step-{number}", f"prm/step-{number}.prm", "--replace",
                *overrides({"Output directory": OUTPUT / f"step-{number}", **keys}))
    lines = [line for line in text.splitlines() if line and not re.match(
        r"step \d|Finished|  |(Warning|Material|Applied|Piece): ", line)]
    return "```\n" + "\n".join(lines) + "\n```"


def laws_and_rules():
    """The four runs of step 7."""
    rows = []
    for law in ("none", "crowding limited"):
        for rule in ("random", "long axis"):
            step(7, **{"Growth/Law": law, "Proliferation/Cell cycle/Division axis": rule})
            last = Run(OUTPUT / "step-7").statistics.iloc[-1]
            rows.append([f"{law}, {rule}", *(f"{number:.5g}" for number in (
                last["cells"], last["mean_energy_density"], last["min_elastic_volume_ratio"],
                last["max_elastic_volume_ratio"], last["ymax"] - last["ymin"]))])
    return markdown(["growth law, division rule", "cells", "mean energy, kPa",
                     "smallest $J_e$", "largest $J_e$", "largest width, µm"], rows)


def steps():
    top = {"Growth/Isotropic/Stretch": "1 + 0.1*t*(Z > 100)"}
    parts = {**{f"Step {number}": step(number) for number in range(1, 7)},
             "Step 3, only the top grows": step(3, **top),
             "Step 7, laws and rules": laws_and_rules()}
    return "\n\n".join(f"### {title}\n\n{parts[title]}" for title in sorted(parts))


SECTIONS = {  # name: title, page, what measures it
    "paper": ("The paper's numbers", "reproduction.md", paper),
    "accuracy": ("Error against seconds", "accuracy-and-cost.md", ladders),
    "verification": ("Verification", "verification.md",
                     lambda: cases("verification", "Verification")),
    "hard": ("Hard cases", "hard-cases.md", lambda: cases("hard", "Hard case")),
    "showcase": ("Published data", "showcase.md",
                 lambda: said("contrib/upkeep/showcase", "--again")),
    "speed": ("Speed", "performance.md", lambda: said("contrib/upkeep/benchmark")),
    "steps": ("Steps", "steps/README.md", steps)}


def head():
    """With what the page is made."""
    commit = said("git", "describe", "--always", "--dirty", "--exclude=*")
    processor = re.search(r"^model name\s*: (.*)",
                          Path("/proc/cpuinfo").read_text(encoding="utf-8"), re.M)[1]
    return ("# Results\n\nAll measured tables; pages link to their headings here. "
            "`contrib/upkeep/renew` writes this page\nfrom runs, for a version and not for "
            f"a change.\n\n{Program(ROOT / 'build/morula').version}, {processor}, "
            f"{cores()} cores; {datetime.date.today()}, commit {commit}.")


def main():
    tool = parser(__doc__)
    tool.add_argument("sections", nargs="*", metavar="SECTION", help=", ".join(SECTIONS))
    chosen = tool.parse_args().sections
    if not set(chosen) <= set(SECTIONS):
        tool.error(f"the sections are {', '.join(SECTIONS)}")
    os.environ.pop("OMP_NUM_THREADS", None)
    said("contrib/build", "all")
    parts, failed = [head()], []
    for name in chosen or SECTIONS:
        title, page, measure = SECTIONS[name]
        try:
            body = measure()
        except RuntimeError as error:
            body = f"Not measured: {error}."
            failed.append(name)
        parts.append(f"## {title}\n\n[{page}]({page}) says what the runs are, and what "
                     f"follows from them.\n\n{body}")
    text = "\n\n".join(parts) + "\n"
    if chosen:
        print(text)
    else:
        (ROOT / "doc/results.md").write_text(text, encoding="utf-8")
    return f"renew: failed: {', '.join(failed)}" if failed else 0
