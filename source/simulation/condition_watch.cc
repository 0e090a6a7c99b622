// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/simulation/condition_watch.h>

#include <sstream>

namespace Morula
{
  ConditionWatch::ConditionWatch(const Announce &announce)
    : announce(announce)
  {}


  void
  ConditionWatch::look(const std::vector<ForceRow> &rows, const double t)
  {
    // Some points may go with their cells, and forces.csv has their number.
    // Once the last one is gone the scene is another one.
    for (const ForceRow &row : rows)
      {
        if (row.kind != "condition")
          continue;
        std::uint64_t &n = before[row.name];
        if (n > 0 && row.points == 0)
          {
            std::ostringstream text;
            text << "Warning: in the step to t = " << t << " day " << row.name
                 << " acts on no boundary point any more, and did on " << n
                 << " before: the cells near them are gone. What it held or "
                    "loaded goes on without it. Keep these cells alive, or "
                    "choose a place that stays.";
            announce(text.str());
          }
        n = row.points;
      }
  }
} // namespace Morula
