# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Headers as Doxygen reads them: "doc/theory.md (4.2)" in comments is a link to
the page and the equation. Left alone, Doxygen links to an empty page about the
file. Lines stay where they are."""
import re

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
