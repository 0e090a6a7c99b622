// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// An effect of each kind: a file and a line each, with the settings by which
// the tests of all effects try it.

#ifndef own_effects_own_effects_h
#define own_effects_own_effects_h

#include <morula/effects/catalogue.h>
#include <morula/mechanics/materials/own_material.h>

#include "ageing.h"
#include "along_rule.h"
#include "anoikis.h"
#include "census.h"
#include "conversion.h"
#include "dose_law.h"
#include "drag.h"
#include "melting.h"
#include "pull.h"
#include "sharing.h"
#include "swelling.h"
#include "tethers.h"
#include "twofold.h"

namespace Own
{
  inline void
  add_effects(Catalogue &catalogue)
  {
    catalogue.add<Own::DoseLaw>("dose",
                                {"Growth/Law=dose",
                                 "Growth/Dose/Uptake=1 + 0.1*X*Y"});
    catalogue.add<Own::AlongRule>(
      "along",
      {"Growth/Law=rate",
       "Growth/Rate/Rate=J_e",
       "Division by size/Volume=1.1",
       "Proliferation/Cell cycle/Division axis=along",
       "Proliferation/Cell cycle/Along/Direction=1, 1, 0"});
    catalogue.add<Own::Ageing>("ageing",
                               {"Growth/Law=dose", "Ageing/Record=true"});
    catalogue.add<Own::Swelling>("swelling",
                                 {"Swelling/Stretch=1 + 0.1*t*(1 + 0.1*X*Y)"});
    catalogue.add<Own::Melting>("melting",
                                {"Swelling/Stretch=1 + 0.1*t*(1 + 0.1*X*Y)",
                                 "Melting/When=t > 0.15"});
    catalogue.add<Own::Anoikis>("anoikis",
                                {"Anoikis/Where=X + Y > 2",
                                 "Anoikis/After=0.15"});
    catalogue.add<Own::Conversion>("conversion",
                                   {"Fields/Names=raw, made",
                                    "Fields/raw/Time=transient",
                                    "Fields/raw/Diffusion=1",
                                    "Fields/raw/Initial=1 + 0.1*X*Y",
                                    "Fields/made/Time=transient",
                                    "Fields/made/Diffusion=1",
                                    "Conversion/Rate=2"});
    catalogue.add<Own::Census>("census", {"Census/Take=true"});
    catalogue.add<Own::Sharing>("sharing", {"Sharing/Initial=1 + 0.1*X*Y"});
    catalogue.add<Own::Pull>("pull",
                             {"Boundary conditions/Fixed where=X + Y < -2",
                              "Pull/Density=0.01*t; 0.01*t; 0"});
    catalogue.add<Own::Drag>("drag",
                             {"Boundary conditions/Fixed where=X + Y < -2",
                              "Boundary conditions/Drag/Where=X + Y > 2",
                              "Boundary conditions/Drag/Load=0.1; 0.1; 0"});
    // Bodies to hold together come from a file, so that there is no example:
    // tests/programs/test_own_effects.py has them.
    catalogue.add<Own::Tethers>("tethers");
    catalogue.materials.add("twofold", own_material(Twofold()));
  }
} // namespace Own

#endif
