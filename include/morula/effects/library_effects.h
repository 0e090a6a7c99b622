// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_library_effects_h
#define morula_effects_library_effects_h

#include <morula/effects/catalogue.h>

namespace Morula
{
  // Each of these adds the effect of the library that its name says: keys,
  // effect and example stand together in the file of that name. The keys know
  // their full paths, so that the effect's section is empty.

  void
  add_isotropic_growth(Choices<GrowthLaw> &laws);
  void
  add_rate_growth(Choices<GrowthLaw> &laws);
  void
  add_contraction(Choices<GrowthFactor> &factors);
  void
  add_relaxation(Choices<Flow> &flows);

  void
  add_cell_cycle(Choices<Fate> &fates);
  void
  add_division_by_size(Choices<Fate> &fates);
  void
  add_death(Choices<Fate> &fates);
  void
  add_extrusion(Choices<Fate> &fates);

  void
  add_division_rules(Choices<DivisionRule> &rules);

  void
  add_rearrangement(Choices<StepEffect> &step_effects);
  void
  add_neighbours(Choices<StepEffect> &step_effects);
  void
  add_present_depth(Choices<StepEffect> &step_effects);

  void
  add_fields(Choices<Equation> &equations);

  void
  add_body_force(Choices<Force> &forces);
  void
  add_friction(Choices<Force> &forces);
  void
  add_type_tension(Choices<Force> &forces);

  void
  add_fixed(Choices<BoundaryCondition> &conditions);
  void
  add_slip(Choices<BoundaryCondition> &conditions);
  void
  add_traction(Choices<BoundaryCondition> &conditions);
  void
  add_pressure(Choices<BoundaryCondition> &conditions);
  void
  add_surface_tension(Choices<BoundaryCondition> &conditions);
  void
  add_lumen(Choices<BoundaryCondition> &conditions);
  void
  add_obstacles(Choices<BoundaryCondition> &conditions);
  void
  add_type_surface_tension(Choices<BoundaryCondition> &conditions);

  void
  add_contact(Choices<Interaction> &interactions);
} // namespace Morula

#endif
