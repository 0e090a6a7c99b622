# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What a run says of its own error in time: doc/theory.md (5.10)."""
import numpy as np


def error_in_time(statistics):
    """The estimate at the end: relative, as a volume or a strain. None if nothing in the run
    follows the state."""
    names = (statistics.dtype.names if isinstance(statistics, np.ndarray) else statistics.columns)
    if "step_error" not in names:
        return None
    return float(np.atleast_1d(np.asarray(statistics["step_error"], dtype=float))[-1])
