// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/surface/boundary_terms.h>
#include <morula/effects/surface/dead_load.h>
#include <morula/effects/surface/following_pressure.h>
#include <morula/effects/surface/nitsche.h>
#include <morula/mechanics/neo_hookean.h>
#include <morula/particles/boundary_state.h>
#include <morula/particles/nearest.h>
#include <morula/particles/strays.h>

#include <algorithm>

namespace Morula
{
  namespace
  {
    template <int dim>
    using Iterator = typename PointStore<dim>::Iterator;

    template <int dim>
    BoundaryView<dim>
    view(const Iterator<dim> &point)
    {
      return BoundaryView<dim>(boundary_properties<dim>(point));
    }

    bool
    is_dirichlet(const SurfaceCondition condition)
    {
      return condition == SurfaceCondition::fixed ||
             condition == SurfaceCondition::slip;
    }

    /** Directions in which a fixed or slip point is held. */
    template <int dim>
    Tensor<2, dim>
    projection(const BoundaryView<dim> &point)
    {
      if (point.condition() == SurfaceCondition::slip)
        return outer_product(point.initial_normal(), point.initial_normal());
      return Tensor<2, dim>(unit_symmetric_tensor<dim>());
    }

    template <int dim>
    GroupedPoints<dim>
    positions(const Tissue<dim>      &tissue,
              const SplineSpace<dim> &space,
              const PointGroups      &groups)
    {
      GroupedPoints<dim> points;
      points.offsets = groups.offsets;
      points.h       = space.box().spacing();
      for (unsigned int c = 0; c < space.grid_cells().size(); ++c)
        for (unsigned int k = groups.offsets[c]; k < groups.offsets[c + 1]; ++k)
          points.xi.push_back(space.box().unit_position(
            tissue.boundary_points().order()[groups.points[k]]->get_location(),
            space.box().index(space.grid_cells()[c].number)));
      return points;
    }

    /** Of the cells nearest to points: F_g at t and t + dt, row by row. */
    template <int dim>
    std::vector<double>
    nearest_cells(const std::vector<Point<dim>> &queries,
                  const Tissue<dim>             &tissue,
                  const GrowthOfStep<dim>       &growth)
    {
      const auto append = [&](const unsigned int p, std::vector<double> &list) {
        for (const auto *F_g : {&growth.previous[p], &growth.current[p]})
          for (unsigned int d = 0; d < dim; ++d)
            for (unsigned int e = 0; e < dim; ++e)
              list.push_back((*F_g)[d][e]);
      };
      return nearest_properties(queries,
                                tissue.cells(),
                                {2 * dim * dim, append, true},
                                tissue.grid());
    }

    /** State of a boundary point with its F and a cell's F_g. */
    template <int dim>
    ElasticState<dim>
    state(const Tensor<2, dim> &F,
          const Tensor<2, dim> &F_g,
          const bool            per_grown_volume)
    {
      return {F * invert(F_g),
              (per_grown_volume ? determinant(F_g) : 1.) / determinant(F)};
    }

    /** Of a stretch along @p n in a state, per area at t, kPa. */
    template <int dim>
    double
    stiffness(const ElasticState<dim> &state,
              const Lame              &lame,
              const Tensor<1, dim>    &n)
    {
      const NeoHookean<dim> material(state.A, lame);
      const auto           &b = material.left_cauchy_green();
      return state.W * (lame.lambda + material.mu_minus_lambda_log_J() +
                        lame.mu * (n * (b * n)));
    }

    template <int dim>
    PointGroups
    loaded_points(const Tissue<dim> &tissue, const SplineSpace<dim> &space)
    {
      return group_points(tissue.boundary_points(),
                          space,
                          [](const Iterator<dim> &point) {
                            return view<dim>(point).condition() ==
                                   SurfaceCondition::loaded;
                          });
    }
  } // namespace

  template <int dim>
  std::unique_ptr<Term<dim>>
  nitsche_term(const BoundaryConditions<dim> &conditions,
               const TissueMaterial          &material,
               const Tissue<dim>             &tissue,
               const SplineSpace<dim>        &space,
               const GrowthOfStep<dim>       &growth,
               const double                   t)
  {
    const auto       &store = tissue.boundary_points();
    const PointGroups groups =
      group_points(store, space, [](const Iterator<dim> &point) {
        return is_dirichlet(view<dim>(point).condition());
      });
    std::vector<Point<dim>> queries;
    for (const unsigned int p : groups.points)
      queries.push_back(store.order()[p]->get_location());
    const std::vector<double> trust = trust_in_surface(queries, tissue);
    std::vector<double>       nearest;
    if (growth.present)
      nearest = nearest_cells(queries, tissue, growth);

    std::vector<typename Nitsche<dim>::Condition> list;
    std::vector<ElasticState<dim>>                current, previous;
    const auto tensor = [&](const std::size_t first) {
      Tensor<2, dim> F_g;
      for (unsigned int d = 0; d < dim; ++d)
        for (unsigned int e = 0; e < dim; ++e)
          F_g[d][e] = nearest[first + d * dim + e];
      return F_g;
    };
    for (std::size_t k = 0; k < groups.points.size(); ++k)
      {
        const BoundaryView<dim> point =
          view<dim>(store.order()[groups.points[k]]);
        const Point<dim> x = queries[k], X = point.initial_position();
        Point<dim>       target = X;
        if (point.condition() == SurfaceCondition::fixed)
          target += conditions.displacement(X, t);
        const Tensor<1, dim>             area = point.area_vector();
        typename Nitsche<dim>::Condition condition;
        condition.projection     = projection(point);
        condition.gap            = condition.projection * (x - target);
        condition.position_scale = std::max(x.norm(), target.norm());
        condition.area           = area.norm();
        condition.normal         = area / area.norm();
        condition.lame           = material.lame_at(X);
        condition.trust          = trust[k];

        const Tensor<2, dim> F = point.deformation();
        if (!growth.present)
          current.push_back(state(F,
                                  Tensor<2, dim>(unit_symmetric_tensor<dim>()),
                                  material.per_grown_volume()));
        else
          {
            const std::size_t row = 2 * dim * dim * k;
            previous.push_back(
              state(F, tensor(row), material.per_grown_volume()));
            current.push_back(
              state(F, tensor(row + dim * dim), material.per_grown_volume()));
          }
        // Without trust there is no traction that the penalty must hold down.
        condition.penalty = conditions.penalty(material.youngs_modulus(X),
                                               condition.lame,
                                               condition.trust > 0. ?
                                                 stiffness(current.back(),
                                                           condition.lame,
                                                           condition.normal) :
                                                 0.,
                                               material.volumetric_form(),
                                               space.box().spacing());
        // ln J_e of the point itself says nothing about the pressure there.
        if (material.volumetric_form() == VolumetricStrain::projected)
          condition.lame.lambda = 0.;
        list.push_back(condition);
      }
    return std::make_unique<Nitsche<dim>>(conditions.nitsche_form(),
                                          positions(tissue, space, groups),
                                          std::move(list),
                                          std::move(current),
                                          std::move(previous));
  }

