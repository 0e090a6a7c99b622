// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_step_failed_h
#define morula_base_step_failed_h

#include <stdexcept>

namespace Morula
{
  /**
   * The step cannot be done with this dt: no convergence, linear solver
   * failure, or inversion. It means "retry with a smaller dt". It is thrown on
   * all ranks together, or by an action of everywhere(); every other exception
   * ends the run.
   */
  class StepFailed : public std::runtime_error
  {
  public:
    using std::runtime_error::runtime_error;
  };
} // namespace Morula

#endif
