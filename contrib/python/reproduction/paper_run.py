# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The run of a scene of the paper. A state is named by its place in `times`."""
from pathlib import Path

import numpy as np
from morula.run import ESSENTIAL, Run

PICTURE_RATIO = 1.5**3  # cells over founders when the paper shows Fig. 4 (a-c)


class PaperRun(Run):
    """The output directory of a scene."""

    @property
    def founders(self):
        """The number of cells at the start."""
        return int(self.statistics["cells"].iloc[0])

    def nearest(self, time):
        """The state nearest to a time (days)."""
        return int(np.abs(self.times - time).argmin())

    def count(self, state):
        """The number of cells in a state."""
        times = self.statistics["time"]
        return int(self.statistics["cells"].iloc[(times - self.times[state]).abs().argmin()])

    @property
    def picture_state(self):
        """The state that the paper shows of a proliferating tissue."""
        wanted = PICTURE_RATIO * self.founders
        return min(range(len(self.times)), key=lambda state: abs(self.count(state) - wanted))

    def stretch(self, state):
        """θ of isotropic growth, from det F_g = θ³."""
        return float(self.cells(state)["growth_volume_ratio"].mean())**(1 / 3)

    @property
    def threshold(self):
        """J_th of the size checkpoint; 0: none."""
        return self.number("Proliferation/Cell cycle/Size checkpoint")

    @property
    def has_ended(self):
        """Whether the run is at its end time or at the wanted number of cells."""
        last = self.statistics.iloc[-1]
        enough = self.number("Time/Stop at cells")
        return bool(last["time"] >= self.number("Time/End time") - 1e-6
                    or 0 < enough <= last["cells"])


class Runs(dict):
    """The runs in a directory, by the name of their scene."""

    def __init__(self, directory):
        super().__init__()
        self.directory = Path(directory)

    def __missing__(self, scene):
        self[scene] = PaperRun(self.directory / scene)
        return self[scene]

    def lacking(self, scenes):
        """Those of the scenes that have not been run to their end."""
        def is_there(scene):
            return all((self.directory / scene / file).is_file()
                       for file in ("snapshot.h5", *ESSENTIAL))

        return [scene for scene in scenes if not is_there(scene) or not self[scene].has_ended]
