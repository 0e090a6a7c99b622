// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/expression.h>
#include <morula/base/input_error.h>
#include <morula/base/unit_vector.h>
#include <morula/scene/checks.h>
#include <morula/scene/size.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/symmetric_tensor.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

namespace Morula
{
  namespace
  {
    template <int dim>
    void
    require_stiffness(const Expression &expression, const Point<dim> &X)
    {
      const double value = expression.value(X, 0.);
      if (value > 0.)
        return;
      std::ostringstream place;
      place << "It is " << value << " kPa at (" << X
            << ") um. Make it positive all over the tissue.";
      throw InputError(expression.key(),
                       expression.text(),
                       "a value > 0 kPa",
                       place.str());
    }

    /** Asks a growth law and a division rule, which may be the user's own, for
     *  what the first step will ask them. */
    template <int dim>
    void
    try_effects(const GrowthLaw<dim>    *law,
                const DivisionRule<dim> *rule,
                const Point<dim>        &X,
                const double             first_step)
    {
      const Tensor<2, dim> identity(unit_symmetric_tensor<dim>());
      Tensor<1, dim>       axis;
      axis[0] = 1.;
      if (law != nullptr)
        law->growth({X, identity, identity}, 0., first_step);
      if (rule != nullptr)
        rule->axis({X, identity, axis});
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
      const auto       law    = growth_law_of<dim>(scene);
      const auto       rule   = division_rule_of<dim>(scene);
      const double first_step = std::min(scene.time.step, scene.time.end_time);
      for (const Point<dim> &X : founders)
        {
          require_stiffness(stiffness, X);
          for (const double t : {0., scene.time.end_time})
            {
              force.vector(X, t);
              if (law)
                law->expected_volume_ratio(X, t);
            }
          try_effects(law.get(), rule.get(), X, first_step);
        }
      if (scene.has_proliferation())
        CellCycle<dim>(scene.cell_cycle,
                       scene.random_seed,
                       1e-9 * scene.time.step)
          .check(founders, scene.time.step);
    }

    /** Number of founders, over all ranks, that proliferate. Refuses a cell
     *  cycle of nobody. */
    template <int dim>
    types::particle_index
    count_proliferating(const Scene                   &scene,
                        const std::vector<Point<dim>> &founders,
                        const MPI_Comm                 comm)
    {
      if (!scene.has_proliferation())
        return 0;
      const Expression      where("Proliferation/Cell cycle/Where",
                             scene.cell_cycle.where);
      types::particle_index n = 0;
      for (const Point<dim> &X : founders)
        n += where.value(X, 0.) > 0.;
      n = Utilities::MPI::sum(n, comm);
      if (n == 0)
        throw InputError(where.key(),
                         where.text(),
                         "a condition that holds at some founder",
                         "It is positive at none: correct it, or set "
                         "Proliferation/Law = none. Founders sit at centers of "
                         "cells, inside of the tissue.");
      return n;
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

      /** @param n points of this rank where it holds. Collective. */
      void
      refuse_nowhere(const types::particle_index n, const MPI_Comm comm) const
      {
        const types::particle_index sum = Utilities::MPI::sum(n, comm);
        if (where_holds && sum == 0)
          throw InputError(key,
                           where_text,
                           "a condition that holds at some boundary point",
                           "It is positive at none: correct it, or leave it "
                           "empty. Boundary points sit at centers of surface "
                           "patches, not on edges or corners.");
      }

    private:
      const std::string         key;
      const std::string         where_text;
      std::optional<Expression> where_holds;
    };
  } // namespace


  template <int dim>
  types::particle_index
  check_at_cells(const Scene                   &scene,
                 const std::vector<Point<dim>> &founders,
                 const MPI_Comm                 comm)
  {
    everywhere(comm, [&] { check_founders(scene, founders); });
    const types::particle_index n_proliferating =
      count_proliferating(scene, founders, comm);
    check_memory(scene, expected_size(scene, founders, comm), comm);
    return n_proliferating;
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

    ConditionCounts holding, acting;
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
            require_stiffness(stiffness, X);
          for (const double t : {0., scene.time.end_time})
            {
              if (is_fixed)
                displacement.vector(X, t);
              if (is_pulled)
                force.vector(X, t);
              if (is_pressed)
                push.value(X, t);
            }
          holding.fixed += is_fixed;
          holding.slip += slips;
          holding.traction += is_pulled;
          holding.pressure += is_pressed;

          const bool is_free = !is_fixed && !slips;
          acting.fixed += is_fixed;
          acting.slip += slips && !is_fixed;
          acting.traction += is_pulled && is_free;
          acting.pressure += is_pressed && is_free;
        }
    });
    fixed.refuse_nowhere(holding.fixed, comm);
    slip.refuse_nowhere(holding.slip, comm);
    traction.refuse_nowhere(holding.traction, comm);
    pressure.refuse_nowhere(holding.pressure, comm);

    acting.points = surface.positions.size();
    for (types::particle_index *n : {&acting.points,
                                     &acting.fixed,
                                     &acting.slip,
                                     &acting.traction,
                                     &acting.pressure})
      *n = Utilities::MPI::sum(*n, comm);
    return acting;
  }


  template types::particle_index
  check_at_cells(const Scene &, const std::vector<Point<2>> &, const MPI_Comm);
  template types::particle_index
  check_at_cells(const Scene &, const std::vector<Point<3>> &, const MPI_Comm);
  template ConditionCounts
  check_at_surface(const Scene &, const SurfacePatches<2> &, const MPI_Comm);
  template ConditionCounts
  check_at_surface(const Scene &, const SurfacePatches<3> &, const MPI_Comm);
} // namespace Morula