  template <int dim>
  std::unique_ptr<Term<dim>>
  traction_term(const BoundaryConditions<dim> &conditions,
                const Tissue<dim>             &tissue,
                const SplineSpace<dim>        &space,
                const double                   t)
  {
    const PointGroups           groups = loaded_points(tissue, space);
    std::vector<Tensor<1, dim>> forces;
    for (const unsigned int p : groups.points)
      {
        const auto point = view<dim>(tissue.boundary_points().order()[p]);
        forces.push_back(point.initial_area() *
                         conditions.traction(point.seed_position(),
                                             point.initial_position(),
                                             t));
      }
    return std::make_unique<DeadLoad<dim>>(positions(tissue, space, groups),
                                           std::move(forces));
  }

  template <int dim>
  std::unique_ptr<Term<dim>>
  pressure_term(const BoundaryConditions<dim> &conditions,
                const Tissue<dim>             &tissue,
                const SplineSpace<dim>        &space,
                const double                   t)
  {
    const PointGroups groups = loaded_points(tissue, space);
    std::vector<typename FollowingPressure<dim>::Load> loads;
    for (const unsigned int p : groups.points)
      {
        const auto point = view<dim>(tissue.boundary_points().order()[p]);
        loads.push_back({conditions.pressure(point.seed_position(),
                                             point.initial_position(),
                                             t),
                         point.area_vector()});
      }
    return std::make_unique<FollowingPressure<dim>>(
      positions(tissue, space, groups), std::move(loads));
  }

  template <int dim>
  std::vector<typename RigidModes<dim>::Support>
  supports(const BoundaryConditions<dim> &conditions,
           const Tissue<dim>             &tissue,
           const SplineSpace<dim>        &space)
  {
    std::vector<typename RigidModes<dim>::Support> list;
    if (!conditions.has_dirichlet())
      return list;
    for (const auto &particle : tissue.boundary_points().order())
      {
        const BoundaryView<dim> point = view<dim>(particle);
        const Point<dim>        x     = particle->get_location();
        if (is_dirichlet(point.condition()))
          list.push_back(
            {space.piece(space.box().number(space.box().locate(x))),
             x,
             projection(point),
             point.initial_area()});
      }
    return list;
  }

  template <int dim>
  std::vector<HeldPoint<dim>>
  held_points(const BoundaryConditions<dim> &conditions,
              const Tissue<dim>             &tissue,
              const double                   t,
              const double                   t_next)
  {
    std::vector<HeldPoint<dim>> list;
    if (!conditions.has_dirichlet())
      return list;
    for (const auto &particle : tissue.boundary_points().order())
      {
        const BoundaryView<dim> point = view<dim>(particle);
        if (!is_dirichlet(point.condition()))
          continue;
        const Point<dim> x = particle->get_location();
        HeldPoint<dim>   held{x, x, x, projection(point), point.initial_area()};
        if (point.condition() == SurfaceCondition::fixed)
          {
            const Point<dim> X = point.initial_position();
            held.from = t == 0. ? X : X + conditions.displacement(X, t);
            held.to   = X + conditions.displacement(X, t_next);
          }
        list.push_back(held);
      }
    return list;
  }

#define INSTANTIATE(dim)                                            \
  template std::unique_ptr<Term<dim>> nitsche_term(                 \
    const BoundaryConditions<dim> &,                                \
    const TissueMaterial &,                                         \
    const Tissue<dim> &,                                            \
    const SplineSpace<dim> &,                                       \
    const GrowthOfStep<dim> &,                                      \
    const double);                                                  \
  template std::unique_ptr<Term<dim>> traction_term(                \
    const BoundaryConditions<dim> &,                                \
    const Tissue<dim> &,                                            \
    const SplineSpace<dim> &,                                       \
    const double);                                                  \
  template std::unique_ptr<Term<dim>> pressure_term(                \
    const BoundaryConditions<dim> &,                                \
    const Tissue<dim> &,                                            \
    const SplineSpace<dim> &,                                       \
    const double);                                                  \
  template std::vector<typename RigidModes<dim>::Support> supports( \
    const BoundaryConditions<dim> &,                                \
    const Tissue<dim> &,                                            \
    const SplineSpace<dim> &);                                      \
  template std::vector<HeldPoint<dim>> held_points(                 \
    const BoundaryConditions<dim> &,                                \
    const Tissue<dim> &,                                            \
    const double,                                                   \
    const double);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
