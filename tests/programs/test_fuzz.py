# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Damaged scenes: whatever a scene file or -s says, the program accepts it or
ends with exit code 1 and a message; it never crashes, hangs or writes anything.

    MORULA_FUZZ="2000 7" /usr/bin/python3 -m pytest tests/programs/test_fuzz.py

tries 2000 random damages from seed 7 on, and the chosen ones. Each seed makes
one mutant: "1 123" repeats number 123.
"""
import os
import random
import re
import resource
import shutil
import subprocess

import pytest
from tests.common.program import SCENES

ROOT = SCENES.parents[1]
FILES = ["octahedron.off", "scattered-cells.csv"]  # that scenes name

# Small ones, so that accepted mutants end soon.
ORIGINALS = [
    "prm/demo.prm", "prm/hard/properties.prm", "prm/paper/fig-4b.prm",
    "prm/verification/slip-full-2d.prm", "prm/verification/vortex-2d.prm",
    *(f"tests/scenes/{name}.prm" for name in (
        "balance-pressure", "balance-traction", "confined-growth-2d", "cylinder", "ellipsoid",
        "mesh-pressure", "points-free",
        "proliferating-cube", "proliferating-disc", "rigid-motion-2d", "self-weight-h40"))]

NUMBERS = ["0", "-0", "-1", "1e-300", "-1e300", "1e300", "1e999", "nan", "-nan", "inf", "-inf",
           "infinity", "0x10", "1e", "1,5", "1.5.2", "2147483647", "2147483648", "-2147483649",
           "4294967296", "1e-17", "3 4", "", "+-1", "99999999999999999999", "1e10", "0.1 um",
           "NaN(1)", "1d3"]
EXPRESSIONS = ["X", "t", "1/0", "0/0", "log(-1)", "X/", "((X)", "X)", "sqrt(Y)", "X; Y; Z", ";",
               ";;", "if(X>0,1", "1?2", "1?2:", "rand()", "X=1", "0<X<1", "sin", "sin()", "foo(X)",
               "\"X\"", "X Y", "1e400", "t^t^t^t", "-(-(-X", "pi(2)", "X && && Y", "_", "1//2",
               "!X", "%", "X|Y"]
PIECES = ["\0", "\xff\xfe", "\t", "\r", "\\", "#", "=", "==", "/", "//", ";", ",", "'", "\"",
          "%s%n", "$(x)", "é", "µ", "\u2028", "\U0001f300", "<", "&", "set ", "end", "subsection ",
          "include ", "{", "}", "\x1b[31m", "..", "\x7f", "A" * 5000]
LONG = 10 * 1000 * 1000


KEY = re.compile(r"(\s*set\s+)([^=]+)=(.*)")


class Mutant:
    """A scene's text after a random damage, and words for the command line."""

    def __init__(self, seed):
        self.rng = rng = random.Random(seed)
        self.original = ROOT / rng.choice(ORIGINALS)
        text = re.sub(r"(?m)^include (\S+)", rf"include {self.original.parent}/\1",
                      self.original.read_text())
        self.lines, self.words, self.done = text.splitlines(), [], []
        for _ in range(rng.choice([1, 1, 1, 2, 3])):
            damage = rng.choice(self.DAMAGES)
            # a line, and one with a key, its beginning and its value
            self.at = rng.randrange(len(self.lines))
            keys = [i for i, line in enumerate(self.lines) if KEY.match(line)]
            self.key_at = rng.choice(keys) if keys else None
            if keys or damage not in self.DAMAGES_OF_KEYS:
                damage(self)
                self.done.append(damage.__name__)

    def data(self):
        return "\n".join(self.lines).encode("utf-8", "surrogateescape") + b"\n"

    def insert(self, line):
        self.lines.insert(self.rng.randrange(len(self.lines) + 1), line)

    def drop_line(self):
        self.lines[self.at:self.at + 1] = [""]

    def repeat_line(self):
        self.insert(self.lines[self.at])

    def swap_lines(self):
        other = self.rng.randrange(len(self.lines))
        self.lines[self.at], self.lines[other] = self.lines[other], self.lines[self.at]

    def garble_line(self):
        line = self.lines[self.at]
        begin = self.rng.randrange(len(line) + 1)
        end = begin + self.rng.choice([0, 0, 1, 1, 2, 9])
        self.lines[self.at] = line[:begin] + self.rng.choice(PIECES) + line[end:]

    def cut_file(self):
        text = "\n".join(self.lines)
        self.lines = text[:self.rng.randrange(len(text) + 1)].split("\n")

    def noise(self):
        self.insert(self.rng.randbytes(300).decode("utf-8", "surrogateescape"))

    def misspell_key(self):
        before, key, value = KEY.match(self.lines[self.key_at]).groups()
        at = self.rng.randrange(len(key) - 1)
        key = key[:at] + key[at + 1] + key[at] + key[at + 2:]
        self.lines[self.key_at] = f"{before}{key}={value}"

    def replace_value(self):
        before, key, _ = KEY.match(self.lines[self.key_at]).groups()
        self.lines[self.key_at] = f"{before}{key}= {self.bad_value()}"

    def replace_number(self):
        before, key, value = KEY.match(self.lines[self.key_at]).groups()
        found = list(re.finditer(r"\d+(\.\d*)?", value)) or [re.search("$", value)]
        at = self.rng.choice(found)
        value = value[:at.start()] + self.rng.choice(NUMBERS) + value[at.end():]
        self.lines[self.key_at] = f"{before}{key}={value}"

    def override(self):
        key = KEY.match(self.lines[self.key_at])[2].strip()
        section = self.rng.choice(["Tissue/", "Grid/", "Time/", "", "/", "Gird/"])
        value = self.bad_value()
        word = self.rng.choice([f"{section}{key}={value}", key, value, f"={value}",
                                f"Grid/Spacing={value}", f"Tissue/Radius={value}"])
        self.words += ["-s", word.replace("\0", "")]

    def bad_value(self):
        kind = self.rng.randrange(4)
        if kind == 3:
            return "".join(self.rng.choice(PIECES) for _ in range(3))
        return self.rng.choice(EXPRESSIONS if kind == 2 else NUMBERS)

    DAMAGES_OF_KEYS = [misspell_key, *[replace_value] * 3, *[replace_number] * 3, override]
    DAMAGES = [drop_line, repeat_line, swap_lines, garble_line, garble_line, cut_file, noise,
               *DAMAGES_OF_KEYS]


