// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/effects/surface/boundary_terms.h>
#include <morula/effects/surface/nitsche.h>
#include <morula/mechanics/elastic_point.h>
#include <morula/particles/detached_points.h>

#include <algorithm>

namespace Morula
{
  namespace
  {
    /** The states of the cells that carry boundary points. Cells that do not
     *  grow, or have a stiffness by their place, need not tell. */
    template <int dim>
    std::vector<CellState<dim>>
    states_of_carriers(const std::vector<unsigned int> &points,
                       const Tissue<dim>               &tissue,
                       const DevelopmentOfStep<dim>    &growth)
    {
      // One exchange brings all that is asked of a carrier.
      const Tensor<2, dim> identity(unit_symmetric_tensor<dim>());
      return carrier_values(points, tissue, [&](const unsigned int p) {
        const Lame lame = growth.lame.empty() ? Lame{0., 0.} : growth.lame[p];
        return CellState<dim>(growth.present ? growth.previous[p] : identity,
                              growth.present ? growth.current[p] : identity,
                              lame.lambda,
                              lame.mu);
      });
    }

    template <int dim>
    Lame
    lame_of(const CellState<dim> &state)
    {
      return {std::get<2>(state), std::get<3>(state)};
    }

    /** State of a boundary point with its F and a cell's F_g. */
    template <int dim>
    ElasticState<dim>
    state(const Tensor<2, dim> &F,
          const Tensor<2, dim> &F_g,
          const bool            per_grown_volume)
    {
      // These are A = F F_g⁻¹ and W/V_t of doc/theory.md (4.2).
      return {F * invert(F_g),
              (per_grown_volume ? determinant(F_g) : 1.) / determinant(F)};
    }

    /** The stiffness of a stretch along the normal of a point, per area at t,
     *  kPa: k in doc/theory.md (4.6). */
    template <int dim>
    double
    stiffness(const ElasticState<dim>                &state,
              const typename Nitsche<dim>::HeldPoint &held,
              const TissueMaterial                   &material)
    {
      const ElasticPoint<dim> point(state.A, held.lame, material.material());
      return state.W * point.stiffness(held.normal);
    }
  } // namespace

  template <int dim>
  HeldPoints<dim>
  points_of_term(const BoundaryConditions<dim> &conditions,
                 const TissueMaterial          &material,
                 const Tissue<dim>             &tissue,
                 const SplineSpace<dim>        &space,
                 const DevelopmentOfStep<dim>  &growth,
                 const double                   t)
  {
    // Where the points are and how far they belong to the tissue, and the
    // state of the cells that carry them, may need other ranks; so both are
    // asked for all points at once. Then each point gets its gap to where it
    // is held at the end of the step, doc/theory.md (4.1), and its stiffness,
    // by its place or as its cell has it.
    const BoundaryPoints<dim> &store = tissue.boundary_points();
    HeldPoints<dim>            held;
    held.groups = held_groups(tissue, space);
    const std::vector<Point<dim>> places =
      store.positions_of(held.groups.points);
    const std::vector<double> attached =
      attachment(places, tissue, store.sides_of(held.groups.points));
    if (growth.present || !growth.lame.empty())
      held.carriers = states_of_carriers(held.groups.points, tissue, growth);
    for (std::size_t k = 0; k < places.size(); ++k)
      {
        const BoundaryView<dim> point = store[held.groups.points[k]];
        const Point<dim>        x = places[k], X = point.initial_position();
        // A slip point is held in its initial plane.
        Point<dim> target = X;
        if (point.condition() == SurfaceCondition::fixed)
          target += conditions.displacement(point, t);
        const Tensor<1, dim>             area = point.area_vector();
        typename Nitsche<dim>::HeldPoint of_term;
        of_term.projection        = projection(point);
        of_term.gap               = of_term.projection * (x - target);
        of_term.position_scale    = std::max(x.norm(), target.norm());
        of_term.area              = area.norm();
        of_term.normal            = area / area.norm();
        of_term.traction_fraction = attached[k];
        const bool by_place       = growth.lame.empty();
        of_term.lame =
          by_place ? material.lame_at(X) : lame_of(held.carriers[k]);
        held.youngs_moduli.push_back(by_place ? material.youngs_modulus(X) :
                                                youngs_modulus(of_term.lame));
        held.list.push_back(of_term);
      }
    return held;
  }

