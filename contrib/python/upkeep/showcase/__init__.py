# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Scenes of prm/showcase beside what others have measured or computed: contrib/upkeep/
showcase. Each module has the scene, its cases, and what is read from their runs."""
from typing import NamedTuple

from upkeep import ROOT

SCENES = ROOT / "prm/showcase"


class Case(NamedTuple):
    """A run: the keys besides those of the file, and the values that tell it from others."""

    name: str
    keys: dict
    values: tuple
