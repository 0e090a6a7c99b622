// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fate/cell_cycle.h>

namespace Morula
{
  namespace
  {
    const char *const of_founder =
      " An expression of X, Y, Z (um), evaluated at the founder's initial "
      "position and inherited by all its descendants.";

    /** Path of a key of this section. */
    std::string
    path(const std::string &name)
    {
      return "Proliferation/Cell cycle/" + name;
    }
  } // namespace


  CellCycleParameters::CellCycleParameters()
    : start(path("Start"),
            "waiting",
            "State at t = 0: 'waiting': all cells in G0, with "
            "exponentially distributed waits; 'together': all cells "
            "enter S at t = 0.",
            {"waiting|together"})
    , duration(path("Duration"),
               "1",
               "T_cycle: total duration of S, G2, M and G1. "
               "Positive, and at least twice Time/Step." +
                 std::string(of_founder) + " Units: day.",
               Evaluated::event)
    , exit_rate(path("G0 exit rate"),
                "1",
                "Lambda: rate of the exponentially distributed "
                "wait in G0. Not negative; 0: cells never leave G0." +
                  std::string(of_founder) + " Units: 1/day.",
                Evaluated::event)
    , size_checkpoint(path("Size checkpoint"),
                      "0",
                      "J_th: a cell enters S only while its elastic volume "
                      "ratio J_e is above this value. Not negative; 0: no "
                      "checkpoint." +
                        std::string(of_founder),
                      Evaluated::event)
    , where(path("Where"),
            "1",
            "Founders for which this is > 0 proliferate." +
              std::string(of_founder),
            Evaluated::founder)
    , division_axis(path("Division axis"),
                    "random",
                    "n_s: 'random': uniform on the sphere (2-D: circle), "
                    "drawn at every onset of S; 'fixed': along Fixed axis.",
                    {"random|fixed"})
    , fixed_axis(path("Fixed axis"),
                 {0., 0., 1.},
                 "Direction of n_s for Division axis = fixed, of any "
                 "length but zero. 2-D: the first two components.",
                 {2, 3})
    , axis_follows_rotation(
        path("Axis follows rotation"),
        false,
        "false: daughters are placed along n_s, as in the paper; "
        "true: along F_e n_s.")
  {
    duration.positive("day", "Choose the duration of a cycle in days.");
    exit_rate.not_negative("1/day", "0 lets cells wait forever.");
    size_checkpoint.not_negative("(a ratio of volumes)",
                                 "0 means no checkpoint.");
  }


  KeyList
  CellCycleParameters::list()
  {
    return {&start,
            &duration,
            &exit_rate,
            &size_checkpoint,
            &where,
            &division_axis,
            &fixed_axis,
            &axis_follows_rotation};
  }
} // namespace Morula
