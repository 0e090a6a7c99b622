// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/contact/contact_parameters.h>

namespace Morula
{
  ContactParameters::ContactParameters()
    : between(
        "Contact/Between",
        "none",
        "What may touch, press on each other, slide without friction and "
        "part again. none: tissue that comes within a grid spacing or two "
        "of other tissue sticks to it. bodies: different bodies have "
        "contact where their surfaces meet. all: so have folds and arms of "
        "one body.",
        {"none|bodies|all"})
    , bodies("Contact/Bodies",
             "apart",
             "What is a body. apart: cells that stand together at t = 0; gaps "
             "between bodies are at least as wide as 0.8 cells. cell type: all "
             "cells of a type, by Cell types/Names; they may touch from the "
             "start. Daughters belong to their mother's body.",
             {"apart|cell type"})
    , stiffness("Contact/Stiffness",
                100.,
                "Pressure of two bodies that overlap, by the depth; > 0. They "
                "overlap by the pressure over this. Units: E/h.")
    , friction("Contact/Friction",
               0.,
               "Viscous friction of surfaces that touch: stress along the "
               "surface over the velocity at which they slide; >= 0. "
               "Units: kPa day/um.")
    , fusion_time(
        "Contact/Fusion time",
        0.,
        "Time of touch after which two bodies become one, and with "
        "Between = all two strands of a body: they get splines and a "
        "surface in common and never part again; 0: they do not fuse. "
        "Needs Refine surface. Units: day.")
    , fields_pass(
        "Contact/Fields pass",
        true,
        "Whether fields pass from body to body where these touch, or "
        "are within a grid spacing of it; faces that touch are no surface "
        "for them then. With false they end at each body's own surface.")
  {
    for (AnyKey *const key : list())
      if (key != &between)
        key->needs({between.path()});
    fields_pass.needs({"Fields/Names"});
    friction.require([](const double zeta) { return zeta >= 0.; },
                     "a number >= 0, in kPa day/um",
                     "0 is no friction.");
    fusion_time.require([](const double time) { return time >= 0.; },
                        "a number >= 0, in days",
                        "0 lets bodies stay apart.");
    stiffness.require(
      [](const double kappa) { return kappa > 0.; },
      "a number > 0, in units of E/h",
      "100 is a good choice: less lets bodies overlap, far more "
      "takes more iterations.");
  }


  bool
  ContactParameters::is_on() const
  {
    return between != "none";
  }


  bool
  ContactParameters::is_of_all() const
  {
    return between == "all";
  }


  KeyList
  ContactParameters::list()
  {
    return {
      &between, &bodies, &stiffness, &friction, &fusion_time, &fields_pass};
  }
} // namespace Morula
