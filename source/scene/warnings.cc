// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/instantiate.h>
#include <morula/scene/checks.h>
#include <morula/scene/seeded_tissue.h>
#include <morula/seeding/pieces_at_start.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <numeric>

namespace Morula
{
  template <int dim>
  std::vector<std::string>
  scene_warnings(const TissueModel<dim>    &model,
                 const Founders<dim>       &founders,
                 const SurfacePatches<dim> &surface,
                 const ConditionCounts     &counts,
                 const MPI_Comm             comm)
  {
    // The order is that of the messages: names of keys, units, grid, then
    // effects in the order in which they act, then the surface, and at last the
    // outputs. Many reviews are collective, so all ranks pass through all of
    // them, with the same list of effects.
    const Scene                   &scene      = model.scene;
    const BoundaryConditions<dim> &conditions = model.boundary_conditions;
    Review review{[&scene](const AnyKey &key) { return scene.has_set(key); }};
    for (const std::string &text : scene.renamed)
      review.warnings.push_back("Warning: " + text + '.');
    review_units(scene.tissue, founders, surface, comm, review);
    const bool slips =
      conditions.has(SurfaceCondition::slip) && scene.has_active_tissue();
    review_grid(
      scene.grid, scene.tissue, founders, surface, slips, comm, review);
    if (!model.interaction)
      review_bodies(scene.grid, scene.tissue, founders, surface, comm, review);

    Preview<dim> at = preview<dim>(
      model, founders.positions, surface.positions, surface.normals, comm);
    at.volumes = founders.volumes;
    at.types   = types_of<dim>(model, founders.positions, founders.types);
    const double V =
      std::accumulate(founders.volumes.begin(), founders.volumes.end(), 0.);
    at.mean_volume = Utilities::MPI::sum(V, comm) / founders.n_global;
    at.largest_volume =
      Utilities::MPI::max(founders.volumes.empty() ?
                            0. :
                            *std::max_element(founders.volumes.begin(),
                                              founders.volumes.end()),
                          comm);
    for (const Effect<dim> *const effect : model.all_effects)
      effect->review(at, review);
    for (const EffectKeys *const keys : scene.keys_in_use())
      keys->check(scene, review);
    for (const auto &[name, equation] : model.equations)
      equation->review(at, review);
    review_idle_keys(scene, review);
    review_types(scene.cell_types, at, !founders.types.empty(), review);
    scene.material.review(review);
    for (const auto &[name, condition] : conditions.list())
      condition->review(at, review);
    if (conditions.has_dirichlet())
      scene.nitsche.review(scene.material,
                           counts.points > 0 && counts.fixed == counts.points,
                           review);
    return review.warnings;
  }


  MORULA_INSTANTIATE(scene_warnings);
} // namespace Morula
