// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_newton_trace_h
#define morula_output_newton_trace_h

#include <morula/solver/newton.h>

#include <string>
#include <vector>

namespace Morula
{
  /** The columns of newton.csv, the states that Newton's method has accepted.
   */
  std::vector<std::string>
  newton_columns();

  /** The rows of a step in newton.csv. @param trace with the extremes of all
   *  ranks */
  std::string
  newton_rows(const unsigned int                  step,
              const std::vector<NewtonIteration> &trace);
} // namespace Morula

#endif
