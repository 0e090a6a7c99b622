// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/time_left.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace Morula
{
  TimeLeft::TimeLeft(const double start, const double end)
    : end(end)
    , records({{start, 0.}})
  {}

  void
  TimeLeft::add(const double time, const double wall_seconds)
  {
    records.push_back({time, wall_seconds});
  }

  double
  TimeLeft::seconds() const
  {
    // The work so far is taken as a power of the simulated time, whose exponent
    // follows from the first and the second half: tissue that grows takes
    // longer and longer. The rest of the run follows by the same power.
    const Record &first = records.front();
    const Record &last  = records.back();
    const double  done  = last.time - first.time;
    const double  spent = last.wall_seconds;
    if (done <= 0. || spent <= 0.)
      return -1.;
    if (last.time >= end)
      return 0.;

    // The wall time at half of the simulated time is interpolated between
    // records.
    const double half = first.time + 0.5 * done;
    const auto   after =
      std::lower_bound(records.begin() + 1,
                       records.end(),
                       half,
                       [](const Record &record, const double t) {
                         return record.time < t;
                       });
    const Record &before = *(after - 1);
    const double  weight = (half - before.time) / (after->time - before.time);
    const double  spent_at_half =
      before.wall_seconds +
      weight * (after->wall_seconds - before.wall_seconds);

    // A few steps say nothing about growth, so they count as even. The lower
    // bound holds where the set-up outweighs the first steps, the upper one
    // where cells have doubled four times.
    const double exponent =
      records.size() > 4 && spent_at_half > 0. ?
        std::clamp(std::log2(spent / spent_at_half), 0.5, 4.) :
        1.;
    return spent * (std::pow((end - first.time) / done, exponent) - 1.);
  }

  std::string
  duration(const double seconds)
  {
    const long long s = std::llround(seconds);
    char            text[64];
    if (s < 60)
      std::snprintf(text, sizeof(text), "%lld s", s);
    else if (s < 3600)
      std::snprintf(text, sizeof(text), "%lld min %02lld s", s / 60, s % 60);
    else if (s < 86400)
      std::snprintf(
        text, sizeof(text), "%lld h %02lld min", s / 3600, s / 60 % 60);
    else
      std::snprintf(
        text, sizeof(text), "%lld d %02lld h", s / 86400, s / 3600 % 24);
    return text;
  }
} // namespace Morula
