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
import signal
import subprocess

from tests.common.program import SCENES, ProgramTest

ROOT = SCENES.parents[1]
FILES = ["octahedron.off", "scattered-cells.csv"]  # that scenes name

# Small ones, so that accepted mutants end soon.
ORIGINALS = [
    "prm/demo.prm", "prm/hard/properties.prm", "prm/paper/fig-4b.prm",
    "prm/verification/slip-full-2d.prm", "prm/verification/vortex-2d.prm",
    *(f"tests/scenes/{name}.prm" for name in (
        "balance-pressure", "balance-traction", "confined-growth-2d",
        "cylinder", "ellipsoid", "mesh-pressure", "points-free", "proliferating-cube",
        "proliferating-disc", "rigid-motion-2d", "self-weight-h40")),
]

NUMBERS = ["0", "-0", "-1", "1e-300", "-1e300", "1e300", "1e999", "nan", "-nan",
           "inf", "-inf", "infinity", "0x10", "1e", "1,5", "1.5.2", "2147483647",
           "2147483648", "-2147483649", "4294967296", "1e-17", "3 4", "", "+-1",
           "99999999999999999999", "1e10", "0.1 um", "NaN(1)", "1d3"]
EXPRESSIONS = ["X", "t", "1/0", "0/0", "log(-1)", "X/", "((X)", "X)", "sqrt(Y)",
               "X; Y; Z", ";", ";;", "if(X>0,1", "1?2", "1?2:", "rand()", "X=1",
               "0<X<1", "sin", "sin()", "foo(X)", "\"X\"", "X Y", "1e400", "t^t^t^t",
               "-(-(-X", "pi(2)", "X && && Y", "_", "1//2", "!X", "%", "X|Y"]
PIECES = ["\0", "\xff\xfe", "\t", "\r", "\\", "#", "=", "==", "/", "//", ";", ",",
          "'", "\"", "%s%n", "$(x)", "é", "µ", "\u2028", "\U0001f300", "<", "&",
          "set ", "end", "subsection ", "include ", "{", "}", "\x1b[31m", "..",
          "\x7f", "A" * 5000]
LONG = 10 * 1000 * 1000


def numbered(line):
    """A line's key and value, or None."""
    match = re.match(r"(\s*set\s+[^=]+=)(.*)", line)
    return match and (match[1], match[2].strip())


