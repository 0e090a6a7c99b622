// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_solver_parameters_h
#define morula_solver_solver_parameters_h

#include <deal.II/base/parameter_handler.h>

#include <string>

namespace Morula
{
  using namespace dealii;

  /** Section "Solver". */
  struct SolverParameters
  {
    double      newton_tolerance = 1e-6;
    double      linear_tolerance = 0.;
    std::string linear_solver    = "automatic";
    std::string kernel           = "automatic";
    double      largest_gap      = 0.25; // grid spacings; 0: any

    void
    declare(ParameterHandler &prm);
  };
} // namespace Morula

#endif
