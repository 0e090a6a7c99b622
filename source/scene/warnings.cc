// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/instantiate.h>
#include <morula/scene/checks.h>
#include <morula/scene/seeded_tissue.h>
#include <morula/seeding/pieces_at_start.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace Morula
{
  namespace
  {
    /** A value may leave the range of the two ends of its step by this part of
     *  its range in time. A wave does so from 3.4 steps a period on. */
    constexpr double most_outside = 0.2;

    /** So often an expression is evaluated at a place, about. */
    constexpr double most_samples = 2e4;

    /** Places of this rank at which an expression is looked at. */
    constexpr std::size_t most_places = 4;

    /** The values of all variables at a place: 1 for what only the run knows,
     *  so that a factor that depends on time is seen. */
    template <int dim>
    VariableValues
    values_at(const Point<dim> &X, const Expression &expression)
    {
      VariableValues values;
      values.fill(1.);
      // No cell is of this type: what types have instead are keys of their own.
      if (!expression.types().empty())
        values[static_cast<unsigned int>(Variable::type)] = 1e6;
      values[static_cast<unsigned int>(Variable::Z)] = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        {
          values[static_cast<unsigned int>(Variable::X) + d] = X[d];
          values[static_cast<unsigned int>(Variable::x) + d] = X[d];
        }
      return values;
    }

    /** By how much of its range in time a component leaves, at one place, the
     *  range of its values at the ends of a step, at most, and the begin of
     * that step, day. @throws InputError where it has no value */
    std::pair<double, double>
    excursion(const Expression  &expression,
              const unsigned int component,
              VariableValues     values,
              const double       step,
              const double       end_time)
    {
      // Each step is cut into equal parts, the more the fewer steps there are.
      // First all values are found, as the range in time decides what counts.
      const auto n_steps = static_cast<std::size_t>(
        std::min(std::ceil(end_time / step - 1e-9), most_samples / 8.));
      const std::size_t parts = std::clamp<std::size_t>(
        static_cast<std::size_t>(most_samples / (n_steps + 1)), 8, 64);
      std::vector<double> all;
      for (std::size_t i = 0; i <= n_steps * parts; ++i)
        {
          values[static_cast<unsigned int>(Variable::t)] =
            std::min(step * i / parts, end_time);
          all.push_back(expression.value(values, component));
        }
      const auto [least, most] = std::minmax_element(all.begin(), all.end());
      const double              range = *most - *least;
      std::pair<double, double> worst{};
      if (range > 1e-9 * std::max(std::abs(*most), std::abs(*least)))
        for (std::size_t n = 0; n < n_steps; ++n)
          {
            const auto from = all.begin() + n * parts, to = from + parts;
            const auto [low, high] = std::minmax_element(from, to);
            worst                  = std::max(worst,
                                              {std::max(*high - std::max(*from, *to),
                                       std::min(*from, *to) - *low) /
                                                 range,
                                               step * n});
          }
      return worst;
    }

    /** The expressions of keys, those of types as well, that are evaluated in
     *  the run and depend on time, and how many components of each count. */
    std::vector<std::pair<Expression, unsigned int>>
    of_time(const Scene &scene)
    {
      std::vector<std::pair<Expression, unsigned int>> list;
      for (const AnyKey *any : scene.list())
        if (const auto *const key = dynamic_cast<const ExpressionKey *>(any);
            key != nullptr && !key->empty() &&
            key->evaluated() != Evaluated::founder && key->is_changed())
          try
            {
              const Expression &expression = key->expression(scene.dimension);
              if (expression.depends_on_time())
                list.emplace_back(expression,
                                  std::min(key->components(),
                                           scene.dimension.value()));
            }
          catch (const std::exception &)
            {} // a word, such as a direction
      return list;
    }

    /** Warns of expressions of t which between two ends of steps leave the
     * range of their values there, as pulses and waves faster than the steps
     * do: the run does not see it. Collective. */
    template <int dim>
    void
    review_steps(const Scene               &scene,
                 const Founders<dim>       &founders,
                 const SurfacePatches<dim> &surface,
                 const MPI_Comm             comm,
                 Review                    &review)
    {
      // A few founders and boundary points of each rank stand for all places.
      // The worst of all ranks counts, so that all print the same. Expressions
      // that have no value somewhere are refused elsewhere.
      std::vector<Point<dim>> places;
      for (const auto *points : {&founders.positions, &surface.positions})
        for (std::size_t i = 0; i < points->size();
             i += std::max<std::size_t>(1, points->size() / most_places))
          places.push_back((*points)[i]);
      for (const auto &[expression, n_components] : of_time(scene))
        {
          std::pair<double, double> worst{};
          for (const Point<dim> &X : places)
            for (unsigned int c = 0; c < n_components; ++c)
              try
                {
                  worst = std::max(worst,
                                   excursion(expression,
                                             c,
                                             values_at(X, expression),
                                             scene.time.step,
                                             scene.time.end_time));
                }
              catch (const std::exception &)
                {}
          // Ranks have different places: that with the largest excursion
          // counts.
          for (const auto &other : Utilities::MPI::all_gather(comm, worst))
            worst = std::max(worst, other);
          if (worst.first > most_outside)
            review.warn(expression.key(),
                        expression.text(),
                        "it changes within the step that begins on day " +
                          as_text(worst.second) +
                          ": the run sees its values at the ends of steps.",
                        "Let steps end where it changes, and take at least ten "
                        "for a period.");
        }
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
    review_steps(scene, founders, surface, comm, review);
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
