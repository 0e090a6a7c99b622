# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Scenes without a closed form, compared with references: three rows of each table,
and the work. `pytest --update` writes them anew; read the difference before you
commit it."""
import pytest

from tests.common.references import compare

pytestmark = pytest.mark.quick

LINEAGE = ("statistics.csv", "lineage.csv")
CELLS = ("statistics.csv", "cells-0001.csv")
SURFACE = ("statistics.csv", "surface-0001.csv")

# A small sphere with the lower half held (Fig. 4c).
CYCLE = "Proliferation/Cell cycle/"
SPHERE = {"Method": "paper", "Random seed": 3, "Time/Step": 0.25, "Tissue/Radius": 45,
          "Tissue/Cell spacing": 12, "Grid/Spacing": 40,
          "Proliferation/Law": "cell cycle", CYCLE + "G0 exit rate": 2,
          "Boundary conditions/Fixed where": "Z <= 0"}
# Cells wait while squeezed (Fig. 4b).
CHECKPOINT = {**SPHERE, "Time/End time": 1.5, CYCLE + "Size checkpoint": 0.95,
              "Solver/Newton tolerance": 1e-12, "Output/Formats": "none"}
# With every option that lowers the error.
OPTIONS = {"Time/End time": 2, "Time/Step": 1, "Tissue/Radius": 60,
           "Tissue/Cell spacing": 12, "Tissue/Surface cells": "trimmed",
           "Tissue/Boundary points": 400, "Grid/Spacing": 40,
           "Grid/Points per cell": 2, "Growth/Law": "isotropic",
           "Growth/Isotropic/Stretch": "1 + 0.1*t",
           "Boundary conditions/Fixed where": "Z <= 0",
           "Boundary conditions/Nitsche form": "unsymmetric",
           "Boundary conditions/Nitsche penalty": 20}

# Name: what is run, its tables, on how many ranks: the same tissue.
SCENES = {
    "proliferating-cube": ({"file": "proliferating-cube.prm"},
                           (*LINEAGE, "cells-0001.csv"), (1, 3)),
    "proliferating-disc": ({"file": "proliferating-disc.prm"},
                           (*LINEAGE, "cells-0001.csv"), (1,)),
    "proliferating-half-fixed-sphere": ({"keys": SPHERE},
                                        (*LINEAGE, "surface-0001.csv"), (1, 2)),
    "proliferating-checkpoint": ({"keys": CHECKPOINT}, LINEAGE, (1,)),
    "cell-types": ({"file": "cell-types.prm"}, (*LINEAGE, "events.csv"), (1, 2)),
    "options-half-fixed-sphere": ({"keys": OPTIONS}, SURFACE, (1,)),
    "cylinder": ({"file": "cylinder.prm"}, (*LINEAGE, "cells-0001.csv"), (1,)),
    "ellipsoid": ({"file": "ellipsoid.prm"}, (*CELLS, "surface-0001.csv"), (1,)),
    "mesh-pressure": ({"file": "mesh-pressure.prm"}, (*CELLS, "surface-0001.csv"),
                      (1,)),
    # The unsymmetric tangent of a following pressure.
    "pressure-iterative": (
        {"file": "mesh-pressure.prm", "keys": {"Solver/Linear solver": "iterative"}},
        (*CELLS, "surface-0001.csv"), (1,)),
    "points-free": ({"file": "points-free.prm"}, (*LINEAGE, "cells-0001.csv"), (1,))}


@pytest.mark.parametrize("name, ranks", [
    pytest.param(name, ranks, marks=[pytest.mark.check] if ranks > 1 else [])
    for name, (_, _, numbers) in SCENES.items() for ranks in numbers])
def test_reference(scene, request, name, ranks):
    run, tables, _ = SCENES[name]
    results = scene(**run, ranks=ranks)
    compare(name, results.directory, tables, ranks,
            update=request.config.option.update and ranks == 1)
