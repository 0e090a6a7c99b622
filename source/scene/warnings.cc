// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/scene/reviews.h>
#include <morula/scene/warnings.h>
#include <morula/seeding/pieces_at_start.h>
#include <morula/seeding/reviews.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <numeric>

namespace Morula
{
  namespace
  {
    /** Warns of a method that changes nothing, because the scene itself sets
     * all keys that it stands for, to other values. A file made of the output
     * of
     *  --parameters does so. */
    void
    review_method(const Scene &scene, Review &review)
    {
      // One key that the scene does not set, or sets to the method's value,
      // gives the method a meaning.
      const std::string method = scene.method;
      std::string       paths;
      for (const AnyKey *key : scene.list())
        {
          const auto text = key->texts_by_method().find(method);
          if (text == key->texts_by_method().end())
            continue;
          if (!review.has_set(*key) ||
              same_value(scene.as_written.at(key->path()), text->second))
            return;
          paths += (paths.empty() ? "" : ", ") + key->path();
        }
      if (!paths.empty())
        review.warn(scene.method.path(),
                    method,
                    "it changes nothing, as the scene itself sets all that it "
                    "stands for: " +
                      paths + ".",
                    "Remove these keys, or this one.");
    }

    /** Whether some surface is pulled or pressed. */
    template <int dim>
    bool
    has_loads(const BoundaryConditions<dim> &conditions,
              const ConditionCounts         &counts)
    {
      return std::any_of(conditions.list().begin(),
                         conditions.list().end(),
                         [&counts](const auto &named) {
                           return named.condition->kind() ==
                                    SurfaceCondition::loaded &&
                                  counts.acting.at(named.name) > 0;
                         });
    }
  } // namespace


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
    at.is_loaded = has_loads(conditions, counts) || !model.forces.empty();
    at.volumes   = founders.volumes;
    at.types     = types_of<dim>(model, founders.positions, founders.types);
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
    review_rates(model, founders, surface, comm, review);
    for (const EffectKeys *const keys : scene.keys_in_use())
      keys->check(scene, review);
    for (const auto &[name, equation] : model.equations)
      equation->review(at, review);
    review_idle_effects(scene, review);
    review_types(scene.cell_types, at, !founders.types.empty(), review);
    review_steps(scene, founders, surface, comm, review);
    scene.material.review(review);
    for (const auto &[name, condition] : conditions.list())
      condition->review(at, review);
    if (conditions.has_dirichlet())
      scene.nitsche.review(scene.material,
                           counts.points > 0 && counts.fixed == counts.points,
                           review);
    review_method(scene, review);
    return review.warnings;
  }


  MORULA_INSTANTIATE(scene_warnings);
} // namespace Morula
