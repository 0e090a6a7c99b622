// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/grid/grid_parameters.h>

#include <deal.II/base/patterns.h>

namespace Morula
{
  void
  GridParameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter("Spacing",
                      spacing,
                      "Edge length h of the grid cells; > 0. Units: um.",
                      Patterns::Double());
    prm.add_parameter("Offset",
                      offset,
                      "Shift of the grid lines: they lie at Offset + i h. "
                      "Units: um.",
                      Patterns::List(Patterns::Double(), 2, 3));
    prm.add_parameter("Occupation parameter",
                      occupation_parameter,
                      "C_C, share of a grid cell that must be filled for its "
                      "splines to be inner ones; 0 < C_C <= 1.",
                      Patterns::Double());
    prm.add_parameter("Extension",
                      extension,
                      "Express outer splines by inner ones. False only to show "
                      "what happens without.");
    prm.add_parameter(
      "Points per cell",
      points_per_cell,
      "Least number of quadrature points of a cell and direction, each with an "
      "equal part of the cell's volume; 1 is the paper's method. 2 lowers the "
      "scatter of stresses beside surfaces to a third, and costs as much "
      "as 2^3 times the cells (2-D: 2^2). From 2 on the points stand in the "
      "cell's deformed box, as many along an edge as that is long: for tissue "
      "that is stretched one way.",
      Patterns::Integer(1, 10));
  }
} // namespace Morula