class Mutant:
    """A scene's text after a random damage, and words for the command line."""

    def __init__(self, seed):
        self.rng = rng = random.Random(seed)
        self.original = rng.choice(ORIGINALS)
        text = (ROOT / self.original).read_text()
        text = re.sub(r"(?m)^include (\S+)", self._absolute, text)
        self.lines, self.words, self.done = text.splitlines(), [], []
        for _ in range(rng.choice([1, 1, 1, 2, 3])):
            damage = rng.choice(self.DAMAGES)
            damage(self)
            self.done.append(damage.__name__)

    def _absolute(self, match):
        return f"include {(ROOT / self.original).parent / match[1]}"

    def data(self):
        return "\n".join(self.lines).encode("utf-8", "surrogateescape") + b"\n"

    def any_line(self, wanted=lambda line: line.strip()):
        found = [i for i, line in enumerate(self.lines) if wanted(line)]
        return self.rng.choice(found) if found else None

    def drop_line(self):
        i = self.any_line()
        if i is not None:
            del self.lines[i]

    def repeat_line(self):
        i = self.any_line()
        if i is not None:
            self.lines.insert(self.rng.randrange(len(self.lines) + 1),
                              self.lines[i])

    def swap_lines(self):
        i, j = self.any_line(), self.any_line()
        if i is not None:
            self.lines[i], self.lines[j] = self.lines[j], self.lines[i]

    def garble_line(self):
        i = self.any_line()
        if i is None:
            return
        line = self.lines[i]
        at = self.rng.randrange(len(line) + 1)
        end = min(len(line), at + self.rng.choice([0, 0, 1, 1, 2, 9]))
        self.lines[i] = line[:at] + self.rng.choice(PIECES) + line[end:]

    def cut_file(self):
        text = "\n".join(self.lines)
        self.lines = text[:self.rng.randrange(len(text) + 1)].split("\n")

    def misspell_key(self):
        i = self.any_line(numbered)
        if i is not None:
            key, value = numbered(self.lines[i])
            letters = list(key)
            at = self.rng.randrange(len(letters) - 1)
            letters[at], letters[at + 1] = letters[at + 1], letters[at]
            self.lines[i] = "".join(letters) + " " + value

    def replace_value(self):
        i = self.any_line(numbered)
        if i is not None:
            self.lines[i] = numbered(self.lines[i])[0] + " " + self.bad_value()

    def replace_component(self):
        i = self.any_line(lambda line: numbered(line) and "," in line)
        if i is not None:
            key, value = numbered(self.lines[i])
            parts = value.split(",")
            parts[self.rng.randrange(len(parts))] = self.rng.choice(NUMBERS)
            self.lines[i] = key + " " + ",".join(parts)

    def replace_number(self):
        i = self.any_line(lambda line: numbered(line)
                          and re.search(r"\d", line.split("=", 1)[1]))
        if i is not None:
            key, value = numbered(self.lines[i])
            found = list(re.finditer(r"\d+(\.\d*)?", value))
            if found:
                at = self.rng.choice(found)
                self.lines[i] = (f"{key} {value[:at.start()]}"
                                 f"{self.rng.choice(NUMBERS)}{value[at.end():]}")

    def bad_value(self):
        kind = self.rng.randrange(4)
        if kind == 3:
            return "".join(self.rng.choice(PIECES) for _ in range(3))
        return self.rng.choice(EXPRESSIONS if kind == 2 else NUMBERS)

    def noise(self):
        bits = bytes(self.rng.randrange(256) for _ in range(300))
        self.lines.insert(self.rng.randrange(len(self.lines) + 1),
                          bits.decode("utf-8", "surrogateescape"))

    def override(self):
        i = self.any_line(numbered)
        key = numbered(self.lines[i])[0] if i is not None else "set Dimension ="
        key = re.sub(r"\s*set\s+", "", key)
        section = self.rng.choice(["Tissue/", "Grid/", "Time/", "", "/", "Gird/"])
        word = self.rng.choice([
            section + key + self.bad_value(), key.strip("= "), self.bad_value(),
            "=" + self.bad_value(), "Grid/Spacing=" + self.bad_value(),
            "Tissue/Radius=" + self.bad_value()])
        self.words += ["-s", word.replace("\0", "")]

    DAMAGES = [drop_line, repeat_line, swap_lines, garble_line, garble_line,
               cut_file, misspell_key, replace_value, replace_value,
               replace_value, replace_component, replace_number,
               replace_number, noise, override]


SCENE = "subsection Grid\n  set Spacing = 50\nend\n"
LAW = "subsection Growth\nset Law = isotropic\nsubsection Isotropic\n"

