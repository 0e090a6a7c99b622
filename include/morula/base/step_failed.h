// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_step_failed_h
#define morula_base_step_failed_h

#include <stdexcept>
#include <string>

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
    /** @param is_too_long whether it has been solved, and goes too far */
    explicit StepFailed(const std::string &reason,
                        const bool         is_too_long = false)
      : std::runtime_error(reason)
      , is_too_long(is_too_long)
    {}

    const bool is_too_long;
  };
} // namespace Morula

#endif
