// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/catalogue.h>
#include <morula/effects/fate/cell_cycle.h>
#include <morula/effects/rest_of_scene.h>

#include <algorithm>

namespace Morula
{
  namespace
  {
    const char *const of_founder =
      " An expression of X, Y, Z (um), evaluated at the founder's initial "
      "position and inherited by all its descendants.";

    /** The full path of a key of this section. */
    std::string
    path(const std::string &name)
    {
      return "Proliferation/Cell cycle/" + name;
    }
  } // namespace


  CellCycleParameters::CellCycleParameters()
    : law("Proliferation/Law",
          "none",
          "How cells grow and divide.",
          {"none|cell cycle"})
    , start(path("Start"),
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
  {
    // By default there is no checkpoint. Where is evaluated once per founder;
    // the others at an event of the clock, since a cell in its cycle keeps what
    // it began with.

    // The limits below hold for numbers and for expressions, whose values are
    // checked at cells.
    duration.positive("day", "Choose the duration of a cycle in days.");
    exit_rate.not_negative("1/day", "0 lets cells wait forever.");
    size_checkpoint.not_negative("(a ratio of volumes)",
                                 "0 means no checkpoint.");
  }


  bool
  CellCycleParameters::is_on() const
  {
    return law != "none" || is_law_of_types;
  }


  std::string
  CellCycleParameters::details() const
  {
    return "cell cycle, T = " + duration.text() +
           " day, Lambda = " + exit_rate.text() + " /day" +
           (size_checkpoint.is_default() ?
              "" :
              ", size checkpoint J_th = " + size_checkpoint.text());
  }


  void
  CellCycleParameters::take_laws_of_types(
    const std::vector<const Key<std::string> *> &laws)
  {
    // Cells of a type that does not proliferate stay in G0: their rate of
    // leaving it is set to 0, so that one cell cycle serves all types.
    is_law_of_types =
      std::any_of(laws.begin(), laws.end(), [](const Key<std::string> *own) {
        return !own->empty() && *own != "none";
      });
    if (!is_on())
      return;
    for (unsigned int i = 0; i < laws.size(); ++i)
      {
        const Key<std::string> &of_type = laws[i]->empty() ? law : *laws[i];
        if (of_type == "none")
          exit_rate.set_for_type(i, of_type.path(), "0");
      }
  }


  KeyList
  CellCycleParameters::list()
  {
    // The order is that of the printed parameters.
    return {&law, &start, &duration, &exit_rate, &size_checkpoint, &where};
  }
} // namespace Morula