# Names, texts; True if the scene must be refused.
CHOSEN = {
    "empty file": (b"", False),
    "line without end": (b"set Dimension = 3", False),
    "byte order mark": (b"\xef\xbb\xbf" + SCENE.encode(), False),
    "carriage returns": (SCENE.replace("\n", "\r\n").encode(), False),
    "null bytes": (b"\0" * 1000, True),
    "binary": (bytes(range(256)) * 40, True),
    "includes itself": (b"include mutant.prm\n", True),
    "includes a directory": (b"include .\n", True),
    "includes an endless file": (b"include /dev/zero\n", True),
    "many open subsections": (b"subsection Grid\n" * 20000, True),
    "long comment": (b"#" * LONG + b"\n" + SCENE.encode(), False),
    "long word": (b"a" * LONG, True),
    "long key": (b"set " + b"a" * LONG + b" = 1\n", True),
    "long section": (b"subsection " + b"a" * LONG + b"\nend\n", True),
    "long number": (b"subsection Grid\nset Spacing = " + b"9" * LONG
                    + b"\nend\n", True),
    "long choice": (b"subsection Tissue\nset Shape = " + b"a" * LONG
                    + b"\nend\n", True),
    "long list": (b"subsection Grid\nset Offset = " + b"1," * (LONG // 2)
                  + b"1\nend\n", True),
    "long expression": (LAW.encode() + b"set Stretch = 1" + b"+a" * (LONG // 2)
                        + b"\nend\nend\n", True),
    "many components": (b"subsection Body force\nset Force density = 0"
                        + b";0" * (LONG // 2) + b"\nend\n", True),
    "many brackets": (LAW.encode() + b"set Stretch = " + b"(" * 100000 + b"1"
                      + b")" * 100000 + b"\nend\nend\n", None),
    "many signs": (LAW.encode() + b"set Stretch = " + b"-" * 100000
                   + b"1\nend\nend\n", None),
    "continued for ever": (b"set Dimension = \\\n" * 100000, True),
    "endless run": (b"subsection Time\nset End time = inf\nend\n", True),
    "steps beyond counting": (b"subsection Time\nset End time = 1e300\n"
                              b"set Step = 1e-300\nset Smallest step = 1e-300"
                              b"\nend\n", True),
    "infinite penalty": (b"subsection Boundary conditions\n"
                         b"set Nitsche penalty = inf\nend\n", True),
    "boundary points without number": (b"subsection Tissue\nset Boundary "
                                       b"points = 2147483647\nend\n", True),
    "nowhere": (b"subsection Tissue\nset Center = nan, 0, 0\nend\n", True),
    "far away": (b"subsection Tissue\nset Center = 1e300, 0, 0\nend\n", True),
    "grid far away": (b"subsection Grid\nset Offset = 1e300, 0, 0\nend\n",
                      None),
    "grid without end": (b"subsection Grid\nset Spacing = 1e300\nend\n", None),
}


class Fuzz(ProgramTest):
    n, seed = map(int, os.environ.get("MORULA_FUZZ", "20 1").split())

    def setUp(self):
        super().setUp()
        for name in FILES:
            shutil.copy(SCENES / name, self.work)
        shutil.copytree(ROOT / "prm", self.work / "prm")

    def explain(self, data, words=()):
        """(exit code, standard error) of the program for a scene of these
        bytes; fails if it crashes, hangs or writes a file."""
        scene = self.work / "mutant.prm"
        scene.write_bytes(data)
        before = sorted(self.work.rglob("*"))
        process = [self.options.morula, scene.name, "--explain", *words]
        try:
            result = subprocess.run(
                process, cwd=self.work, stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=30,
                preexec_fn=limit_memory, check=False)
        except subprocess.TimeoutExpired:
            self.fail("hangs")
        stderr = result.stderr.decode("utf-8", "replace")
        code = result.returncode
        if code < 0:
            self.fail(f"ended by {signal.Signals(-code).name}: {stderr[-500:]}")
        self.assertIn(code, (0, 1), stderr[-2000:])
        self.assertEqual(sorted(self.work.rglob("*")), before, "files written")
        if code == 1:
            self.assert_says_what_is_wrong(stderr)
        else:
            self.assertIn(b"The scene is valid.", result.stdout)
        return code

    def assert_says_what_is_wrong(self, message):
        """Key or line, and what is allowed, in a readable length."""
        self.assertRegex(message, r"(?s)^morula: .+ = '.*': allowed is .+\.")
        self.assertRegex(
            message, r"mutant\.prm|\.prm:\d|-s: |/|^morula: (Dimension|Output "
            "directory|Random seed|The (scene|command line)|-s) = ")
        self.assertLess(len(message), 3000, message[:500])
        for text in ("exception", "std::", ".cc", "basic_string"):
            self.assertNotIn(text, message)

    def test_chosen(self):
        for name, (data, refused) in CHOSEN.items():
            with self.subTest(name):
                code = self.explain(data)
                if refused is not None:
                    self.assertEqual(code, int(refused))

    def test_random(self):
        codes = []
        for seed in range(self.seed, self.seed + self.n):
            mutant = Mutant(seed)
            with self.subTest(seed=seed, original=mutant.original,
                              damages=mutant.done, words=mutant.words):
                codes.append(self.explain(mutant.data(), mutant.words))
        print(f"seeds {self.seed} to {self.seed + self.n - 1}: "
              f"{codes.count(0)} accepted, {codes.count(1)} refused")


def limit_memory():
    """So that a scene which asks for too much cannot take the machine along."""
    resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))
