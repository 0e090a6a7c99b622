// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/effects/surface/boundary_terms.h>
#include <morula/simulation/step_equilibrium.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/mpi.templates.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace Morula
{
  namespace
  {
    /** The vector with 0 for the third direction in 2-D, so that moments have
     * one form. */
    template <int dim>
    Tensor<1, 3>
    in_space(const Tensor<1, dim> &v)
    {
      Tensor<1, 3> result;
      for (unsigned int d = 0; d < dim; ++d)
        result[d] = v[d];
      return result;
    }

    /** What ranks add up of a row: points, area, the inward part, force and
     *  moment. */
    using Sums = std::tuple<double, double, double, Tensor<1, 3>, Tensor<1, 3>>;

    /** Coefficients of the splines of a grid cell in the field x, µm: their
     *  centres, doc/theory.md, section 3. */
    template <int dim>
    std::array<Point<dim>, BSpline<dim>::n>
    spline_centers(const SplineSpace<dim> &space, const unsigned int grid_cell)
    {
      const GridIndex<dim> index =
        space.box().index(space.grid_cells()[grid_cell].number);
      std::array<Point<dim>, BSpline<dim>::n> centers;
      for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
        {
          centers[a] = space.box().corner(index);
          for (unsigned int d = 0; d < dim; ++d)
            centers[a][d] +=
              (BSpline<dim>::offset(a, d) + 0.5) * space.box().spacing();
        }
      return centers;
    }

    /**
     * Adds up the forces at the end of a step with this displacement, point by
     * point. They are those of the terms in whose sum Newton's method has found
     * the equilibrium.
     * Keeps references to all that it is given.
     */
    template <int dim>
    class ForceSums
    {
    public:
      /** @param tissue at the beginning of the step, as @p space. Collective.
       */
      ForceSums(const Tissue<dim>         &tissue,
                const SplineSpace<dim>    &space,
                const Equilibrium::Vector &u,
                const MPI_Comm             comm)
        : tissue(tissue)
        , space(space)
        , displacement(space, u, comm)
        , comm(comm)
      {
        mine.of_points.resize(tissue.boundary_points().size());
      }

      /** Adds a row for a force on the cells. Any term will do, as the row is a
       * sum over splines. */
      void
      add_force(const std::string &name, const Term<dim> &term)
      {
        // Minus the residual of a term at a spline is its force on this spline.
        // The splines add up to 1 and reproduce affine fields, so that the
        // forces add up to the resultant, and those at the places that the
        // splines' centres have moved to give the moment about the origin. The
        // loop is over the active grid cells that this rank owns: each cell
        // acts in one of them. The growth is that at t + dt, as in the
        // residual.
        constexpr unsigned int n = BSpline<dim>::n;
        ForceRow               row;
        row.kind   = "force";
        row.name   = name;
        row.points = tissue.cells().size();
        LocalSystem<dim> system(LocalSystem<dim>::energy_and_residual);
        for (unsigned int c = 0; c < space.grid_cells().size(); ++c)
          {
            const LocalField<dim> field   = displacement.on_grid_cell(c);
            const auto            centers = spline_centers(space, c);
            system.clear();
            term.add(c, field, GrowthAt::current, system);
            for (unsigned int a = 0; a < n; ++a)
              {
                Tensor<1, dim> force, place(centers[a]);
                for (unsigned int i = 0; i < dim; ++i)
                  {
                    force[i] = -system.residual[i * n + a];
                    place[i] += field.coefficient[i][a];
                  }
                row.force += in_space(force);
                row.moment +=
                  cross_product_3d(in_space(place), in_space(force));
              }
          }
        mine.rows.push_back(row);
      }

      /** Adds a row for each condition that holds points, with the points at
       * which it wins. */
      void
      add_held(const BoundaryConditions<dim> &conditions, const Term<dim> &term)
      {
        // One term holds all points, also where several conditions ask for it.
        // Each point belongs to the condition that wins at its initial place,
        // and to one row.
        const BoundaryPoints<dim> &store  = tissue.boundary_points();
        const PointGroups          groups = held_groups(tissue, space);
        for (unsigned int k = 0; k < conditions.list().size(); ++k)
          if (is_held(conditions.list()[k].condition->kind()))
            add_row("condition",
                    conditions.list()[k].name,
                    groups,
                    term,
                    1.,
                    [&](const unsigned int p, const Tensor<1, dim> &) {
                      return conditions.winner(store[p].seed_position(),
                                               store[p].initial_normal()) == k;
                    });
      }

      /** Adds rows for the conditions that load the surface, at the end @p t
       * (day) of the step. */
      void
      add_loads(const BoundaryConditions<dim> &conditions,
                const LoadedPoints<dim>       &points,
                const double                   t)
      {
        // The group of all loaded points is that for which the terms are made.
        // A condition may act in several parts, as obstacles do, one row each.
        // An obstacle's row counts only points that touch it, and these are
        // known by their force.
        const BoundaryPoints<dim> &store = tissue.boundary_points();
        const PointGroups          groups =
          group_points(store, space, [&](const unsigned int p) {
            return store.condition(p) == SurfaceCondition::loaded;
          });
        for (const auto &named : conditions.list())
          if (named.condition->kind() == SurfaceCondition::loaded)
            for (const auto &part : named.condition->parts(points, t))
              add_row(part.only_where_it_touches ? "obstacle" : "condition",
                      part.name.empty() ? named.name : part.name,
                      groups,
                      *part.term,
                      1.,
                      [&](const unsigned int p, const Tensor<1, dim> &force) {
                        return part.only_where_it_touches ?
                                 force.norm_square() > 0. :
                                 named.condition->acts_on(
                                   store[p].seed_position(),
                                   store[p].initial_normal());
                      });
      }

      /** Adds a row for a force that an effect has as a whole. */
      void
      add_part(const ForceOnPoints<dim> &force)
      {
        // The term has its points in the order of this group.
        const BoundaryPoints<dim> &store = tissue.boundary_points();
        add_row(force.kind,
                force.name,
                group_points(store,
                             space,
                             [&](const unsigned int p) {
                               return force.acts_on(store[p]);
                             }),
                *force.term,
                force.factor,
                [](const unsigned int, const Tensor<1, dim> &) {
                  return true;
                });
      }

      /** Adds a row of this kind for each two bodies that touch, with the force
       *  of the one with the lower number on the other. set_forces() adds where
       *  they touch. Collective. */
      void
      add_between(const std::string                    &kind,
                  const std::vector<ForceBetween<dim>> &forces)
      {
        // Which bodies touch is known only from the forces of all ranks. All of
        // them make the same rows, also where they have no points in them.
        using Bodies = std::pair<unsigned int, unsigned int>;
        std::set<Bodies>          touching;
        std::vector<unsigned int> numbers;
        for (const ForceBetween<dim> &one : forces)
          if (one.other <= one.body)
            touching.emplace(one.other, one.body);
        for (const Bodies &bodies : touching)
          {
            numbers.push_back(bodies.first);
            numbers.push_back(bodies.second);
          }
        for (const auto &list : Utilities::MPI::all_gather(comm, numbers))
          for (std::size_t k = 0; k < list.size(); k += 2)
            touching.emplace(list[k], list[k + 1]);
        for (const Bodies &bodies : touching)
          {
            ForceRow row;
            row.kind        = kind;
            row.is_internal = true;
            row.name        = "body " + std::to_string(bodies.first) +
                       (bodies.first == bodies.second ?
                          " on itself" :
                          " on body " + std::to_string(bodies.second));
            for (const ForceBetween<dim> &one : forces)
              if (Bodies(one.other, one.body) == bodies)
                {
                  row.force += in_space(one.force);
                  row.moment +=
                    cross_product_3d(in_space(Tensor<1, dim>(one.place)),
                                     in_space(one.force));
                  row.inward += one.normal;
                }
            mine.touching[bodies] = mine.rows.size();
            mine.rows.push_back(row);
          }
        // What all pairs together leave, motions that nothing else holds have
        // borne: doc/theory.md (4.10a). Pairs' forces cancel, and their moments
        // do but for what points of a pair are beside each other.
        ForceRow held;
        held.kind        = "constraint";
        held.name        = kind;
        held.is_internal = true;
        for (const ForceBetween<dim> &one : forces)
          {
            mine.of_points[one.p] += one.force;
            held.force -= in_space(one.force);
            held.moment -= cross_product_3d(in_space(Tensor<1, dim>(one.place)),
                                            in_space(one.force));
          }
        mine.rows.push_back(held);
        mine.between = forces;
      }

      /** The rows as sums over all ranks, and this rank's forces of points.
       *  Collective. */
      SurfaceForces<dim>
      result() const
      {
        // The rows follow from the scene, so that all ranks have the same ones
        // in the same order, also where they have no points. So one reduction
        // adds up all of them. The forces of points stay with the rank that has
        // the points.
        SurfaceForces<dim>  result = mine;
        std::vector<double> sums;
        for (const ForceRow &row : mine.rows)
          append_flat(
            sums,
            Sums(row.points, row.area, row.inward, row.force, row.moment));
        Utilities::MPI::sum(sums, comm, sums);
        for (std::size_t r = 0; r < result.rows.size(); ++r)
          {
            ForceRow &row    = result.rows[r];
            double    points = 0.;
            std::tie(points, row.area, row.inward, row.force, row.moment) =
              Flat<Sums>::read(&sums[Flat<Sums>::n * r]);
            row.points = std::llround(points);
          }
        return result;
      }

    private:
      /** Adds a row for the points of @p groups for which selects(p, force)
       * holds.
       *  @param term of all of these points */
      void
      add_row(const std::string &kind,
              const std::string &name,
              const PointGroups &groups,
              const Term<dim>   &term,
              const double       factor,
              const std::function<bool(unsigned int, const Tensor<1, dim> &)>
                &selects)
      {
        // A point acts where the step has brought it, with the area and the
        // normal that it has there, doc/theory.md (1.2). The loops go over this
        // rank's active grid cells and the points of the group in each of them;
        // the term gives the forces of these points in the same order. A force
        // goes into the row and to its point, where those of several conditions
        // add up.
        const BoundaryPoints<dim> &store = tissue.boundary_points();
        ForceRow                   row;
        row.kind = kind;
        row.name = name;
        for (unsigned int c = 0; c < space.grid_cells().size(); ++c)
          {
            // Most grid cells have no point of the surface.
            if (groups.offsets[c] == groups.offsets[c + 1])
              continue;
            const LocalField<dim> field = displacement.on_grid_cell(c);
            const GridIndex<dim>  index =
              space.box().index(space.grid_cells()[c].number);
            const std::vector<Tensor<1, dim>> forces = term.forces(c, field);
            for (unsigned int k = groups.offsets[c]; k < groups.offsets[c + 1];
                 ++k)
              {
                const unsigned int   p = groups.points[k];
                const Tensor<1, dim> force =
                  factor * forces[k - groups.offsets[c]];
                if (!selects(p, force))
                  continue;
                const SplineValues<dim> splines(
                  space.box().unit_position(store.position(p), index),
                  space.box().spacing());
                const Tensor<2, dim> f = field.step_deformation(splines);
                const Tensor<1, dim> area =
                  determinant(f) * (store.area_vector(p) * invert(f));
                const Tensor<1, dim> place =
                  store.position(p) + field.value(splines);
                ++row.points;
                row.area += area.norm();
                row.force += in_space(force);
                row.moment +=
                  cross_product_3d(in_space(place), in_space(force));
                // A point that is turned inside out may have no area left, and
                // then no normal.
                if (area.norm() > 0.)
                  row.inward -= force * area / area.norm();
                mine.of_points[p] += force;
              }
          }
        mine.rows.push_back(row);
      }

      const Tissue<dim>           &tissue;
      const SplineSpace<dim>      &space;
      const DisplacementField<dim> displacement;
      const MPI_Comm               comm;
      SurfaceForces<dim>           mine; // of this rank
    };
  } // namespace


  template <int dim>
  SurfaceForces<dim>
  surface_forces(const TissueModel<dim>                              &model,
                 const AttemptAtStep<dim>                            &attempt,
                 const Equilibrium::Vector                           &u,
                 const std::vector<std::unique_ptr<Term<dim>>>       &terms,
                 const std::vector<std::unique_ptr<PartOfStep<dim>>> &parts,
                 const InteractionInStep<dim> *interaction)
  {
    // The terms of conditions that load are made anew, since each of them gets
    // a row of its own.
    const BoundaryConditions<dim> &conditions = model.boundary_conditions;
    ForceSums<dim> sums(attempt.tissue, attempt.space, u, attempt.comm);
    for (std::size_t f = 0; f < model.forces.size(); ++f)
      sums.add_force(model.forces[f].name, *terms[1 + f]);
    if (conditions.has_dirichlet())
      sums.add_held(conditions, *terms[1 + model.forces.size()]);
    if (conditions.has(SurfaceCondition::loaded))
      {
        LoadedPoints<dim> points = loaded_points(attempt.tissue, attempt.space);
        points.time              = attempt.t;
        points.youngs_modulus    = attempt.typical_stiffness;
        sums.add_loads(conditions, points, attempt.t_next);
      }
    for (const auto &part : parts)
      if (const auto force = part->force())
        sums.add_part(*force);
    if (interaction != nullptr)
      sums.add_between(model.interaction->name, interaction->forces(u));
    return sums.result();
  }


  MORULA_INSTANTIATE(surface_forces);
} // namespace Morula
