// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_program_explain_effects_h
#define morula_program_explain_effects_h

#include <morula/scene/seeded_tissue.h>

#include <ostream>
#include <string>
#include <vector>

namespace Morula
{
  /** An effect: its name, whether it is on, what it is, and further lines. */
  struct EffectRow
  {
    std::string name;
    bool        on;
    std::string description;
    std::string further = {};
  };

  using EffectRows = std::vector<EffectRow>;

  /** Adds an effect to those of the scene. */
  void
  add_effect(EffectRows        &rows,
             const std::string &name,
             const bool         on,
             const std::string &description,
             const std::string &further = "");

  /** Prints one line: a name, 'on' or 'off', and what it is; and the further
   *  lines. */
  void
  print(std::ostream &out, const EffectRow &row);

  /** Whether the cycle has a size checkpoint. */
  bool
  has_checkpoint(const Scene &scene);

  /** All effects that the program knows, with what the scene makes of them.
   *  @param counts  of boundary points
   *  @param applied what the conditions apply
   *  @param n_founders, n_proliferating on all ranks */
  EffectRows
  effect_rows(const Scene                         &scene,
              const ConditionCounts               &counts,
              const std::vector<AppliedCondition> &applied,
              const types::particle_index          n_founders,
              const types::particle_index          n_proliferating);
} // namespace Morula

#endif
