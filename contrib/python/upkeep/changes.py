# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Moves the entries of doc/changes into CHANGES.md, below the version of the
tree: done before a release. The files of the entries go.

    contrib/upkeep/changes
"""
import argparse
import os
import re
from pathlib import Path

from .version_data import ROOT, version

FOLDER = "doc/changes"
PAGE = "CHANGES.md"
HEAD = f"""# Changes

What users and developers notice, by version; newer changes are files of their own in
[{FOLDER}]({FOLDER}).
"""


def entry(text):
    """An entry as a part of CHANGES.md: its heading, of whatever level, below
    that of the version, its links from the root."""
    def from_root(match):
        file, mark, place = match[1].partition("#")
        if re.match(r"[a-z]+:", file) or not file:
            return match[0]
        return f"]({os.path.normpath(os.path.join(FOLDER, file))}{mark}{place})"
    text = text.strip()
    level = len(text) - len(text.lstrip("#"))
    text = re.sub(rf"^#{{{level}}}(?=#* )", "###", text, flags=re.M)
    return re.sub(r"\]\(([^)\s]+)\)", from_root, text)


def merged(page, number, entries):
    """The page with these entries at the end of the section of the version,
    which is the first one."""
    page = page or HEAD
    heading = f"\n## {number}\n"
    if heading not in page:
        head, mark, older = page.partition("\n## ")
        page = f"{head.rstrip()}\n{heading}{mark}{older}"
    before, _, rest = page.partition(heading)
    section, mark, older = rest.partition("\n## ")
    parts = [section.strip(), *map(entry, entries)]
    text = "\n\n".join(part for part in parts if part)
    return f"{before}{heading}\n{text}\n{mark}{older}"


def move(root):
    """Moves all entries of a tree; returns their files."""
    files = [file for file in sorted((root / FOLDER).glob("*.md"))
             if file.name != "README.md"]
    if files:
        page = root / PAGE
        page.write_text(merged(
            page.read_text(encoding="utf-8") if page.exists() else "",
            version(root), [file.read_text(encoding="utf-8") for file in files]),
            encoding="utf-8")
        for file in files:
            file.unlink()
    return files


def main():
    argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    ).parse_args()
    print(f"{PAGE}: {len(move(Path(ROOT)))} entries of {FOLDER} moved there.")
