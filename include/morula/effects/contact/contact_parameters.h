// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_contact_contact_parameters_h
#define morula_effects_contact_contact_parameters_h

#include <morula/effects/effect.h>

#include <string>

namespace Morula
{
  /** Section "Contact": bodies that meet. */
  struct ContactParameters : public EffectKeys
  {
    ContactParameters()
    {
      for (AnyKey *const key : list())
        if (key != &between)
          key->needs({between.path()});
      fields_pass.needs({"Fields/Names"});
    }

    Key<std::string> between{
      {this, "Contact/Between"},
      "none",
      "What may touch, press on each other, slide without friction and "
      "part again. none: tissue that comes within a grid spacing or two "
      "of other tissue sticks to it. bodies: different bodies have "
      "contact where their surfaces meet. all: so have folds and arms of "
      "one body.",
      {"none|bodies|all"}};

    Key<std::string> bodies{
      {this, "Contact/Bodies"},
      "apart",
      "What is a body. apart: cells that stand together at t = 0; gaps "
      "between bodies are at least as wide as 0.8 cells. cell type: all "
      "cells of a type, by Cell types/Names; they may touch from the "
      "start. Daughters belong to their mother's body.",
      {"apart|cell type"}};

    Key<double> stiffness{
      {this, "Contact/Stiffness"},
      100.,
      "Pressure of two bodies that overlap, by the depth; > 0. They "
      "overlap by the pressure over this. Units: E/h.",
      {},
      positive("E/h",
               "100 is a good choice: less lets bodies overlap, far more "
               "takes more iterations.")};

    Key<double> friction{
      {this, "Contact/Friction"},
      0.,
      "Viscous friction of surfaces that touch: stress along the "
      "surface over the velocity at which they slide; >= 0. "
      "Units: kPa day/um.",
      {},
      {[](const double zeta) { return zeta >= 0.; },
       "a number >= 0, in kPa day/um",
       "0 is no friction."}};

    Key<double> fusion_time{
      {this, "Contact/Fusion time"},
      0.,
      "Time of touch after which two bodies become one, and with "
      "Between = all two strands of a body: they get splines and a "
      "surface in common and never part again; 0: they do not fuse. "
      "Needs Refine surface. Units: day.",
      {},
      not_negative("day", "0 lets bodies stay apart.")};

    Key<bool> fields_pass{
      {this, "Contact/Fields pass"},
      true,
      "Whether fields pass from body to body where these touch, or "
      "are within a grid spacing of it; faces that touch are no surface "
      "for them then. With false they end at each body's own surface."};

    /** Whether bodies have contact with each other. */
    bool
    is_on() const override
    {
      return between != "none";
    }

    /** Whether a body can touch itself, too. */
    bool
    is_of_all() const
    {
      return between == "all";
    }

    /** Bodies touch by their surfaces. */
    EffectFacts
    facts() const override
    {
      EffectFacts facts;
      facts.needs_surface = true;
      return facts;
    }

    void
    check(const SceneKeys &scene, Review &review) const override;
  };
} // namespace Morula

#endif
