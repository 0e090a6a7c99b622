// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_output_parameters_h
#define morula_output_output_parameters_h

#include <morula/base/key.h>

#include <set>
#include <string>
#include <vector>

namespace Morula
{
  /** Section "Output". */
  struct OutputParameters : public Keys
  {
    Key<double> interval{{this, "Output/Interval"},
                         0.25,
                         "Time between two outputs of cells and surface; "
                         "0: first and last only. Units: day.",
                         {0.}};

    Key<std::vector<std::string>> formats{
      {this, "Output/Formats"},
      {"vtu"},
      "Files of cells and surface, one or more separated by "
      "commas. None still writes statistics, timings and "
      "lineage.",
      {"vtu|csv|none"},
      {[](const std::vector<std::string> &words) {
         const std::set<std::string> all(words.begin(), words.end());
         return !words.empty() && all.size() == words.size() &&
                (words.size() == 1 || all.count("none") == 0);
       },
       "any of vtu, csv, each once, or none alone",
       "Remove 'none' or the others, and what is there twice."}};

    Key<double> snapshot_interval{
      {this, "Output/Snapshot interval"},
      0.,
      "Time between two snapshots for --resume; 0: by the "
      "clock and at the end only. Units: day.",
      {0.}};

    Key<double> snapshot_minutes{
      {this, "Output/Snapshot minutes"},
      15.,
      "Time on the clock after which the next step is "
      "followed by a snapshot for --resume; more where "
      "snapshots would take more than a twentieth of the run. "
      "0: none by the clock. Units: min.",
      {0.}};

    Key<bool> condition_estimate{
      {this, "Output/Condition estimate"},
      false,
      "Whether condition.csv is to hold the extreme eigenvalues "
      "of each step's first tangent, scaled to a unit "
      "diagonal. Takes longer than the step itself."};

    Key<bool> newton_trace{
      {this, "Output/Newton trace"},
      false,
      "Whether newton.csv is to hold all states of Newton's "
      "method: energy, residual, motion, curvature, smallest J "
      "and where. Shows why a step takes long, or fails."};
  };
} // namespace Morula

#endif
