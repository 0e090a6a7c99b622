// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/instantiate.h>
#include <morula/base/review.h>
#include <morula/scene/seeded_tissue.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

// What a scene applies to its surface at t = 0, and warnings of what is unwise
// in it.

namespace Morula
{
  template <int dim>
  LoadedPoints<dim>
  loaded_at_start(const TissueModel<dim>    &model,
                  const SurfacePatches<dim> &surface,
                  std::vector<std::size_t>  *patches)
  {
    // There is no grid yet, so all points are put into one grid cell: its
    // splines add up to 1 at any place, and so the force on each point is
    // right. Nothing has moved, so that the present position and area are the
    // initial ones.
    LoadedPoints<dim> loaded;
    for (std::size_t i = 0; i < surface.positions.size(); ++i)
      {
        const Point<dim>     &X = surface.positions[i];
        const Tensor<1, dim> &N = surface.normals[i];
        if (model.boundary_conditions.condition(X, N) !=
            SurfaceCondition::loaded)
          continue;
        const double a = surface.areas[i];
        loaded.points.push_back({X, X, N, X, a, a * N});
        if (patches != nullptr)
          patches->push_back(i);
      }
    const unsigned int n = loaded.points.size();
    loaded.offsets       = {0, n};
    Point<dim> middle;
    for (unsigned int d = 0; d < dim; ++d)
      middle[d] = 0.5;
    loaded.xi.assign(n, middle);
    loaded.h = model.scene.grid.spacing;
    return loaded;
  }


  template <int dim>
  std::optional<std::vector<Tensor<1, dim>>>
  forces_at_start(const BoundaryCondition<dim> &condition,
                  const LoadedPoints<dim>      &loaded,
                  const double                  t)
  {
    std::optional<std::vector<Tensor<1, dim>>> result;
    if (condition.only_pushes() || condition.kind() != SurfaceCondition::loaded)
      return result;
    for (const auto &part : condition.parts(loaded, t))
      {
        if (!result)
          result.emplace(loaded.points.size());
        const auto list = part.term->forces(0, LocalField<dim>{});
        for (std::size_t l = 0; l < list.size(); ++l)
          (*result)[l] += list[l];
      }
    return result;
  }


  namespace
  {
    /** What a condition acts on at t = 0, over all ranks. */
    template <int dim>
    struct AppliedCondition
    {
      /** Name of the condition in the catalogue. */
      std::string name;
      /** Boundary points on which it acts, those excepted on which another one
       *  wins, and their area, µm^(dim-1). */
      std::uint64_t points = 0;
      double        area   = 0.;
      /** Those that its expression chooses, also where another one wins. */
      std::uint64_t chosen = 0;
      /** Corners of the box around these points, µm. */
      Point<dim> lower, upper;
      /** If its size is known before the run: sum of its forces at the end of
       * the run on the surface of t = 0, and of their magnitudes, kPa
       * µm^(dim-1). */
      Tensor<1, dim> force;
      double         magnitude = 0.;

      AppliedCondition()
      {
        // The box begins empty, so that any point enlarges it, also over ranks.
        for (unsigned int d = 0; d < dim; ++d)
          {
            lower[d] = std::numeric_limits<double>::max();
            upper[d] = -lower[d];
          }
      }

      /** Adds a point of this rank. */
      void
      add(const Point<dim> &X, const double patch)
      {
        ++points;
        area += patch;
        for (unsigned int d = 0; d < dim; ++d)
          {
            lower[d] = std::min(lower[d], X[d]);
            upper[d] = std::max(upper[d], X[d]);
          }
      }

      /** Takes the sums and the box of all ranks. Collective. */
      void
      gather(const MPI_Comm comm)
      {
        points    = Utilities::MPI::sum(points, comm);
        chosen    = Utilities::MPI::sum(chosen, comm);
        area      = Utilities::MPI::sum(area, comm);
        magnitude = Utilities::MPI::sum(magnitude, comm);
        for (unsigned int d = 0; d < dim; ++d)
          {
            lower[d] = Utilities::MPI::min(lower[d], comm);
            upper[d] = Utilities::MPI::max(upper[d], comm);
            force[d] = Utilities::MPI::sum(force[d], comm);
          }
      }
    };

  } // namespace


  template <int dim>
  std::string
  vector_text(const Tensor<1, dim> &v, const double zero)
  {
    // Sums that cancel leave rounding: what is below `zero` is printed as 0.
    std::ostringstream text;
    text.precision(4);
    text << '(';
    for (unsigned int d = 0; d < dim; ++d)
      text << (d == 0 ? "" : " ") << (std::abs(v[d]) <= zero ? 0. : v[d]);
    text << ')';
    return text.str();
  }


  std::string
  method_text(const Scene &scene)
  {
    std::string but;
    for (const AnyKey *key : scene.list())
      if (!key->texts_by_method().empty() && !key->is_default())
        but += (but.empty() ? ", but for " : ", ") + key->path() + " = " +
               key->text();
    return scene.method.value() + but;
  }

  std::string
  material_text(const Scene &scene)
  {
    const MaterialParameters &material = scene.material;
    return material.law.value() + ", E = " + material.youngs_modulus.text() +
           " kPa, nu = " + material.poissons_ratio.text() +
           (scene.dimension == 2 ? " (plane strain)" : "") + ", energy per " +
           material.energy_per.value() + ", volumetric strain " +
           material.volumetric_strain.value();
  }


