# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Tools of contrib/upkeep, for those who work on Morula: they write pages. Only
Morula's tree has this package; an installation has `morula` alone."""
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]


def version(root=ROOT):
    """The version of a tree: that of its project()."""
    text = (root / "CMakeLists.txt").read_text(encoding="utf-8")
    return re.search(r"^project\(Morula VERSION (\S+)", text, re.M)[1]
