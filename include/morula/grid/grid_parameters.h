// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_grid_parameters_h
#define morula_grid_grid_parameters_h

#include <morula/base/key.h>

namespace Morula
{
  /** Section "Grid": the background grid. */
  struct GridParameters : public Keys
  {
    Key<double> spacing{{this, "Grid/Spacing"},
                        50.,
                        "Edge length h of the grid cells; > 0. Units: um.",
                        {},
                        positive("um",
                                 "Choose some cell spacings, e.g. 3 to 5.")};

    Key<std::vector<double>> offset{
      {this, "Grid/Offset"},
      {0., 0., 0.},
      "Shift of the grid lines: they lie at Offset + i h. Units: um.",
      {2, 3}};

    Key<double> occupation_parameter{
      {this, "Grid/Occupation parameter"},
      0.85,
      "C_C, share of a grid cell that must be filled for "
      "its splines to be inner ones; 0 < C_C <= 1.",
      {},
      {[](const double share) { return share > 0. && share <= 1.; },
       "a share > 0 and <= 1",
       "0.85 is a good choice."}};

    Key<bool> extension{
      {this, "Grid/Extension"},
      true,
      "Express outer splines by inner ones. False only to show "
      "what happens without."};

    Key<unsigned int> points_per_cell{
      {this, "Grid/Points per cell"},
      1,
      "Least number of quadrature points of a cell and direction, each with "
      "an equal part of the cell's volume; 1 is the paper's method. 2 lowers "
      "the scatter of stresses beside surfaces to a third, and costs as much "
      "as 2^3 times the cells (2-D: 2^2). From 2 on the points lie in the "
      "cell's deformed box, as many along an edge as that is long: for "
      "tissue that is stretched one way.",
      {1, 10}};
  };
} // namespace Morula

#endif
