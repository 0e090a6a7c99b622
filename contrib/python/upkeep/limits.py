# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Sentences of pages that state limits: the cases that assert them write them.

In a page they stand between <!-- limits NAME --> and <!-- end -->, NAME being
the case; `contrib/upkeep/renew --limits` writes them there without running anything,
and tests/programs/measured.py compares.
"""
import importlib
import re
from pathlib import Path

# Page -> package whose modules define a CASE with sentences().
CASES = {"doc/hard-cases.md": "tests/hard/cases",
         "doc/verification.md": "tests/verification/cases"}

PLACE = re.compile(r"(<!-- limits (\S+) -->\n).*?(?=<!-- end -->)", re.S)


def sentences(folder, root):
    """Case -> what it asserts, of all cases in a folder."""
    return {file.stem: importlib.import_module(
                f"{folder.replace('/', '.')}.{file.stem}").CASE.sentences()
            for file in sorted((root / folder).glob("*.py"))}


def page_with(text, stated):
    """A page with these sentences in their places."""
    places = [name for _, name in PLACE.findall(text)]
    wanted = [name for name, lines in stated.items() if lines]
    if sorted(places) != sorted(wanted):
        raise LookupError(f"the page has places for {sorted(places)}, but the "
                          f"cases that state limits are {wanted}")
    return PLACE.sub(lambda match: match[1] + "".join(
        f"- {line}\n" for line in stated[match[2]]), text)


def pages(root):
    """Page -> (its text, its text as it should be)."""
    for page, folder in CASES.items():
        text = (root / page).read_text(encoding="utf-8")
        yield page, text, page_with(text, sentences(folder, root))


def write_all(root):
    """Writes the sentences of all cases; returns the pages."""
    found = []
    for page, _, text in pages(Path(root)):
        (Path(root) / page).write_text(text, encoding="utf-8")
        found.append(page)
    return found
