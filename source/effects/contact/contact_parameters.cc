// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/contact/contact_parameters.h>

namespace Morula
{
  ContactParameters::ContactParameters()
    : between("Contact/Between",
              "none",
              "What may touch, press on each other, slide without friction and "
              "part again. none: tissue that comes within a grid spacing or two "
              "of other tissue sticks to it. bodies: different bodies have "
              "contact where their surfaces meet.",
              {"none|bodies"})
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
    , fields_pass("Contact/Fields pass",
                  true,
                  "Whether fields pass from body to body where these touch, or "
                  "are within a grid spacing of it. With false they end at each "
                  "body's own surface.")
  {
    stiffness.require([](const double kappa) { return kappa > 0.; },
                      "a number > 0, in units of E/h",
                      "100 is a good choice: less lets bodies overlap, far more "
                      "takes more iterations.");
  }


  bool
  ContactParameters::is_on() const
  {
    return between != "none";
  }


  KeyList
  ContactParameters::list()
  {
    return {&between, &bodies, &stiffness, &fields_pass};
  }
} // namespace Morula
