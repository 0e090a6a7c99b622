// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/csv_rows.h>
#include <morula/output/matrix_condition.h>

namespace Morula
{
  std::vector<std::string>
  condition_columns()
  {
    return {"step", "time", "unknowns", "smallest", "largest", "condition"};
  }

  std::string
  condition_row(const unsigned int       step,
                const double             time,
                const ConditionEstimate &estimate)
  {
    // Values in the order of condition_columns().
    const std::vector<double> values = {double(step),
                                        time,
                                        double(estimate.unknowns),
                                        estimate.smallest,
                                        estimate.largest,
                                        estimate.condition()};
    return csv_row(values.data(), values.size());
  }
} // namespace Morula
