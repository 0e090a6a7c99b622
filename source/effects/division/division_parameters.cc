// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/division/division_parameters.h>
#include <morula/effects/rest_of_scene.h>

namespace Morula
{
  namespace
  {
    /** The full path of a key: the section is that of the cell cycle, which was
     *  the only way to divide. */
    std::string
    path_of(const std::string &name)
    {
      return "Proliferation/Cell cycle/" + name;
    }
  } // namespace


  DivisionParameters::DivisionParameters()
    : axis(
        path_of("Division axis"),
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
    , axis_spread(path_of("Axis spread"),
                  "0",
                  "kappa: concentration of the axes around what Division axis "
                  "says, by the distribution of von Mises and Fisher. The "
                  "larger, the nearer: the root of the mean square angle tends "
                  "to sqrt(2/kappa), in 2-D sqrt(1/kappa). An expression; not "
                  "negative; 0: no spread.",
                  Evaluated::event)
    , least_anisotropy(
        path_of("Least anisotropy"),
        "1.02",
        "Ratio of the two largest elastic stretches below which Division axis "
        "= stretch takes a random axis; for stress, of 1 + (sigma_1 - "
        "sigma_2)/(2 mu). An expression; at least 1.",
        Evaluated::event)
    , axis_follows_rotation(
        path_of("Axis follows rotation"),
        false,
        "false: daughters are placed along n_s, as in the paper; "
        "true: along F_e n_s. For Division axis = random or fixed; others "
        "place them along the direction that they name.")
    , stay_inside(
        path_of("Stay inside surface"),
        false,
        "true: daughters are placed inside the whole surface; false: only "
        "inside what is held of it, as in the paper.")
  {
    // By default the axis is random. The words for the axis come later: rules
    // add their names, and fields their gradients.

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
  }


  KeyList
  DivisionParameters::list()
  {
    // The order is that of the printed parameters.
    return {&axis,
            &axis_spread,
            &least_anisotropy,
            &axis_follows_rotation,
            &stay_inside};
  }
} // namespace Morula
