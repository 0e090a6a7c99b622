# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The columns that Morula writes, and their units (2-D: per um of thickness,
so that a volume is an area)."""
from .cell_types import names_in

LENGTH, VOLUME, STRESS, NUMBER = "um", "um^dim", "kPa", ""

# Results in statistics.csv.
STATISTICS = {"cells": NUMBER, "total_volume": VOLUME, "grown_volume": VOLUME,
              "mean_energy_density": STRESS, "cell_mean_energy_density": STRESS,
              "max_energy_density": STRESS, "min_elastic_volume_ratio": NUMBER,
              "max_elastic_volume_ratio": NUMBER, "dividing": NUMBER, "held_at_checkpoint": NUMBER,
              "xmin": LENGTH, "xmax": LENGTH, "ymin": LENGTH, "ymax": LENGTH, "zmin": LENGTH,
              "zmax": LENGTH, "surface_distance": LENGTH, "enclosed_volume": VOLUME,
              "close_neighbours": NUMBER}

# Those of Shape/Numbers.
SHAPE = {"roundness": NUMBER, "gyration_radius": LENGTH, "gyration_axis_1": LENGTH,
         "gyration_axis_2": LENGTH, "gyration_axis_3": LENGTH, "radius_spread": NUMBER,
         "lobes": NUMBER, "lobe_power": NUMBER, "free_area": "um^(dim-1)",
         "unlike_contacts": NUMBER}


def statistics_of(keys):
    """The same of a scene with these keys, of which cells may have types and fields."""
    return {**STATISTICS, **(SHAPE if keys.get("Shape/Numbers") == "true" else {}),
            **{f"lumen_{what}_{name}": unit for name in names_in(keys, "Lumens")
               for what, unit in (("volume", VOLUME), ("pressure", STRESS))},
            **{f"cells_{name}": NUMBER for name in names_in(keys)},
            **{f"{name}_{value}": NUMBER for name in names_in(keys, "Fields")
               for value in ("min", "mean", "max", "clipped")}}


# The other columns of statistics.csv: what a step was and what it took. Their
# "error" would mean nothing.
EFFORT = ("step", "time", "dt", "active_grid_cells", "inner_splines", "outer_splines", "unknowns",
          "newton_iterations", "linear_iterations", "rejected_steps", "residual", "wall_seconds",
          "min_cells_per_spacing", "turns", "proximal_paths", "step_error")

_POINTS = {"x": LENGTH, "y": LENGTH, "z": LENGTH, "X": LENGTH, "Y": LENGTH,
           "Z": LENGTH, "radius": LENGTH}

# Columns of cells-NNNN.csv and surface-NNNN.csv that are results; 'radius' is
# computed from the others: the distance from Tissue/Center.
POINTS = {"cells": {**_POINTS, "generation": NUMBER, "phase": NUMBER, "type": NUMBER,
                    "initial_volume": VOLUME, "volume": VOLUME, "growth_volume_ratio": NUMBER,
                    "elastic_volume_ratio": NUMBER, "energy_density": STRESS, "sigma_xx": STRESS,
                    "sigma_yy": STRESS, "sigma_zz": STRESS, "sigma_xy": STRESS, "sigma_yz": STRESS,
                    "sigma_zx": STRESS}, "surface": {**_POINTS, "nx": NUMBER, "ny": NUMBER,
                                                     "nz": NUMBER, "area": "um^(dim-1)"}}

# What a VTU file has as one tensor or vector, and CSV files and data frames
# as columns; other vectors become NAME_x, NAME_y, NAME_z.
COMPONENTS = {"sigma": ("sigma_xx", "sigma_yy", "sigma_zz", "sigma_xy", "sigma_yz", "sigma_zx"),
              "normal": ("nx", "ny", "nz")}

# Columns of statistics.csv that are those of the boundary points.
OF_SURFACE = ("xmin", "xmax", "ymin", "ymax", "zmin", "zmax")

# Columns that are zero throughout in two dimensions.
FLAT = ("z", "Z", "zmin", "zmax", "nz", "gyration_axis_3", "sigma_yz", "sigma_zx")


def unit_in(unit, dimension):
    """The unit as written for a scene of 2 or 3 dimensions."""
    return {VOLUME: f"um^{dimension}",
            "um^(dim-1)": "um^2" if dimension == 3 else "um"}.get(unit, unit)


def pretty(unit):
    """A unit as pictures and tables show it."""
    return unit.replace("um", "µm").replace("^2", "²").replace("^3", "³")


def unit_of(name, dimension):
    """The unit of any column of the cells; those that only VTU files have, too.
    Empty for numbers, and for fields, which have that of the scene's."""
    unit = POINTS["cells"].get(name)
    if unit is None:
        unit = (STRESS if name == "pressure" or name.startswith("principal_stress")
                else LENGTH if name.startswith("displacement_")
                else VOLUME if name == "region_volume" else NUMBER)
    return unit_in(unit, dimension)