  namespace
  {
    /** What the conditions on the surface act on. Collective. */
    template <int dim>
    std::vector<AppliedCondition<dim>>
    applied_conditions(const TissueModel<dim>    &model,
                       const SurfacePatches<dim> &surface,
                       const MPI_Comm             comm)
    {
      // Held points and loaded ones are looked at apart: of conditions that
      // hold, one wins at a point; those that load act there together. The
      // forces of a load are those that its own term has in a step in which
      // nothing moves, at the end of the run. Each condition is summed over the
      // points of this rank, then over all ranks, which is collective: all
      // ranks go through the same list.
      const Scene                   &scene      = model.scene;
      const BoundaryConditions<dim> &conditions = model.boundary_conditions;
      const LoadedPoints<dim>        loads  = loaded_at_start(model, surface);
      const auto                    &loaded = loads.points;
      std::vector<AppliedCondition<dim>> list;
      for (unsigned int k = 0; k < conditions.list().size(); ++k)
        {
          const auto &[name, condition] = conditions.list()[k];
          if (condition->only_pushes())
            continue; // Obstacles act where they touch, which is not known yet.
          AppliedCondition<dim> row;
          row.name           = name;
          const bool is_load = condition->kind() == SurfaceCondition::loaded;
          // An expression may have no value at a point of one rank; then all
          // ranks must throw.
          everywhere(comm, [&, &condition = condition]() {
            for (std::size_t i = 0; i < surface.positions.size(); ++i)
              row.chosen +=
                condition->acts_on(surface.positions[i], surface.normals[i]);
            for (std::size_t i = 0; !is_load && i < surface.positions.size();
                 ++i)
              if (conditions.winner(surface.positions[i], surface.normals[i]) ==
                  k)
                row.add(surface.positions[i], surface.areas[i]);
            for (std::size_t l = 0; is_load && l < loaded.size(); ++l)
              if (condition->acts_on(loaded[l].X, loaded[l].N))
                row.add(loaded[l].X, loaded[l].initial_area);
            if (const auto forces =
                  forces_at_start(*condition, loads, scene.time.end_time))
              for (const Tensor<1, dim> &force : *forces)
                {
                  row.force += force;
                  row.magnitude += force.norm();
                }
          });
          row.gather(comm);
          list.push_back(row);
        }
      return list;
    }

    /** E.g. "20 boundary points, 100 um, from (50 -48) to (50 48) um; force (2
     *  0) kPa um at t = 1 day". */
    template <int dim>
    std::string
    text_of(const Scene &scene, const AppliedCondition<dim> &applied)
    {
      // A component of the force counts as zero if it is small beside the sum
      // of magnitudes; a tension has none before the surface moves.
      std::ostringstream text;
      text.precision(4);
      text << applied.points
           << (applied.points == 1 ? " boundary point, " : " boundary points, ")
           << applied.area << (dim == 3 ? " um^2" : " um");
      if (applied.points > 0)
        text << ", from " << vector_text(applied.lower, 0.) << " to "
             << vector_text(applied.upper, 0.) << " um";
      if (applied.chosen > applied.points)
        text << " (" << applied.chosen - applied.points
             << " more belong to a condition that wins there)";
      if (applied.magnitude > 1e-9 * applied.area)
        text << "; force "
             << vector_text(applied.force, 1e-9 * applied.magnitude)
             << (dim == 3 ? " kPa um^2" : " kPa um") << " in sum, "
             << applied.magnitude
             << " in magnitudes, at t = " << scene.time.end_time
             << " day on the surface of t = 0";
      return text.str();
    }

    /** With fewer patches a condition's area is not known to a tenth. */
    constexpr std::uint64_t fewest_points = 10;
  } // namespace


  template <int dim>
  std::vector<std::string>
  describe_conditions(const TissueModel<dim> &model,
                      SeededTissue<dim>      &tissue,
                      const MPI_Comm          comm)
  {
    const Scene &scene = model.scene;
    Review       review;
    for (const auto &one : applied_conditions(model, tissue.surface, comm))
      {
        if (one.points > 0)
          tissue.applied.emplace_back(one.name, text_of(scene, one));
        const auto *const choice =
          find_choice(scene.catalogue.boundary_conditions, one.name);
        const AnyKey *const where =
          choice == nullptr ? nullptr : choice->keys().facts().switch_key;
        if (where == nullptr)
          continue;
        if (one.points > 0 && one.points < fewest_points)
          review.warn(where->path(),
                      where->text(),
                      "it acts on " + std::to_string(one.points) +
                        " boundary points, whose area is " + as_text(one.area) +
                        (dim == 3 ? " um^2" : " um") +
                        ": with so few, what it covers jumps by a whole "
                        "patch, and so does its force.",
                      "Choose a larger place, or a smaller Tissue/Cell "
                      "spacing.");
        if (one.points == 0 && one.chosen > 0)
          review.warn(where->path(),
                      where->text(),
                      "it acts nowhere: at all " + std::to_string(one.chosen) +
                        " boundary points that it chooses another condition "
                        "wins (fixed over slip, slip over loads).",
                      "Choose places that differ.");
      }
    return review.warnings;
  }


  MORULA_INSTANTIATE(loaded_at_start);
  MORULA_INSTANTIATE(forces_at_start);
  MORULA_INSTANTIATE(describe_conditions);
  template std::string
  vector_text(const Tensor<1, 2> &, const double);
  template std::string
  vector_text(const Tensor<1, 3> &, const double);
} // namespace Morula
