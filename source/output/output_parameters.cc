// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

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
                        "Time between two snapshots for --resume; 0: at the "
                        "end only. Units: day.",
                        {0.})
    , condition_estimate(
        "Output/Condition estimate",
        false,
        "Whether condition.csv is to hold the extreme eigenvalues "
        "of each step's first tangent, scaled to a unit "
        "diagonal. Takes longer than the step itself.")
  {
    using Words = std::vector<std::string>;
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
    return {&interval, &formats, &snapshot_interval, &condition_estimate};
  }
} // namespace Morula
