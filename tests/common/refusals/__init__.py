# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Kinds of bad input, and what the program must say about each: the key with its
full path (or the option, or the file), the value, the limit, and what to do."""
from tests.common.refusals.cell_types import CELL_TYPES
from tests.common.refusals.contradictions import CONTRADICTIONS
from tests.common.refusals.expressions import (EXPRESSIONS, GROWTH_BY_RATES,
                                               IN_2D)
from tests.common.refusals.fields import FIELDS
from tests.common.refusals.files import FILES
from tests.common.refusals.lumen import LUMENS
from tests.common.refusals.neighbours import NEIGHBOURS
from tests.common.refusals.obstacles import OBSTACLES
from tests.common.refusals.outliers import OUTLIERS
from tests.common.refusals.scenes import SCENES
from tests.common.refusals.values import CHOICES, NUMBERS

KEYS = NUMBERS + CHOICES + EXPRESSIONS + IN_2D + GROWTH_BY_RATES + \
    CONTRADICTIONS + CELL_TYPES + FIELDS + FILES + OUTLIERS + LUMENS + \
    OBSTACLES + NEIGHBOURS
