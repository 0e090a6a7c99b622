// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/output_parameters.h>

#include <deal.II/base/patterns.h>

namespace Morula
{
  void
  OutputParameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter("Interval",
                      interval,
                      "Time between two outputs of cells and surface; "
                      "0: first and last only. Units: day.",
                      Patterns::Double(0.));
    prm.add_parameter("Formats",
                      formats,
                      "Files of cells and surface, one or more separated by "
                      "commas. None still writes statistics, timings and "
                      "lineage.",
                      Patterns::List(Patterns::Selection("vtu|csv|none"), 1));
    prm.add_parameter("Snapshot interval",
                      snapshot_interval,
                      "Time between two snapshots for --resume; 0: at the "
                      "end only. Units: day.",
                      Patterns::Double(0.));
    prm.add_parameter(
      "Condition estimate",
      condition_estimate,
      "Whether condition.csv is to hold the extreme eigenvalues "
      "of each step's first tangent, scaled to a unit "
      "diagonal. Takes longer than the step itself.");
  }
} // namespace Morula