STRETCH = b"set Growth/Law = isotropic\nset Growth/Isotropic/Stretch = "
# Names, texts; True if the scene must be refused.
CHOSEN = {
    "empty file": (b"", False),
    "line without end": (b"set Dimension = 3", False),
    "byte order mark": (b"\xef\xbb\xbfset Grid/Spacing = 50\n", False),
    "carriage returns": (b"subsection Grid\r\n  set Spacing = 50\r\nend\r\n", False),
    "null bytes": (b"\0" * 1000, True),
    "binary": (bytes(range(256)) * 40, True),
    "includes itself": (b"include mutant.prm\n", True),
    "includes a directory": (b"include .\n", True),
    "includes an endless file": (b"include /dev/zero\n", True),
    "many open subsections": (b"subsection Grid\n" * 20000, True),
    "long comment": (b"#" * LONG + b"\nset Grid/Spacing = 50\n", False),
    "long word": (b"a" * LONG, True),
    "long key": (b"set " + b"a" * LONG + b" = 1\n", True),
    "long section": (b"subsection " + b"a" * LONG + b"\nend\n", True),
    "long number": (b"set Grid/Spacing = " + b"9" * LONG, True),
    "long choice": (b"set Tissue/Shape = " + b"a" * LONG, True),
    "long list": (b"set Grid/Offset = " + b"1," * (LONG // 2) + b"1", True),
    "long expression": (STRETCH + b"1" + b"+a" * (LONG // 2), True),
    "many components": (b"set Body force/Force density = 0" + b";0" * (LONG // 2), True),
    "many brackets": (STRETCH + b"(" * 100000 + b"1" + b")" * 100000, None),
    "many signs": (STRETCH + b"-" * 100000 + b"1", None),
    "continued for ever": (b"set Dimension = \\\n" * 100000, True),
    "endless run": (b"set Time/End time = inf", True),
    "steps beyond counting": (b"set Time/End time = 1e300\nset Time/Step = 1e-300\n"
                              b"set Time/Smallest step = 1e-300\n", True),
    "infinite penalty": (b"set Boundary conditions/Nitsche penalty = inf", True),
    "boundary points without number": (b"set Tissue/Boundary points = 2147483647", True),
    "nowhere": (b"set Tissue/Center = nan, 0, 0", True),
    "far away": (b"set Tissue/Center = 1e300, 0, 0", True),
    "grid far away": (b"set Grid/Offset = 1e300, 0, 0", None),
    "grid without end": (b"set Grid/Spacing = 1e300", None)}
# What the same code reads as others of these.
ALIKE = ("long word", "long key", "long section", "long choice", "long number",
         "many components", "steps beyond counting", "far away")
N, SEED = map(int, os.environ.get("MORULA_FUZZ", "6 1").split())


def limit_memory():
    """So that a scene which asks for too much cannot take the machine along."""
    resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))


@pytest.fixture(scope="module")
def work(runs):
    """A directory with the files that scenes name."""
    for name in FILES:
        shutil.copy(SCENES / name, runs.work)
    shutil.copytree(ROOT / "prm", runs.work / "prm")
    return runs.work


def explain(runs, work, data, words=()):
    """The exit code of the program for a scene of these bytes; fails if it crashes,
    hangs or writes a file."""
    scene = work / "mutant.prm"
    scene.write_bytes(data)
    before = sorted(work.rglob("*"))
    result = subprocess.run(
        [runs.options.morula, scene.name, "--explain", *words], cwd=work,
        stdin=subprocess.DEVNULL, capture_output=True, timeout=30, preexec_fn=limit_memory,
        check=False)
    stderr = result.stderr.decode("utf-8", "replace")
    assert result.returncode in (0, 1), stderr[-2000:]
    assert sorted(work.rglob("*")) == before, "files written"
    if result.returncode == 1:
        check_message(stderr)
    else:
        assert b"The scene is valid." in result.stdout
    return result.returncode


def check_message(message):
    """Key or line, and what is allowed, in a readable length."""
    assert re.search(r"(?s)^morula: .*( = '.*': allowed is |unknown |' is not closed).+\.", message)
    assert re.search(r"mutant\.prm|\.prm:\d|-s: |/|^morula: (Dimension|Output directory|Random seed"
                     r"|The (scene|command line)|-s) = ", message)
    assert len(message) < 3000, message[:500]
    for text in ("exception", "std::", ".cc", "basic_string"):
        assert text not in message


@pytest.mark.parametrize("name", [
    pytest.param(name, marks=pytest.mark.release) if name in ALIKE else name for name in CHOSEN])
def test_chosen(runs, work, name):
    data, refused = CHOSEN[name]
    assert explain(runs, work, data) in ((0, 1) if refused is None else (int(refused),))


@pytest.mark.parametrize("seed", range(SEED, SEED + N))
def test_random(runs, work, seed):
    mutant = Mutant(seed)
    print(f"{mutant.original}: {mutant.done}, {mutant.words}")
    explain(runs, work, mutant.data(), mutant.words)
