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
    SolverParameters();

    Key<double>       newton_tolerance;
    Key<unsigned int> newton_iterations;
    Key<double>       linear_tolerance;
    Key<std::string>  linear_solver;
    Key<std::string>  kernel;
    Key<double>       largest_gap; // grid spacings; 0: any

    using Keys::list;
    KeyList
    list() override;
  };
} // namespace Morula

#endif
