// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/solver/solver_parameters.h>

namespace Morula
{
  SolverParameters::SolverParameters()
    : newton_tolerance("Solver/Newton tolerance",
                       1e-6,
                       "Residual at which a step is solved, relative to the "
                       "step's first, and estimated error of its "
                       "displacements, relative to Grid/Spacing; 0 < tolerance "
                       "< 1.")
    , newton_iterations(
        "Solver/Newton iterations",
        400,
        "Iterations after which an attempt at a step is given up; > 0. It is "
        "given up before if 20 iterations have brought neither a lower energy "
        "nor a smaller residual. Steps of folding tissue may need 150.",
        {1})
    , linear_tolerance(
        "Solver/Linear tolerance",
        0.,
        "Residual at which a linear system counts as solved, relative to its "
        "right-hand side, < 1; 0: as accurately as Newton's method can use at "
        "the moment. Without effect on a direct solver.",
        {0.})
    , linear_solver("Solver/Linear solver",
                    "automatic",
                    "Solver of Newton's linear systems. Automatic: iterative, "
                    "and direct where that fails, in 3-D up to 20,000 "
                    "unknowns.",
                    {"automatic|iterative|direct"})
    , kernel("Solver/Kernel",
             "automatic",
             "What adds up the particles' forces and stiffness: code "
             "for the best instruction set of the processor, for one, "
             "or the plain code, several times slower. They agree but "
             "for rounding.",
             {"automatic|plain|baseline|avx2|avx512"})
    , largest_gap("Solver/Largest gap",
                  0.25,
                  "Distance of a fixed or slip point from where it is held "
                  "at which a step counts as failed; 0: any is allowed. "
                  "Units: grid spacings.",
                  {0.})
  {
    newton_tolerance.require([](const double t) { return t > 0. && t < 1.; },
                             "a number > 0 and < 1",
                             "1e-6 is a good choice.");
    linear_tolerance.require([](const double t) { return t < 1.; },
                             "0, or a number between 0 and 1",
                             "0 lets Newton's method choose.");
  }


  KeyList
  SolverParameters::list()
  {
    return {&newton_tolerance,
            &newton_iterations,
            &linear_tolerance,
            &linear_solver,
            &kernel,
            &largest_gap};
  }
} // namespace Morula