  template <int dim>
  std::unique_ptr<Term<dim>>
  nitsche_term(const BoundaryConditions<dim> &conditions,
               const TissueMaterial          &material,
               const Tissue<dim>             &tissue,
               const SplineSpace<dim>        &space,
               const DevelopmentOfStep<dim>  &growth,
               const double                   t,
               const std::string             &kernel)
  {
    // For each held point the elastic state follows from its own F and its
    // carrier's growth, at the end of the step and, if anything grows, at its
    // beginning, since the first tangent has that. The state decides about the
    // penalty of doc/theory.md (4.6) as well. What the term needs is then moved
    // into it, by active grid cell; the order of points and states must be the
    // same.
    HeldPoints<dim> held =
      points_of_term(conditions, material, tissue, space, growth, t);
    const BoundaryPoints<dim> &store = tissue.boundary_points();
    const Tensor<2, dim>       I(unit_symmetric_tensor<dim>());
    const bool                 grown = material.per_grown_volume();

    std::vector<ElasticState<dim>> current, previous;
    // The list is in the order of the groups: by active grid cell, then by the
    // store's order.
    for (std::size_t k = 0; k < held.list.size(); ++k)
      {
        const Tensor<2, dim> F = store.F(held.groups.points[k]);
        if (!growth.present)
          current.push_back(state(F, I, grown));
        else
          {
            previous.push_back(state(F, std::get<0>(held.carriers[k]), grown));
            current.push_back(state(F, std::get<1>(held.carriers[k]), grown));
          }
        auto &point = held.list[k];
        // A traction that does not count need not be held down by the penalty.
        point.penalty = conditions.nitsche().beta(held.youngs_moduli[k],
                                                  point.lame,
                                                  point.traction_fraction > 0. ?
                                                    stiffness(current.back(),
                                                              point,
                                                              material) :
                                                    0.,
                                                  material.volumetric_form(),
                                                  space.box().spacing());
      }
    // Where the pressure is the grid cell's, ln J_e of the point itself says
    // nothing about it: only the distortional part enters T.
    const PartOfLaw part =
      material.volumetric_form() == VolumetricStrain::pointwise ?
        PartOfLaw::all :
        PartOfLaw::distortion;
    return std::make_unique<Nitsche<dim>>(
      conditions.nitsche().kind(),
      material.material(),
      part,
      grouped_places(store, space, held.groups),
      std::move(held.list),
      std::move(current),
      std::move(previous),
      product_kernel<dim>(material.material(), kernel));
  }

  template <int dim>
  LoadedPoints<dim>
  loaded_points(const Tissue<dim> &tissue, const SplineSpace<dim> &space)
  {
    const BoundaryPoints<dim> &store = tissue.boundary_points();
    const PointGroups          groups =
      group_points(store, space, [&](const unsigned int p) {
        return store.condition(p) == SurfaceCondition::loaded;
      });
    LoadedPoints<dim> loaded;
    loaded.tissue = &tissue;
    // The base class has the places, by grid cell; the other values follow in
    // the same order.
    static_cast<GroupedPoints<dim> &>(loaded) =
      grouped_places(store, space, groups);
    loaded.sides = store.sides_of(groups.points);
    for (const unsigned int p : groups.points)
      {
        const BoundaryView<dim> point = store[p];
        loaded.points.push_back({point.seed_position(),
                                 point.initial_position(),
                                 point.initial_normal(),
                                 store.position(p),
                                 point.initial_area(),
                                 point.area_vector(),
                                 point.touched()});
      }
    return loaded;
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
    const BoundaryPoints<dim> &points = tissue.boundary_points();
    // Held areas are initial ones, as in doc/theory.md (4.9).
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        const BoundaryView<dim> point = points[p];
        const Point<dim>        x     = points.position(p);
        if (is_held(point.condition()))
          list.push_back({space.piece(space.box().number(space.box().locate(x)),
                                      points.part(p)),
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
    // Where a point is held follows from its own X; a slip point, and one that
    // nothing moves, is where it is. At t = 0 nothing has moved yet.
    const BoundaryPoints<dim> &points = tissue.boundary_points();
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        const BoundaryView<dim> point = points[p];
        if (!is_held(point.condition()))
          continue;
        const Point<dim> x = points.position(p);
        HeldPoint<dim>   held{
          x, x, x, projection(point), point.initial_area(), points.part(p)};
        if (point.condition() == SurfaceCondition::fixed)
          {
            const Point<dim> X = point.initial_position();
            held.from = t == 0. ? X : X + conditions.displacement(point, t);
            held.to   = X + conditions.displacement(point, t_next);
          }
        list.push_back(held);
      }
    return list;
  }

  MORULA_INSTANTIATE(nitsche_term);
  MORULA_INSTANTIATE(points_of_term);
  MORULA_INSTANTIATE(loaded_points);
  MORULA_INSTANTIATE(supports);
  MORULA_INSTANTIATE(held_points);
} // namespace Morula
