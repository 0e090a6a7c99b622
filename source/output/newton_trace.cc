// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/csv_rows.h>
#include <morula/output/newton_trace.h>

namespace Morula
{
  std::vector<std::string>
  newton_columns()
  {
    return {"step",
            "attempt",
            "turn",
            "proximity",
            "iteration",
            "energy",
            "residual",
            "part",
            "motion",
            "curvature",
            "smallest_J",
            "x",
            "y",
            "z"};
  }


  std::string
  newton_rows(const unsigned int                  step,
              const std::vector<NewtonIteration> &trace)
  {
    std::string rows;
    for (const NewtonIteration &state : trace)
      {
        // The extremes are those of all ranks by now.
        const Equilibrium::Extreme &J      = state.evaluation.smallest_J;
        const std::vector<double>   values = {double(step),
                                              double(state.place.attempt),
                                              double(state.place.turn),
                                              state.place.proximity,
                                              double(state.iteration),
                                              state.evaluation.energy,
                                              state.residual,
                                              state.part,
                                              state.motion,
                                              state.curvature,
                                              J.value,
                                              J.place[0],
                                              J.place[1],
                                              J.place[2]};
        rows += csv_row(values.data(), values.size());
      }
    return rows;
  }
} // namespace Morula
