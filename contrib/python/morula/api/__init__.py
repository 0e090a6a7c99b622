# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What people use from Python: `Scene`, `Run`, `Function`, `map`."""
from .function import Function, map
from .run import Run
from .scene import Scene

__all__ = ["Function", "Run", "Scene", "map"]
