# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A ball that relaxes under a pressure above its Young's modulus stays as it is:
volume and J_e are those of the closed form, in every grid cell and for many
relaxation times, though nothing but its cells' volumes resists for long."""
import math

from tests.common.program import ProgramTest, overrides, read_csv
from scipy.optimize import brentq

from tests.verification.material import lame

E, NU, PRESSURE = 10.0, 0.4, 16.0  # kPa
SCENE = f"""
subsection Time
  set End time = 1
  set Step     = 0.025
end
subsection Tissue
  set Shape         = sphere
  set Radius        = 100
  set Cell spacing  = 12
  set Surface cells = trimmed
end
subsection Grid
  set Spacing = 45
end
subsection Material
  set Young's modulus = {E}
  set Poisson's ratio = {NU}
  set Energy per      = grown volume
  set Relaxation time = 0.125
end
subsection Boundary conditions
  set Pressure where = 1
  set Pressure       = {PRESSURE}*min(1, t/0.1)
end
subsection Output
  set Formats  = csv
  set Interval = 0
end
"""


def volume_ratio():
    """J_e, by mu (J^(2/3) - 1) + lambda ln J = -p J."""
    LAMBDA, MU = lame(E, NU)
    return brentq(lambda J: (MU * (J**(2 / 3) - 1) + LAMBDA * math.log(J)
                             + PRESSURE * J), 0.1, 1)


class PressedTissue(ProgramTest):
    def test_stays_as_it_is(self):
        scene = self.write("ball.prm", SCENE)
        expected = volume_ratio()
        for form in ("projected", "pooled"):
            output = self.work / form
            self.execute(scene, *overrides({
                "Material/Volumetric strain": form}), output=output)
            rows = read_csv(output / "statistics.csv")
            volume = rows["total_volume"][-1] / rows["total_volume"][0]
            ratios = read_csv(sorted(output.glob("cells-*.csv"))[-1])[
                "elastic_volume_ratio"]
            print(f"{form}: J_e {expected:.4f}, of all {volume:.4f},",
                  f"of cells {ratios.min():.4f} to {ratios.max():.4f}")
            self.assertLess(abs(volume / expected - 1), 1e-3)
            self.assertGreater(ratios.min(), 0.95 * expected)
            self.assertLess(ratios.max(), 1.05 * expected)

