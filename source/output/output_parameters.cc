// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/time_parameters.h>
#include <morula/output/output_parameters.h>

#include <algorithm>
#include <set>

namespace Morula
{
  OutputParameters::OutputParameters()
    : interval("Output/Interval",
               0.25,
               "Time between two outputs of cells and surface; "
               "0: first and last only. Units: day.",
               {0.})
    , formats("Output/Formats",
              {"vtu"},
              "Files of cells and surface, one or more separated by "
              "commas. None still writes statistics, timings and "
              "lineage.",
              {"vtu|csv|none"})
    , snapshot_interval("Output/Snapshot interval",
                        0.,
                        "Time between two snapshots for --resume; 0: by the "
                        "clock and at the end only. Units: day.",
                        {0.})
    , snapshot_minutes("Output/Snapshot minutes",
                       15.,
                       "Time on the clock after which the next step is "
                       "followed by a snapshot for --resume; more where "
                       "snapshots would take more than a twentieth of the run. "
                       "0: none by the clock. Units: min.",
                       {0.})
    , condition_estimate(
        "Output/Condition estimate",
        false,
        "Whether condition.csv is to hold the extreme eigenvalues "
        "of each step's first tangent, scaled to a unit "
        "diagonal. Takes longer than the step itself.")
    , newton_trace("Output/Newton trace",
                   false,
                   "Whether newton.csv is to hold all states of Newton's "
                   "method: energy, residual, motion, curvature, smallest J "
                   "and where. Shows why a step takes long, or fails.")
  {
    using Words = std::vector<std::string>;
    // Words that exclude each other cannot be said by the list of allowed
    // words.
    formats.require(
      [](const Words &words) {
        return !words.empty() &&
               (words.size() == 1 ||
                std::count(words.begin(), words.end(), "none") == 0);
      },
      "any of vtu, csv, or none alone",
      "Remove 'none' or the others.");
    formats.require(
      [](const Words &words) {
        return std::set<std::string>(words.begin(), words.end()).size() ==
               words.size();
      },
      "each format once",
      "Remove what is written twice.");
  }


  KeyList
  OutputParameters::list()
  {
    return {&interval,
            &formats,
            &snapshot_interval,
            &snapshot_minutes,
            &condition_estimate,
            &newton_trace};
  }
} // namespace Morula
