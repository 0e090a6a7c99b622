# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What the run of a scene has left, read on demand."""
from pathlib import Path

import numpy as np
from morula.run import Run, places, states


class PaperRun(Run):
    """The output directory of a scene. Times up to `end` belong to the panel;
    what comes later was added to reach a number of cells."""

    def until(self, end):
        """The rows of the statistics up to this time (days)."""
        return self.statistics[self.statistics["time"] <= end + 1e-6]

    @property
    def founders(self):
        return int(self.statistics["cells"].iloc[0])

    def cells_at(self, time):
        """The number of cells at the step end nearest to a time (days)."""
        nearest = (self.statistics["time"] - time).abs().argmin()
        return int(self.statistics["cells"].iloc[nearest])

    @property
    def last_output(self):
        """The time of the last output, in days."""
        return self.times[-1]

    def output_nearest(self, time):
        """The time of the output nearest to a time (days)."""
        return min(self.times, key=lambda t: abs(t - time))

    def output_with_cells(self, wanted):
        """The time of the output whose number of cells is nearest."""
        return min(self.times,
                   key=lambda t: abs(self.cells_at(t) - wanted))

    def stretch(self, time):
        """θ of isotropic growth near a time, from det F_g = θ³."""
        columns = self.read("cells", time)[1]
        return float(np.mean(columns["growth_volume_ratio"])) ** (1 / 3)

    def read(self, kind, time):
        """Positions (n, 3) and columns, as arrays, of the 'cells' or the
        'surface' in the output nearest to a time (days)."""
        found = states(self.directory, kind)
        table = self._read(kind, min(range(len(found)), key=lambda i:
                                     abs(found[i][0] - time)))
        return places(table), {name: table[name].to_numpy() for name in table}


class Runs(dict):
    """The runs in a directory, by the name of their scene."""

    def __init__(self, directory):
        super().__init__()
        self.directory = Path(directory)

    def __missing__(self, scene):
        self[scene] = PaperRun(self.directory / scene)
        return self[scene]

    def has(self, scene):
        """Whether a run has reached its end: it has a snapshot, and its last
        row is at the end time or at the wanted number of cells."""
        directory = self.directory / scene
        if not all((directory / name).is_file() for name in
                   ("snapshot.h5", "statistics.csv", "parameters.prm")):
            return False
        run = self[scene]
        last = run.statistics.iloc[-1]
        enough = run.number("Time/Stop at cells")
        return bool(last["time"] >= run.number("Time/End time") - 1e-6 or
                    0 < enough <= last["cells"])
