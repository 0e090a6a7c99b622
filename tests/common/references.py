# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""References of runs: three rows of each table, and how much work it was."""
import csv
from pathlib import Path

from tests.common.work import counters, excess

REFERENCES = Path(__file__).resolve().parents[1] / "scenes/references"
# Iterations depend on the processor; work.py counts them.
IGNORED = {"wall_seconds", "newton_iterations", "linear_iterations", "residual",
           "turns", "proximal_paths"}


def read(path):
    with open(path, newline="", encoding="utf-8") as stream:
        return list(csv.reader(stream))


def kept(path):
    """The header of a table and its first, its middle and its last row, each behind
    its number, which tells a row too many or one that is missing."""
    header, *rows = read(path)
    columns = [i for i, name in enumerate(header) if name not in IGNORED]
    numbers = sorted({1, (len(rows) + 1) // 2, len(rows)})
    return [["row", *(header[i] for i in columns)],
            *([str(n), *(rows[n - 1][i] for i in columns)] for n in numbers)]


def same(one, other, absolute):
    """Whether two texts are one, or numbers that agree to 1e-6 of them or to this."""
    try:
        a, b = float(one), float(other)
    except ValueError:
        return one == other
    return abs(a - b) <= max(absolute, 1e-6 * min(abs(a), abs(b)))


def write(path, rows):
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w", newline="", encoding="utf-8") as stream:
        csv.writer(stream, lineterminator="\n").writerows(rows)


def compare(name, output, files, ranks=1, absolute=1e-6, update=False):
    """Compares tables of a run with tests/scenes/references/NAME, and the work that
    it was, or writes them anew."""
    folder = REFERENCES / name
    found = {file: kept(output / file) for file in files}
    work = counters(output)
    if update:
        found["work.csv"] = [list(work), [str(number) for number in work.values()]]
        for file, rows in found.items():
            write(folder / file, rows)
        return
    for file, rows in found.items():
        expected = read(folder / file)
        assert [len(row) for row in rows] == [len(row) for row in expected], file
        off = [f"row {row[0]}, {column}: {one}, in the reference {other}"
               for row, right in zip(rows, expected)
               for column, one, other in zip(expected[0], row, right)
               if not same(one, other, absolute)]
        assert not off, f"{file} differs:\n" + "\n".join(off)
    names, numbers = read(folder / "work.csv")
    more = excess(work, dict(zip(names, map(int, numbers))), ranks)
    assert not more, "not the usual work:\n" + "\n".join(more)
