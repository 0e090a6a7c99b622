// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// A program with an effect of its own of each kind: a file and a line each.

#include <morula/mechanics/materials/own_material.h>
#include <morula/program/program.h>

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

int
main(int argc, char *argv[])
{
  Morula::Program program;
  program.catalogue.add_growth_law<Own::DoseLaw>("dose");
  program.catalogue.add_division_rule<Own::AlongRule>("along");
  program.catalogue.add_trait<Own::Ageing>("ageing");
  program.catalogue.add_growth_factor<Own::Swelling>("swelling");
  program.catalogue.add_flow<Own::Melting>("melting");
  program.catalogue.add_fate<Own::Anoikis>("anoikis");
  program.catalogue.add_step_effect<Own::Conversion>("conversion");
  program.catalogue.add_step_effect<Own::Census>("census");
  program.catalogue.add_equation<Own::Sharing>("sharing");
  program.catalogue.add_force<Own::Pull>("pull");
  program.catalogue.add_boundary_condition<Own::Drag>("drag");
  program.catalogue.add_interaction<Own::Tethers>("tethers");
  program.catalogue.materials.add("twofold",
                                  Morula::own_material(Own::Twofold()));
  return program.run(argc, argv);
}
