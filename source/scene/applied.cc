// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/instantiate.h>
#include <morula/base/review.h>
#include <morula/scene/applied.h>
#include <morula/scene/loads_at_start.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace Morula
{
  namespace
  {
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
        all.chosen           = Utilities::MPI::sum(row.chosen, comm);
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

    /** Whether a load is zero at the ends of all steps, or of many of them
     *  where there are more. Collective. */
    template <int dim>
    bool
    is_idle(const Scene                  &scene,
            const LoadsAtStart<dim>      &loads,
            const BoundaryCondition<dim> &condition,
            const MPI_Comm                comm)
    {
      constexpr double most_times = 200.;
      const double     end = scene.time.end_time, step = scene.time.step;
      const double     n   = std::ceil(end / step - 1e-9);
      double           sum = 0.;
      for (double i = 1.; i <= n; i += std::max(1., std::floor(n / most_times)))
        everywhere(comm, [&]() {
          if (const auto forces =
                loads.forces(condition, std::min(i * step, end)))
            for (const Tensor<1, dim> &force : *forces)
              sum += force.norm();
        });
      return Utilities::MPI::sum(sum, comm) == 0.;
    }
  } // namespace


  template <int dim>
  std::vector<AppliedCondition>
  applied_conditions(const TissueModel<dim>    &model,
                     const SurfacePatches<dim> &surface,
                     const MPI_Comm             comm)
  {
    // Held points and loaded ones are looked at apart: of conditions that hold,
    // one wins at a point; those that load act there together. The forces of a
    // load are those that its own term has in a step in which nothing moves, at
    // the end of the run. Each condition is summed over the points of this
    // rank, then over all ranks, which is collective: all ranks go through the
    // same list.
    const Scene                   &scene      = model.scene;
    const BoundaryConditions<dim> &conditions = model.boundary_conditions;
    const LoadsAtStart<dim>        loads(scene, conditions, surface);
    const auto                    &loaded = loads.points().points;
    std::vector<AppliedCondition>  list;
    for (unsigned int k = 0; k < conditions.list().size(); ++k)
      {
        const auto &[name, condition] = conditions.list()[k];
        if (condition->only_pushes())
          continue; // Obstacles act where they touch, which is not known yet.
        Sums       sums(name);
        const bool is_load = condition->kind() == SurfaceCondition::loaded;
        // An expression may have no value at a point of one rank; then all
        // ranks must throw.
        everywhere(comm, [&, &condition = condition]() {
          for (std::size_t i = 0; i < surface.positions.size(); ++i)
            sums.row.chosen +=
              condition->acts_on(surface.positions[i], surface.normals[i]);
          for (std::size_t i = 0; !is_load && i < surface.positions.size(); ++i)
            if (conditions.winner(surface.positions[i], surface.normals[i]) ==
                k)
              sums.add(surface.positions[i], surface.areas[i]);
          for (std::size_t l = 0; is_load && l < loaded.size(); ++l)
            if (condition->acts_on(loaded[l].X, loaded[l].N))
              sums.add(loaded[l].X, loaded[l].initial_area);
          if (const auto forces = loads.forces(*condition, scene.time.end_time))
            {
              sums.row.has_force = true;
              for (const Tensor<1, dim> &force : *forces)
                sums.add_force(force);
            }
        });
        list.push_back(sums.over_all_ranks(comm));
        list.back().is_tension = condition->is_tension();
        if (sums.row.has_force && list.back().magnitude == 0.)
          list.back().is_idle = is_idle(scene, loads, *condition, comm);
      }
    return list;
  }


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
    if (applied.chosen > applied.points)
      text << " (" << applied.chosen - applied.points
           << " more belong to a condition that wins there)";
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


  MORULA_INSTANTIATE(applied_conditions);
} // namespace Morula
