// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_division_division_parameters_h
#define morula_effects_division_division_parameters_h

#include <morula/base/expression_key.h>
#include <morula/effects/effect.h>

#include <string>

namespace Morula
{
  /** The keys of section "Proliferation/Cell cycle" that say along what cells
   *  divide, and where daughters are placed: with a cycle and without. */
  struct DivisionParameters : public EffectKeys
  {
    Key<std::string> axis{
      {this, "Proliferation/Cell cycle/Division axis"},
      "random",
      "n_s, chosen at every onset of S, or at a Division by size: 'random': uniform on the sphere "
      "(2-D: circle); 'fixed': along Fixed axis; in the present "
      "configuration, 'stretch': along the largest elastic stretch, "
      "'stress': along the most tensile stress, 'radial': away from Radial "
      "center, 'surface normal', 'tangential': across or along the surface "
      "that was nearest to the founder at t = 0, 'cell shape': along which "
      "the cell is longest; 'gradient of NAME': along "
      "which a field rises fastest.",
      {"random"}};

    /** κ */
    ExpressionKey axis_spread{
      {this, "Proliferation/Cell cycle/Axis spread"},
      "0",
      "kappa: concentration of the axes around what Division axis "
      "says, by the distribution of von Mises and Fisher. The "
      "larger, the nearer: the root of the mean square angle tends "
      "to sqrt(2/kappa), in 2-D sqrt(1/kappa). An expression; not "
      "negative; 0: no spread.",
      Evaluated::event,
      not_negative("(a concentration)",
                   "0 means no spread; otherwise, the larger the "
                   "number, the nearer are axes to what Division axis "
                   "says.")};

    ExpressionKey least_anisotropy{
      {this, "Proliferation/Cell cycle/Least anisotropy"},
      "1.02",
      "Ratio of the two largest elastic stretches below which Division axis "
      "= stretch takes a random axis; for stress, of 1 + (sigma_1 - "
      "sigma_2)/(2 mu). An expression; at least 1.",
      Evaluated::event,
      {[](const double ratio) { return ratio >= 1.; },
       "a ratio of at least 1",
       "1 lets every cell follow its stretch; 1.02 leaves those to chance that "
       "can hardly tell."}};

    Key<bool> axis_follows_rotation{
      {this, "Proliferation/Cell cycle/Axis follows rotation"},
      false,
      "false: daughters are placed along n_s, as in the paper; "
      "true: along F_e n_s. For Division axis = random or fixed; others "
      "place them along the direction that they name."};

    Key<bool> stay_inside{
      {this, "Proliferation/Cell cycle/Stay inside surface"},
      false,
      "true: daughters are placed inside the whole surface; false: only "
      "inside what is held of it, as in the paper."};
  };
} // namespace Morula

#endif
