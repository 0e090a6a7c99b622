# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Where the tools stand: in Morula's tree, or below an installation's prefix."""
from pathlib import Path

# The tree, or PREFIX/share/morula, which nobody but root can write to.
ROOT = Path(__file__).resolve().parents[3]
INSTALLED = not (ROOT / "CMakeLists.txt").is_file()
MORULA = ROOT.parents[1] / "bin/morula" if INSTALLED else ROOT / "build/morula"
OUTPUT = Path("output") if INSTALLED else ROOT / "output"
