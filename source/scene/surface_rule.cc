// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/growth/relaxation.h>
#include <morula/scene/tissue_model.h>

#include <algorithm>

// Which surfaces are made from the cells: Tissue/Surface.

namespace Morula
{
  template <int dim>
  bool
  TissueModel<dim>::any_surface(const bool is_remade) const
  {
    // Only bodies of one type of cells each can differ.
    const std::size_t n =
      interaction && interaction->effect->takes_types_as_bodies() ?
        std::max<std::size_t>(1, scene.cell_types.types.size()) :
        1;
    for (unsigned int b = 0; b < n; ++b)
      if (remakes_surface(b) == is_remade)
        return true;
    return false;
  }


  template <int dim>
  bool
  TissueModel<dim>::remakes_surface(const unsigned int body) const
  {
    // Dead loads, folds that press and what holds elastic tissue remember t =
    // 0. Flow is asked of the body: of its own type of cells, or of all.
    if (scene.tissue.surface != "automatic")
      return scene.tissue.surface == "from cells";
    const Catalogue &list = scene.catalogue;
    if (find_choice(list.boundary_conditions, "traction")->keys().is_on() ||
        (interaction && interaction->effect->acts_within_bodies() &&
         !interaction->effect->fuses()))
      return false;
    if (find_choice(list.step_effects, "rearrangement")->keys().is_on())
      return true;
    bool loses = false;
    for (const EffectKeys *const keys : scene.keys_in_use())
      loses = loses || keys->loses_cells();
    const Expression time =
      scene.keys<RelaxationParameters>().time.expression(dim);
    const auto &of_types = time.types();
    const auto  flows    = [](const Expression &one) {
      return one.number().value_or(1.) != 0.;
    };
    bool some = scene.flows(), all = flows(time) && !time.depends_on_state();
    for (const auto &[type, own] : of_types)
      all = all && flows(own);
    if (interaction && interaction->effect->takes_types_as_bodies())
      some = all = flows(of_types.count(body) > 0 ? of_types.at(body) : time);
    return loses ? some : all && !boundary_conditions.has_dirichlet();
  }


  template bool
  TissueModel<2>::any_surface(const bool) const;
  template bool
  TissueModel<3>::any_surface(const bool) const;
  template bool
  TissueModel<2>::remakes_surface(const unsigned int) const;
  template bool
  TissueModel<3>::remakes_surface(const unsigned int) const;
} // namespace Morula
