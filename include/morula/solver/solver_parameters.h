// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_solver_parameters_h
#define morula_solver_solver_parameters_h

#include <morula/base/key.h>

namespace Morula
{
  /** Section "Solver". */
  struct SolverParameters : public Keys
  {
    Key<double> newton_tolerance{
      {this, "Solver/Newton tolerance"},
      1e-6,
      "Residual at which a step is solved, relative to the "
      "step's first, and estimated error of its "
      "displacements, relative to Grid/Spacing; 0 < tolerance "
      "< 1.",
      {},
      {[](const double t) { return t > 0. && t < 1.; },
       "a number > 0 and < 1",
       "1e-6 is a good choice."}};

    Key<unsigned int> newton_iterations{
      {this, "Solver/Newton iterations"},
      400,
      "Iterations after which an attempt at a step is given up; > 0. It is "
      "given up before if 20 iterations have brought neither a lower energy "
      "nor a smaller residual. Steps of folding tissue may need 150.",
      {1}};

    Key<double> linear_tolerance{
      {this, "Solver/Linear tolerance"},
      0.,
      "Residual at which a linear system counts as solved, relative to its "
      "right-hand side, < 1; 0: as accurately as Newton's method can use at "
      "the moment. Without effect on a direct solver.",
      {0.},
      {[](const double t) { return t < 1.; },
       "0, or a number between 0 and 1",
       "0 lets Newton's method choose."}};

    Key<std::string> linear_solver{
      {this, "Solver/Linear solver"},
      "automatic",
      "Solver of Newton's linear systems. Automatic: iterative, "
      "and direct where that fails, in 3-D up to 20,000 "
      "unknowns.",
      {"automatic|iterative|direct"}};

    Key<std::string> kernel{
      {this, "Solver/Kernel"},
      "automatic",
      "What adds up the particles' forces and stiffness: code "
      "for the best instruction set of the processor, for one, "
      "or the plain code, several times slower. They agree but "
      "for rounding.",
      {"automatic|plain|baseline|avx2|avx512"}};

    Key<double> largest_gap{
      {this, "Solver/Largest gap"},
      0.25,
      "Largest distance of a fixed or slip point from its prescribed place; "
      "beyond it a step counts as failed. 0: any is allowed. Units: grid "
      "spacings.",
      {0.}};
  };
} // namespace Morula

#endif
