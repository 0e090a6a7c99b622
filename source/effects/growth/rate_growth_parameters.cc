// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/growth/rate_growth.h>
#include <morula/effects/rest_of_scene.h>

namespace Morula
{
  RateGrowthParameters::RateGrowthParameters()
    : rate("Growth/Rate/Rate",
           "0",
           "k: rate at which the volume of a cell grows, an expression of its "
           "state; < 0: it withers. Units: 1/day.",
           Evaluated::step)
    , share_along(
        "Growth/Rate/Share along",
        "",
        "s: which share of the rate is growth along Direction, from 0 "
        "to 1; the rest is growth across it. An expression of the "
        "cell's state. 0: growth in a surface, if Direction is its "
        "normal; 1: along a fibre; 1/3 (in 2-D 1/2), or empty: "
        "isotropic.",
        Evaluated::step)
    , direction(
        "Growth/Rate/Direction",
        "",
        "a: direction of Share along in the tissue as it was at t = 0: "
        "'radial', 'surface normal', 'gradient of' a field, or an expression of X, Y, Z with "
        "three components, e.g. 0; 0; 1, of any length but zero. Empty: "
        "growth is isotropic.")
    , predictor("Growth/Rate/Predictor",
                true,
                "Whether rates that fall as a cell is squeezed foresee the end "
                "of the step, so that confined tissue is stable with steps of "
                "any length. false: the rate at the beginning of the step.")
    , homeostasis(
        "Growth/Rate/Homeostasis",
        "0",
        "kappa: rate of stress-regulated growth: along each principal "
        "direction a cell grows at kappa times what its stress lies "
        "above Homeostatic stress. Not negative; 0: none. An "
        "expression of the cell's state. Units: 1/(day kPa).",
        Evaluated::step)
    , homeostatic_stress("Growth/Rate/Homeostatic stress",
                         "0",
                         "sigma*: true stress at which stress-regulated growth "
                         "comes to rest; < 0: a pressure. An expression of the "
                         "cell's state. Units: kPa.",
                         Evaluated::step)
  {
    // The rate itself may be negative, as cells may wither; a negative
    // coefficient of homeostasis would drive the stress away from its target
    // and is refused. Expressions are evaluated once in each step.
    rate.symbol("k");
    homeostasis.not_negative("1/(day kPa)", "0 is no growth by stress.");
    homeostatic_stress.needs({homeostasis.path()});
    share_along.needs({direction.path()});
    direction.needs({share_along.path()});
  }


  KeyList
  RateGrowthParameters::list()
  {
    // The order is that of the printed parameters.
    return {&rate,
            &share_along,
            &direction,
            &predictor,
            &homeostasis,
            &homeostatic_stress};
  }
} // namespace Morula
