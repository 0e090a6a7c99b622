// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/review.h>
#include <morula/scene/applied.h>

#include <deal.II/base/mpi.h>

#include <limits>
#include <sstream>

namespace Morula
{
  namespace
  {
    /** The boundary points of this rank that conditions load at t = 0. There is
     *  no grid yet, so all are put into one grid cell: its splines add up to 1
     *  at any place, and so the sum of the forces is right. @p numbers gets
     *  their numbers in @p surface. */
    template <int dim>
    LoadedPoints<dim>
    loaded_at_start(const Scene                   &scene,
                    const BoundaryConditions<dim> &conditions,
                    const SurfacePatches<dim>     &surface,
                    std::vector<std::size_t>      &numbers)
    {
      LoadedPoints<dim> loaded;
      for (std::size_t i = 0; i < surface.positions.size(); ++i)
        {
          const Point<dim>     &X = surface.positions[i];
          const Tensor<1, dim> &N = surface.normals[i];
          if (conditions.condition(X, N) != SurfaceCondition::loaded)
            continue;
          const double a = surface.areas[i];
          // Nothing has moved, so the present position and area are the initial
          // ones.
          loaded.points.push_back({X, X, N, X, a, a * N});
          numbers.push_back(i);
        }
      const unsigned int n = loaded.points.size();
      Point<dim>         middle;
      for (unsigned int d = 0; d < dim; ++d)
        middle[d] = 0.5;
      loaded.offsets = {0, n};
      loaded.xi.assign(n, middle);
      loaded.h = scene.grid.spacing;
      return loaded;
    }

    /** A row to which points are added, on this rank. */
    class Sums
    {
    public:
      explicit Sums(const std::string &name)
      {
        row.name = name;
        for (unsigned int d = 0; d < 3; ++d)
          {
            // The box begins empty, so that any point enlarges it, also over
            // ranks.
            row.lower[d] = std::numeric_limits<double>::max();
            row.upper[d] = -row.lower[d];
          }
      }

      template <int dim>
      void
      add(const Point<dim> &X, const double area)
      {
        ++row.points;
        row.area += area;
        for (unsigned int d = 0; d < 3; ++d)
          {
            // The index is valid in 2-D as well, where the third component is
            // 0.
            const double x =
              d < dim ? X[std::min<unsigned int>(d, dim - 1)] : 0.;
            row.lower[d] = std::min(row.lower[d], x);
            row.upper[d] = std::max(row.upper[d], x);
          }
      }

      template <int dim>
      void
      add_force(const Tensor<1, dim> &force)
      {
        for (unsigned int d = 0; d < dim; ++d)
          row.force[d] += force[d];
        row.magnitude += force.norm();
      }

      /** The sums and the box of all ranks. Collective. */
      AppliedCondition
      over_all_ranks(const MPI_Comm comm) const
      {
        AppliedCondition all = row;
        all.points           = Utilities::MPI::sum(row.points, comm);
        all.area             = Utilities::MPI::sum(row.area, comm);
        all.magnitude        = Utilities::MPI::sum(row.magnitude, comm);
        for (unsigned int d = 0; d < 3; ++d)
          {
            all.lower[d] = Utilities::MPI::min(row.lower[d], comm);
            all.upper[d] = Utilities::MPI::max(row.upper[d], comm);
            all.force[d] = Utilities::MPI::sum(row.force[d], comm);
          }
        return all;
      }

      AppliedCondition row;
    };

    std::string
    vector_text(const Scene &scene, const Tensor<1, 3> &v, const double zero)
    {
      // Sums that cancel leave rounding: what is below `zero` is printed as 0.
      std::ostringstream text;
      text.precision(4);
      text << '(';
      for (unsigned int d = 0; d < scene.dimension; ++d)
        text << (d == 0 ? "" : " ") << (std::abs(v[d]) <= zero ? 0. : v[d]);
      text << ')';
      return text.str();
    }
  } // namespace


  template <int dim>
  std::vector<AppliedCondition>
  applied_conditions(const Scene               &scene,
                     const SurfacePatches<dim> &surface,
                     const MPI_Comm             comm)
  {
    // Held points and loaded ones are looked at apart: of conditions that hold,
    // one wins at a point; those that load act there together. The forces of a
    // load are those that its own term has in a step in which nothing moves, at
    // the end of the run. Each condition is summed over the points of this
    // rank, then over all ranks, which is collective: all ranks go through the
    // same list.
    const BoundaryConditions<dim> conditions =
      boundary_conditions_of<dim>(scene);
    std::vector<std::size_t> numbers;
    const LoadedPoints<dim>  loaded =
      loaded_at_start(scene, conditions, surface, numbers);
    std::vector<AppliedCondition> list;
    for (unsigned int k = 0; k < conditions.list().size(); ++k)
      {
        const auto &[name, condition] = conditions.list()[k];
        if (condition->only_pushes())
          continue; // Obstacles act where they touch, which is not known yet.
        Sums       sums(name);
        const bool loads = condition->kind() == SurfaceCondition::loaded;
        // An expression may have no value at a point of one rank; then all
        // ranks must throw.
        everywhere(comm, [&, &condition = condition]() {
          for (std::size_t i = 0; !loads && i < surface.positions.size(); ++i)
            if (conditions.winner(surface.positions[i], surface.normals[i]) ==
                k)
              sums.add(surface.positions[i], surface.areas[i]);
          for (std::size_t l = 0; loads && l < numbers.size(); ++l)
            if (condition->acts_on(loaded.points[l].X, loaded.points[l].N))
              sums.add(loaded.points[l].X, loaded.points[l].initial_area);
          if (!loads)
            return;
          for (const auto &part : condition->parts(loaded, scene.time.end_time))
            {
              sums.row.has_force = true;
              for (const Tensor<1, dim> &force :
                   part.term->forces(0, LocalField<dim>{}))
                sums.add_force(force);
            }
        });
        list.push_back(sums.over_all_ranks(comm));
      }
    return list;
  }


  std::string
  text_of(const Scene &scene, const AppliedCondition &applied)
  {
    // A component of the force counts as zero if it is small beside the sum of
    // magnitudes.
    const bool         space = scene.dimension == 3;
    std::ostringstream text;
    text.precision(4);
    text << applied.points
         << (applied.points == 1 ? " boundary point, " : " boundary points, ")
         << applied.area << (space ? " um^2" : " um");
    if (applied.points > 0)
      text << ", from " << vector_text(scene, applied.lower, 0.) << " to "
           << vector_text(scene, applied.upper, 0.) << " um";
    if (applied.has_force)
      text << "; force "
           << vector_text(scene, applied.force, 1e-9 * applied.magnitude)
           << (space ? " kPa um^2" : " kPa um") << " in sum, "
           << applied.magnitude
           << " in magnitudes, at t = " << scene.time.end_time
           << " day on the surface of t = 0";
    return text.str();
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


  std::vector<std::string>
  applied_texts(const Scene                         &scene,
                const std::vector<AppliedCondition> &applied)
  {
    std::vector<std::string> texts = {"Material: " + material_text(scene)};
    for (const AppliedCondition &one : applied)
      if (one.points > 0)
        texts.push_back("Applied: " + one.name + " at " + text_of(scene, one));
    return texts;
  }


  template std::vector<AppliedCondition>
  applied_conditions(const Scene &, const SurfacePatches<2> &, const MPI_Comm);
  template std::vector<AppliedCondition>
  applied_conditions(const Scene &, const SurfacePatches<3> &, const MPI_Comm);
} // namespace Morula
