// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_grid_parameters_h
#define morula_grid_grid_parameters_h

#include <deal.II/base/parameter_handler.h>

#include <vector>

namespace Morula
{
  using namespace dealii;

  /** Section "Grid": the background grid. */
  struct GridParameters
  {
    double              spacing              = 50.;
    std::vector<double> offset               = {0., 0., 0.};
    double              occupation_parameter = 0.85;
    bool                extension            = true;
    unsigned int        points_per_cell      = 1;

    void
    declare(ParameterHandler &prm);
  };
} // namespace Morula

#endif
