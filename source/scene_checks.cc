// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/expression.h>
#include <morula/input_error.h>
#include <morula/output/agreement.h>
#include <morula/scene_checks.h>
#include <morula/scene_size.h>
#include <morula/unit_vector.h>

#include <deal.II/base/mpi.h>

#include <cmath>
#include <optional>
#include <sstream>

namespace Morula
{
  namespace
  {
    template <int dim>
    void
    require_positive(const Expression &expression, const Point<dim> &X)
    {
      const double value = expression.value(X, 0.);
      if (value > 0.)
        return;
      std::ostringstream place;
      place << "It is " << value << " at (" << X
            << ") um. Make it positive all over the tissue.";
      throw InputError(expression.key(),
                       expression.text(),
                       "a value > 0",
                       place.str());
    }

    template <int dim>
    void
    check_founders(const Scene &scene, const std::vector<Point<dim>> &founders)
    {
      const Expression stiffness("Material/Young's modulus",
                                 scene.material.youngs_modulus);
      const Expression force("Body force/Force density",
                             scene.body_force.force_density,
                             3,
                             dim);
      const auto       law = growth_law_of<dim>(scene);
      for (const Point<dim> &X : founders)
        {
          require_positive(stiffness, X);
          for (const double t : {0., scene.time.end_time})
            {
              force.vector(X, t);
              if (law)
                law->expected_volume_ratio(X, t);
            }
        }
      if (scene.has_proliferation())
        CellCycle<dim>(scene.cell_cycle,
                       scene.random_seed,
                       1e-9 * scene.time.step)
          .check(founders, scene.time.step);
    }

    /**
     * One condition: where it holds, and the functions that must then be
     * finite.
     */
    template <int dim>
    class Condition
    {
    public:
      Condition(const std::string &key, const std::string &where)
        : key("Boundary conditions/" + key)
        , where_text(where)
      {
        if (!where.empty())
          where_holds.emplace(this->key, where);
      }

      /** Whether the condition holds at @p X. */
      bool
      holds(const Point<dim> &X) const
      {
        return where_holds && where_holds->value(X, 0.) > 0.;
      }

      /** Number of points on all ranks; refuses none. Collective. */
      types::particle_index
      total(const types::particle_index n, const MPI_Comm comm) const
      {
        const types::particle_index sum = Utilities::MPI::sum(n, comm);
        if (where_holds && sum == 0)
          throw InputError(key,
                           where_text,
                           "a condition that holds at some boundary point",
                           "It is positive at none: correct it, or leave it "
                           "empty. Boundary points sit at centers of surface "
                           "patches, not on edges or corners.");
        return sum;
      }

    private:
      const std::string         key;
      const std::string         where_text;
      std::optional<Expression> where_holds;
    };
  } // namespace


  template <int dim>
  void
  check_at_cells(const Scene                   &scene,
                 const std::vector<Point<dim>> &founders,
                 const MPI_Comm                 comm)
  {
    everywhere(comm, [&] { check_founders(scene, founders); });
    check_memory(scene, expected_size(scene, founders, comm), comm);
  }


  template <int dim>
  ConditionCounts
  check_at_surface(const Scene               &scene,
                   const SurfacePatches<dim> &surface,
                   const MPI_Comm             comm)
  {
    const BoundaryConditionParameters &given   = scene.boundary_conditions;
    const std::string                  section = "Boundary conditions/";
    const Condition<dim>               fixed("Fixed where", given.fixed_where);
    const Condition<dim>               slip("Slip where", given.slip_where);
    const Condition<dim> traction("Traction where", given.traction_where);
    const Condition<dim> pressure("Pressure where", given.pressure_where);
    const Expression     stiffness("Material/Young's modulus",
                               scene.material.youngs_modulus);
    const Expression     displacement(section + "Displacement",
                                  given.displacement,
                                  3,
                                  dim);
    const Expression     force(section + "Traction", given.traction, 3, dim);
    const Expression     push(section + "Pressure", given.pressure);
    const bool           any_normal = given.slip_normal.empty();
    const Tensor<1, dim> normal =
      any_normal ? Tensor<1, dim>() :
                   unit_vector<dim>(section + "Slip normal", given.slip_normal);

    ConditionCounts mine;
    everywhere(comm, [&] {
      for (unsigned int i = 0; i < surface.positions.size(); ++i)
        {
          const Point<dim> &X        = surface.positions[i];
          const bool        is_fixed = fixed.holds(X);
          const bool        slips =
            slip.holds(X) &&
            (any_normal || std::abs(surface.normals[i] * normal) > 0.9);
          const bool is_pulled  = traction.holds(X);
          const bool is_pressed = pressure.holds(X);
          if (is_fixed || slips)
            require_positive(stiffness, X);
          for (const double t : {0., scene.time.end_time})
            {
              if (is_fixed)
                displacement.vector(X, t);
              if (is_pulled)
                force.vector(X, t);
              if (is_pressed)
                push.value(X, t);
            }
          mine.fixed += is_fixed;
          mine.slip += slips;
          mine.traction += is_pulled;
          mine.pressure += is_pressed;
        }
    });

    ConditionCounts all;
    all.points = Utilities::MPI::sum(
      static_cast<types::particle_index>(surface.positions.size()), comm);
    all.fixed    = fixed.total(mine.fixed, comm);
    all.slip     = slip.total(mine.slip, comm);
    all.traction = traction.total(mine.traction, comm);
    all.pressure = pressure.total(mine.pressure, comm);
    return all;
  }


  template void
  check_at_cells(const Scene &, const std::vector<Point<2>> &, const MPI_Comm);
  template void
  check_at_cells(const Scene &, const std::vector<Point<3>> &, const MPI_Comm);
  template ConditionCounts
  check_at_surface(const Scene &, const SurfacePatches<2> &, const MPI_Comm);
  template ConditionCounts
  check_at_surface(const Scene &, const SurfacePatches<3> &, const MPI_Comm);
} // namespace Morula
