// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_program_explain_parts_h
#define morula_program_explain_parts_h

#include <morula/scene/scene.h>
#include <morula/scene/seeded_tissue.h>

#include <deal.II/particles/property_pool.h>

#include <ostream>
#include <string>
#include <vector>

namespace Morula
{
  /** An effect of a scene: its name, what it is, and further lines. */
  struct EffectRow
  {
    std::string name;
    std::string description;
    std::string further = {};
  };

  using EffectRows = std::vector<EffectRow>;

  /** Adds an effect to those of the scene. */
  void
  add_effect(EffectRows        &rows,
             const std::string &name,
             const std::string &description,
             const std::string &further = "");

  /** Prints one line, a name and what it is, and the further lines. */
  void
  print(std::ostream &out, const EffectRow &row);

  /** The effects of a scene.
   *  @param counts  of boundary points
   *  @param applied what the conditions apply
   *  @param n_founders, n_proliferating on all ranks */
  EffectRows
  effect_rows(const Scene                         &scene,
              const ConditionCounts               &counts,
              const std::vector<AppliedCondition> &applied,
              const types::particle_index          n_founders,
              const types::particle_index          n_proliferating);

  /** Prints the types of cells, and for each type the keys that it sets
   *  differently. Prints nothing without types. @param n_founders by type, on
   *  all ranks */
  void
  print_types(std::ostream                             &out,
              const Scene                              &scene,
              const std::vector<types::particle_index> &n_founders);

  /** Prints which expressions use variables of the present cell, which
   *  variables these are, and when they are evaluated. Prints nothing if there
   *  are none. */
  void
  print_cell_expressions(std::ostream &out, const Scene &scene);
} // namespace Morula

#endif
