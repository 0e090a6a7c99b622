// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_matrix_condition_h
#define morula_output_matrix_condition_h

#include <morula/solver/condition_estimate.h>

#include <string>
#include <vector>

namespace Morula
{
  /** The columns of condition.csv, the condition of the tangent matrix. */
  std::vector<std::string>
  condition_columns();

  /** The row of a step in condition.csv. @param time (day) of the step's
   *  beginning, where the tangent is taken */
  std::string
  condition_row(const unsigned int       step,
                const double             time,
                const ConditionEstimate &estimate);
} // namespace Morula

#endif
