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
  add_cell_cycle(Choices<Fate> &fates);
  void
  add_division_by_size(Choices<Fate> &fates);
  void
  add_death(Choices<Fate> &fates);
  void
  add_extrusion(Choices<Fate> &fates);

  void
  add_division_rules(Choices<DivisionRule> &rules);
} // namespace Morula

#endif
