# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Measures the tables of doc/results.md and writes that page, in some hours, on a
machine with nothing else to do. Done for a version, not for a change.

    contrib/upkeep/renew                the whole page, and the pictures of doc/images
    contrib/upkeep/renew hard speed     prints these sections; the page stays

Runs that are neither fast nor right, columns that nobody reads and figures that say the
same are left out. A section that fails says so in the page, and gives exit code 1.
"""
import datetime
import os
import re
import shutil
import subprocess
import sys

from morula.execute import cores
from morula.program import Program
from morula.tables import markdown

from . import ROOT, accuracy, parser, said

OUTPUT = ROOT / "output/renew"
LEFT_OUT = ("unknowns", "memory, MB", "error in time, own estimate", "runs", "mean", "smallest",
            "largest", "refilled", "cells", "minutes", "ours / paper", "volume off, relative",
            "surface over that of a ball")


def tables_of(text):
    """The tables of a Markdown text: lists of rows of cells, the header first."""
    return [[re.split(r"(?<!\\) \| ", line[2:-2]) for line in lines.splitlines()
             if "---" not in line] for lines in re.findall(r"(?:^\|.*\n?)+", text, re.M)]


def without(table, keep=lambda row: True):
    """A table without the columns that are left out and the rows that are not kept."""
    columns = [i for i, name in enumerate(table[0]) if name not in LEFT_OUT]
    return markdown([table[0][i] for i in columns],
                    [[row[i].replace("\\|", "|") for i in columns] for row in table[1:] if keep(row)])


def shorter(text):
    return re.sub(r"(?:^\|.*\n?)+", lambda lines: without(*tables_of(lines[0])) + "\n", text, flags=re.M)


def named(row):
    """The row of a run, with a word for the keys of its method."""
    own = [words for words in row[0].split(", ") if not words.startswith(accuracy.KEYS)]
    method = next((word for sign, word in (("symmetric", "paper's method"),
                                           ("whole", "defaults of 0.2.0")) if sign in row[0]), "")
    return [", ".join(filter(None, [*own, method])), *row[1:]]


def ladder(title, text):
    """The tables of a table.md of contrib/accuracy, but for ladders that are not counted."""
    parts = [f"### Error against seconds: {title}"]
    for heading, body in re.findall(r"^#+ ((?:Runs|Each|Scatter).*)\n([^#]*)", text, re.M):
        parts += [f"#### {heading}", *(without([named(row) for row in table], lambda row: not (
            re.search(r"\[|spread", "".join(row)))) for table in tables_of(body))]
    return "\n\n".join(parts)


def ladders():
    parts = ["●: no run is both faster and better. In brackets: not distinguishable from zero. Commands: "
             "contrib/python/upkeep/accuracy.py.\nProcessor time: user and system time of a run."]
    for name, words in accuracy.LADDERS.items():
        output = OUTPUT / "accuracy" / name
        said("contrib/accuracy", *words, "--again", "--output", output)
        file = max(output.glob("*/table.md"), key=os.path.getmtime)
        picture = ROOT / f"doc/images/accuracy/{name}.png"
        if picture.exists():
            shutil.copy(file.with_name("accuracy.png"), picture)
        parts.append(ladder(name, file.read_text(encoding="utf-8")))
    return "\n\n".join(parts)


def cases(kind):
    """What the cases below tests/KIND write at full length, whether limits are met or not."""
    tables = OUTPUT / kind
    shutil.rmtree(tables, ignore_errors=True)
    subprocess.run(["/usr/bin/python3", "-m", "pytest", "-q", f"tests/{kind}", "--ring=release",
                    f"--work={OUTPUT}/runs", f"--tables={tables}"], cwd=ROOT, stdout=sys.stderr)
    found = {file.stem.replace("_", " "): {table[0][0]: table[1:] for table in tables_of(
        file.read_text(encoding="utf-8"))} for file in sorted(tables.glob("*.md"))}
    if not found:
        raise RuntimeError(f"pytest has written no tables of tests/{kind}")
    return found


def orders(found):
    """Ladders of all cases of verification, and the limits that are not met."""
    rows = [[f"{case}: {row[0]}", row[3], next(filter(None, row[4:]), "")]
            for case, parts in found.items() for row in parts["ladder"] if row[0][-3:] != "-dt"]
    missed = [f"- **Not met**: {case}, {figure}: {value} ({limit.partition(' **')[0]})"
              for case, parts in found.items() for figure, value, limit, _ in parts["figure"]
              if "not met" in limit]
    return "\n\n".join([markdown(["case: ladder", "displacement", "stress"], rows),
                        "\n".join(missed)]).strip()


def limits(found):
    """Of the figures of hard cases that are alike the one nearest to its limit, from half on."""
    rows = {}
    for case, parts in found.items():
        for figure, value, limit, used in parts["figure"]:
            of, _, kind = figure.rpartition(": ")
            alike = case, figure if "not met" in limit else kind
            rows[alike] = max(rows.get(alike, (0.5,)), (float(used), case, kind, of, value, limit))
    return markdown(["case", "what is asserted", "of", "measured", "limit"],
                    [row[1:] for row in rows.values() if row[1:]])


SECTIONS = {  # name: title, page, what measures it
    "paper": ("The paper's numbers", "reproduction.md", lambda: shorter(said(
        "contrib/reproduce", "--fresh", "--document", "--morula", "build/morula"))),
    "accuracy": ("Error against seconds", "accuracy-and-cost.md", ladders),
    "verification": ("Verification", "verification.md", lambda: orders(cases("verification"))),
    "hard": ("Hard cases", "hard-cases.md", lambda: limits(cases("hard"))),
    "showcase": ("Published data", "showcase.md", lambda: shorter(said(
        "contrib/upkeep/showcase", "--again"))),
    "speed": ("Speed", "performance.md", lambda: said("contrib/upkeep/benchmark"))}


def measured():
    """With what a section is measured."""
    commit = said("git", "describe", "--always", "--dirty", "--exclude=*")
    processor = re.search(r"^model name\s*: (.*)", said("cat", "/proc/cpuinfo"), re.M)[1]
    return (f"{Program(ROOT / 'build/morula').version}, {processor}, {cores()} cores; "
            f"{datetime.date.today()}, commit {commit}.")


def main():
    tool = parser(__doc__)
    tool.add_argument("sections", nargs="*", metavar="SECTION", help=", ".join(SECTIONS))
    chosen = tool.parse_args().sections
    if not set(chosen) <= set(SECTIONS):
        tool.error(f"the sections are {', '.join(SECTIONS)}")
    os.environ.pop("OMP_NUM_THREADS", None)
    said("contrib/build", "all")
    parts, failed = ["# Results\n\nThe tables that a version was measured with; pages link here. "
                     "`contrib/upkeep/renew` writes this page\nfrom runs, for a version and not "
                     "for a change."], []
    for name in chosen or SECTIONS:
        title, page, measure = SECTIONS[name]
        try:
            body = measure()
        except RuntimeError as error:
            body = f"Not measured: {error}."
            failed.append(name)
        parts.append(f"## {title}\n\n[{page}]({page}) says what the runs are, and what "
                     f"follows from them.\n{measured()}\n\n{body}")
    text = "\n\n".join(parts) + "\n"
    if chosen:
        print(text)
    else:
        (ROOT / "doc/results.md").write_text(text, encoding="utf-8")
    return f"renew: failed: {', '.join(failed)}" if failed else 0
