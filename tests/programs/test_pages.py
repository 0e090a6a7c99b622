# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What pages and code must share: links, keys, columns, numbers of equations, quoted
code, the version. Dated notes are frozen, and read by no test."""
import csv
import re
import subprocess
import textwrap

import pytest
from morula.program import Program

from tests.common.program import TESTS

ROOT = TESTS.parent
PAGES = sorted(page for page in [*ROOT.glob("*.md"), *ROOT.glob("doc/**/*.md"),
                                 *ROOT.glob("contrib/*/*.md"), *ROOT.glob("prm/**/*.md"),
                                 *ROOT.glob("tests/*.md")]
               if page.parent.name != "notes" or page.name == "README.md")
CODE = re.compile(r"^```.*?^```$", re.M | re.S)

# Every effect that writes something, on a tissue of some cells.
SCENE = """
include {cube}
subsection Time
  set End time = 0.125
end
subsection Tissue
  set Refine surface = true
end
subsection Boundary conditions
  set Traction where  = X > 29
  set Traction        = 0.001; 0; 0
  set Pressure where  = Z > 59
  set Pressure        = 0.001
  set Surface tension = 0.001
end
subsection Obstacles
  set Names = floor
  subsection floor
    set Shape  = plane
    set Center = 0, 0, -70
    set Normal = 0, 0, 1
  end
end
subsection Body force
  set Force density = 0; 0; -1e-6
end
subsection Output
  set Formats            = csv, vtu
  set Condition estimate = true
end
"""


def text_of(page):
    return (ROOT / page).read_text(encoding="utf-8")


def headings(page):
    """The names that GitHub gives to a page's headings, and anchors of its own."""
    text = CODE.sub("", page.read_text(encoding="utf-8"))
    found = set(re.findall(r'<a (?:id|name)="([^"]+)"', text))
    for line in re.findall(r"^#+ (.*)$", text, re.M):
        plain = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", line).strip().lower()
        name = re.sub(r"[^\w\- ]", "", plain).replace(" ", "-")
        number = 0
        while (f"{name}-{number}" if number else name) in found:
            number += 1
        found.add(f"{name}-{number}" if number else name)
    return found


@pytest.mark.quick
@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links(page):
    text = re.sub(r"`[^`\n]*`", "", CODE.sub("", page.read_text(encoding="utf-8")))
    lost = []
    for link in re.findall(r"\]\(([^)\s]+)\)", text):
        file, _, name = link.partition("#")
        target = page.parent / file if file else page
        if not re.match(r"[a-z]+:", link) and not (
                target.exists() and (not name or name in headings(target))):
            lost.append(link)
    assert not lost


def test_keys(runs):
    """doc/parameters.md has them as they are; contrib/upkeep/parameters writes it."""
    keys = Program(runs.options.morula).keys
    assert len(keys) > 50 and all(key.meaning for key in keys)
    runs.call([ROOT / "contrib/upkeep/parameters", "--check", "--morula",
               runs.options.morula])


def test_columns(runs):
    """The glossary has every column of every file, and every section of timings."""
    run = runs.run("all", SCENE.format(cube=TESTS / "programs/small-cube.prm"))
    columns, sections = set(), set(run.timings.index)
    for file in run.directory.glob("*.csv"):
        with file.open(newline="") as table:
            columns |= set(csv.DictReader(table).fieldnames)
    for file in run.directory.glob("*.vtu"):
        columns |= {name.decode() for name in
                    re.findall(rb'Name="([^"]+)"', file.read_bytes())}
    rows = re.findall(r"^\| (`.*?) \|", text_of("doc/glossary.md"), re.M)
    known = {word for row in rows for word in re.findall(r"`([^`]+)`", row)}
    vtk = {"connectivity", "offsets", "types", "Points", "TIME", "CYCLE"}
    assert len(columns) > 60 and len(sections) > 15
    assert columns - known - vtk == set()
    assert sections - known - {"total"} == set()


@pytest.mark.quick
def test_equations():
    """Those of doc/theory.md are numbered once; the code names no others, and each."""
    numbers = re.findall(r"\\tag\{([^}]*)\}", text_of("doc/theory.md"))
    assert len(numbers) == len(set(numbers)) > 30
    number = r"\((\d+\.\d+[a-z]?)\)"
    named = set()
    for file in [*ROOT.glob("include/**/*.h"), *ROOT.glob("source/**/*.cc"),
                 *ROOT.glob("contrib/**/*.py"), *ROOT.glob("tests/**/*.cc"),
                 *ROOT.glob("tests/**/*.py")]:
        text = re.sub(r"\s*\n\s*(?:\*|//|#)?\s*", " ", file.read_text(encoding="utf-8"))
        for match in re.findall(rf"theory\.md,? ((?:{number}(?:, | and )?)+)", text):
            named |= set(re.findall(number, match[0]))
    assert named == set(numbers)


@pytest.mark.quick
def test_quotations():
    """Code below <!-- from FILE --> is in that file, but for its indentation; "..."
    stands for lines that are left out."""
    for page in PAGES:
        for name, code in re.findall(r"^<!-- from (\S+) -->\n```\w*\n(.*?)^```$",
                                     page.read_text(encoding="utf-8"), re.M | re.S):
            lines = [line.strip() for line in text_of(name).splitlines()]
            for part in re.split(r"^\s*\.\.\.\s*$", textwrap.dedent(code), flags=re.M):
                quoted = [line.strip() for line in part.strip("\n").splitlines()]
                assert any(lines[i:i + len(quoted)] == quoted
                           for i in range(len(lines))), f"{page}: not in {name}:\n{part}"


@pytest.mark.quick
@pytest.mark.parametrize("file, pattern", [
    ("CITATION.cff", r"^version: (\S+)$"), ("CHANGES.md", r"^## (\S+)$"),
    ("contrib/python/pyproject.toml", r'^version = "(.*)"$'),
    ("contrib/packaging/spack/packages/morula/package.py", r'version\("(.*?)"'),
    ("contrib/packaging/conda/meta.yaml", r'version = "(.*)"'),
    ("doc/install.md", r"morula_([0-9.]+)_amd64\.deb"),
    ("contrib/example-project/CMakeLists.txt", r"find_package\(Morula ([0-9.]+)")])
def test_one_version_everywhere(file, pattern):
    version = re.search(r"^project\(Morula VERSION (\S+)", text_of("CMakeLists.txt"), re.M)[1]
    found = re.search(pattern, text_of(file), re.M)[1]
    assert version == found or "find_package" in pattern and version.startswith(f"{found}.")


def test_the_program_says_its_version(runs):
    version = re.search(r"^version: (\S+)$", text_of("CITATION.cff"), re.M)[1]
    said = subprocess.run([runs.options.morula, "--version"], text=True, check=True,
                          stdout=subprocess.PIPE).stdout
    assert re.match(rf"Morula {re.escape(version)}[ \n(].*with deal\.II [0-9.]+\n$", said)
