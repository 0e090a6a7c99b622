#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Doxygen's filter of headers: makes "doc/theory.md (4.2)" in comments links to
the page and the equation. Left alone, Doxygen links to an empty page about the
file. Lines stay where they are."""
import re
import sys
from pathlib import Path

from upkeep.manual.markdown import equation, is_page, page_name

NUMBER = r"\((\d+\.\d+[a-z]?)\)"
BREAK = r"(?:\s*\n\s*\*?\s*| )"
CITED = re.compile(rf"(doc/[a-z-]+\.md)((?:(?:,|{BREAK}and)?{BREAK}{NUMBER})*)")


def linked(match):
    page = match[1]
    if not is_page(page):
        return match[0]
    name = page_name(page)
    numbers = re.sub(NUMBER, lambda m: rf'\ref {equation(name, m[1])} '
                     f'"({m[1]})"', match[2])
    return rf'\ref {name} "{page}"{numbers}'


def comments_linked(text):
    return re.sub(r"/\*\*.*?\*/", lambda m: CITED.sub(linked, m[0]), text,
                  flags=re.S)


if __name__ == "__main__":
    sys.stdout.reconfigure(encoding="utf-8")
    print(comments_linked(Path(sys.argv[1]).read_text(encoding="utf-8")),
          end="")
