// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/solver/solver_parameters.h>

#include <deal.II/base/patterns.h>

namespace Morula
{
  void
  SolverParameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter("Newton tolerance",
                      newton_tolerance,
                      "Residual at which a step is solved, relative to the "
                      "step's first, and estimated error of its "
                      "displacements, relative to Grid/Spacing; 0 < tolerance "
                      "< 1.",
                      Patterns::Double());
    prm.add_parameter("Linear tolerance",
                      linear_tolerance,
                      "Residual at which a linear system counts as solved, "
                      "relative to its right-hand side, < 1; 0: as accurately "
                      "as Newton's method can use at the moment. Without "
                      "effect on a direct solver.",
                      Patterns::Double(0.));
    prm.add_parameter(
      "Linear solver",
      linear_solver,
      "Solver of Newton's linear systems. Automatic: iterative, "
      "direct where that fails.",
      Patterns::Selection("automatic|iterative|direct"));
    prm.add_parameter("Kernel",
                      kernel,
                      "What adds up the particles' forces and stiffness: code "
                      "for the best instruction set of the processor, for one, "
                      "or the plain code, several times slower. They agree but "
                      "for rounding.",
                      Patterns::Selection(
                        "automatic|plain|baseline|avx2|avx512"));
    prm.add_parameter("Largest gap",
                      largest_gap,
                      "Distance of a fixed or slip point from where it is held "
                      "at which a step counts as failed; 0: any is allowed. "
                      "Units: grid spacings.",
                      Patterns::Double(0.));
  }
} // namespace Morula
