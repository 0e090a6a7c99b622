// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fate/cell_cycle.h>
#include <morula/effects/rest_of_scene.h>

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
    , division_axis(
        path("Division axis"),
        "random",
        "n_s, chosen at every onset of S, or at a Division by size: 'random': uniform on the sphere "
        "(2-D: circle); 'fixed': along Fixed axis; in the present "
        "configuration, 'stretch': along the largest elastic stretch, "
        "'stress': along the most tensile stress, 'radial': away from Radial "
        "center, 'surface normal', 'tangential': across or along the surface "
        "that was nearest to the founder at t = 0, 'cell shape': along which "
        "the cell is longest; 'gradient of NAME': along "
        "which a field rises fastest.",
        {"random"})
    , axis_spread(path("Axis spread"),
                  "0",
                  "kappa: concentration of the axes around what Division axis "
                  "says, by the distribution of von Mises and Fisher. The "
                  "larger, the nearer: the root of the mean square angle tends "
                  "to sqrt(2/kappa), in 2-D sqrt(1/kappa). An expression; not "
                  "negative; 0: no spread.",
                  Evaluated::event)
    , least_anisotropy(
        path("Least anisotropy"),
        "1.02",
        "Ratio of the two largest elastic stretches below which Division axis "
        "= stretch takes a random axis; for stress, of 1 + (sigma_1 - "
        "sigma_2)/(2 mu). An expression; at least 1.",
        Evaluated::event)
    , axis_follows_rotation(
        path("Axis follows rotation"),
        false,
        "false: daughters are placed along n_s, as in the paper; "
        "true: along F_e n_s. For Division axis = random or fixed; others "
        "place them along the direction that they name.")
    , stay_inside(
        path("Stay inside surface"),
        false,
        "true: daughters are placed inside the whole surface; false: only "
        "inside what is held of it, as in the paper.")
  {
    // By default the axis is random and there is no checkpoint. Where is
    // evaluated once per founder; the others at an event of the clock, since a
    // cell in its cycle keeps what it began with. The words for the axis come
    // later: rules add their names, and fields their gradients.

    // The limits below hold for numbers and for expressions, whose values are
    // checked at cells.
    duration.positive("day", "Choose the duration of a cycle in days.");
    exit_rate.not_negative("1/day", "0 lets cells wait forever.");
    // A concentration of zero is a uniform distribution in theory; here it
    // means that there is none.
    axis_spread.not_negative(
      "(a concentration)",
      "0 means no spread; otherwise, the larger the "
      "number, the nearer are axes to what Division axis "
      "says.");
    // A ratio of the larger to the smaller stretch cannot be below 1.
    least_anisotropy.require(
      [](const double ratio) { return ratio >= 1.; },
      "a ratio of at least 1",
      "1 lets every cell follow its stretch; 1.02 leaves those to chance that "
      "can hardly tell.");
    size_checkpoint.not_negative("(a ratio of volumes)",
                                 "0 means no checkpoint.");
  }


  std::vector<const AnyKey *>
  CellCycleParameters::said_by_column(const std::string &column) const
  {
    return column == "phase" ? std::vector<const AnyKey *>{&start} :
                               std::vector<const AnyKey *>();
  }


  std::vector<IdleKey>
  CellCycleParameters::idle_keys(const RestOfScene &scene) const
  {
    const std::string remedy =
      "Set " + division_axis.path() + ", or remove this key.";
    std::vector<IdleKey> idle;
    if (scene.division_axes == std::set<std::string>{"random"})
      idle.push_back({axis_spread, "all axes are random", remedy});
    if (scene.division_axes.count("stretch") +
          scene.division_axes.count("stress") ==
        0)
      idle.push_back(
        {least_anisotropy, "no axis is that of stretch or stress", remedy});
    return idle;
  }


  KeyList
  CellCycleParameters::list()
  {
    // The order is that of the printed parameters.
    return {&start,
            &duration,
            &exit_rate,
            &size_checkpoint,
            &where,
            &division_axis,
            &axis_spread,
            &least_anisotropy,
            &axis_follows_rotation,
            &stay_inside};
  }
} // namespace Morula
