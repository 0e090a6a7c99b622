# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Where the package stands: in Morula's tree, in contrib/python; below an
installation's prefix, in share/morula/python; or in a Python of somebody's."""
import os
import shutil
from pathlib import Path

_PYTHON = Path(__file__).resolve().parents[1]
ROOT = _PYTHON.parent.parent  # of the tree
INSTALLED = not (ROOT / "CMakeLists.txt").is_file()


def _program():
    beside = ROOT.parent / "bin/morula" if INSTALLED else ROOT / "build/morula"
    if INSTALLED and not beside.is_file():
        beside = shutil.which("morula") or "morula"
    # the program that started this tool says where it is
    return Path(os.environ.get("MORULA") or beside)


MORULA = _program()
OUTPUT = Path("output")  # in the working directory
