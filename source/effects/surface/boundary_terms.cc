// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/surface/boundary_terms.h>
#include <morula/effects/surface/carriers.h>
#include <morula/effects/surface/nitsche.h>
#include <morula/mechanics/elastic_point.h>
#include <morula/particles/detached_points.h>

#include <algorithm>

namespace Morula
{
  namespace
  {
    /** Directions in which a fixed or slip point is held. */
    template <int dim>
    Tensor<2, dim>
    projection(const BoundaryView<dim> &point)
    {
      if (point.condition() == SurfaceCondition::slip)
        return outer_product(point.initial_normal(), point.initial_normal());
      return Tensor<2, dim>(unit_symmetric_tensor<dim>());
    }

    /** Prescribed displacement of a fixed point at @p t, µm. */
    template <int dim>
    Tensor<1, dim>
    displacement(const BoundaryConditions<dim> &conditions,
                 const BoundaryView<dim>       &point,
                 const double                   t)
    {
      return conditions.displacement(point.seed_position(),
                                     point.initial_normal(),
                                     point.initial_position(),
                                     t);
    }

    /** F_g at t and t + dt, and λ and μ. */
    template <int dim>
    using CellState =
      std::tuple<Tensor<2, dim>, Tensor<2, dim>, double, double>;

    /** Of the cells that carry boundary points. Cells that do not grow, or have
     * a stiffness by their place, need not tell. */
    template <int dim>
    std::vector<CellState<dim>>
    states_of_carriers(const std::vector<unsigned int> &points,
                       const Tissue<dim>               &tissue,
                       const DevelopmentOfStep<dim>    &growth)
    {
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
      return {F * invert(F_g),
              (per_grown_volume ? determinant(F_g) : 1.) / determinant(F)};
    }

    /** Of a stretch along the normal of a point, per area at t, kPa. */
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
  std::unique_ptr<Term<dim>>
  nitsche_term(const BoundaryConditions<dim> &conditions,
               const TissueMaterial          &material,
               const Tissue<dim>             &tissue,
               const SplineSpace<dim>        &space,
               const DevelopmentOfStep<dim>  &growth,
               const double                   t,
               const std::string             &kernel)
  {
    const BoundaryPoints<dim> &store = tissue.boundary_points();
    const PointGroups          groups =
      group_points(store, space, [&](const unsigned int p) {
        return is_held(store.condition(p));
      });
    std::vector<Point<dim>> queries;
    for (const unsigned int p : groups.points)
      queries.push_back(store.position(p));
    const std::vector<double>   attached = attachment(queries, tissue);
    std::vector<CellState<dim>> carrier;
    if (growth.present || !growth.lame.empty())
      carrier = states_of_carriers(groups.points, tissue, growth);

    std::vector<typename Nitsche<dim>::HeldPoint> list;
    std::vector<ElasticState<dim>>                current, previous;
    for (std::size_t k = 0; k < groups.points.size(); ++k)
      {
        const BoundaryView<dim> point = store[groups.points[k]];
        const Point<dim>        x = queries[k], X = point.initial_position();
        Point<dim>              target = X;
        if (point.condition() == SurfaceCondition::fixed)
          target += displacement(conditions, point, t);
        const Tensor<1, dim>             area = point.area_vector();
        typename Nitsche<dim>::HeldPoint held;
        held.projection        = projection(point);
        held.gap               = held.projection * (x - target);
        held.position_scale    = std::max(x.norm(), target.norm());
        held.area              = area.norm();
        held.normal            = area / area.norm();
        held.traction_fraction = attached[k];
        held.lame =
          growth.lame.empty() ? material.lame_at(X) : lame_of(carrier[k]);
        const double E = growth.lame.empty() ? material.youngs_modulus(X) :
                                               youngs_modulus(held.lame);

        const Tensor<2, dim> F = point.F();
        if (!growth.present)
          current.push_back(state(F,
                                  Tensor<2, dim>(unit_symmetric_tensor<dim>()),
                                  material.per_grown_volume()));
        else
          {
            previous.push_back(
              state(F, std::get<0>(carrier[k]), material.per_grown_volume()));
            current.push_back(
              state(F, std::get<1>(carrier[k]), material.per_grown_volume()));
          }
        // A traction that does not count need not be held down by the penalty.
        held.penalty = conditions.nitsche().penalty(
          E,
          held.lame,
          held.traction_fraction > 0. ?
            stiffness(current.back(), held, material) :
            0.,
          material.volumetric_form(),
          space.box().spacing());
        list.push_back(held);
      }
    // Where the pressure is the grid cell's, ln J_e of the point itself says
    // nothing about it.
    const PartOfLaw part =
      material.volumetric_form() == VolumetricStrain::pointwise ?
        PartOfLaw::all :
        PartOfLaw::distortion;
    return std::make_unique<Nitsche<dim>>(
      conditions.nitsche().form(),
      material.material(),
      part,
      grouped_places(store, space, groups),
      std::move(list),
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
    static_cast<GroupedPoints<dim> &>(loaded) =
      grouped_places(store, space, groups);
    for (const unsigned int p : groups.points)
      {
        const BoundaryView<dim> point = store[p];
        loaded.points.push_back({point.seed_position(),
                                 point.initial_position(),
                                 point.initial_normal(),
                                 store.position(p),
                                 point.initial_area(),
                                 point.area_vector()});
      }
    return loaded;
  }

  template <int dim>
  Enclosure<dim>
  enclosure(const Lumen<dim>       &lumen,
            const Tissue<dim>      &tissue,
            const SplineSpace<dim> &space,
            const MPI_Comm          comm)
  {
    const BoundaryPoints<dim> &store = tissue.boundary_points();
    const PointGroups          groups =
      group_points(store, space, [&](const unsigned int p) {
        return lumen.acts_on(store[p].seed_position(),
                             store[p].initial_normal());
      });
    std::vector<Tensor<1, dim>> areas;
    for (const unsigned int p : groups.points)
      areas.push_back(store[p].area_vector());
    return {SweptVolume<dim>(grouped_places(store, space, groups),
                             std::move(areas)),
            enclosed_volume(lumen_patches(lumen, tissue), comm),
            EnclosedContent()};
  }

  template <int dim>
  std::vector<LumenPatch<dim>>
  lumen_patches(const Lumen<dim>             &lumen,
                const Tissue<dim>            &tissue,
                const DisplacementField<dim> *displacement)
  {
    const BoundaryPoints<dim>   &store = tissue.boundary_points();
    std::vector<LumenPatch<dim>> list;
    const auto                   add = [&](const unsigned int    p,
                         const Tensor<1, dim> &u,
                         const Tensor<2, dim> &f) {
      const BoundaryView<dim> point = store[p];
      if (lumen.acts_on(point.seed_position(), point.initial_normal()))
        list.push_back({store.position(p) + u,
                        determinant(f) * (point.area_vector() * invert(f))});
    };
    if (displacement == nullptr)
      for (unsigned int p = 0; p < store.size(); ++p)
        add(p, Tensor<1, dim>(), Tensor<2, dim>(unit_symmetric_tensor<dim>()));
    else
      displacement->at_points(store,
                              [&](const unsigned int       p,
                                  const LocalField<dim>   &field,
                                  const SplineValues<dim> &splines) {
                                add(p,
                                    field.value(splines),
                                    field.step_deformation(splines));
                              });
    return list;
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
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        const BoundaryView<dim> point = points[p];
        const Point<dim>        x     = points.position(p);
        if (is_held(point.condition()))
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
    const BoundaryPoints<dim> &points = tissue.boundary_points();
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        const BoundaryView<dim> point = points[p];
        if (!is_held(point.condition()))
          continue;
        const Point<dim> x = points.position(p);
        HeldPoint<dim>   held{x, x, x, projection(point), point.initial_area()};
        if (point.condition() == SurfaceCondition::fixed)
          {
            const Point<dim> X = point.initial_position();
            held.from = t == 0. ? X : X + displacement(conditions, point, t);
            held.to   = X + displacement(conditions, point, t_next);
          }
        list.push_back(held);
      }
    return list;
  }

#define INSTANTIATE(dim)                                                         \
  template std::unique_ptr<Term<dim>> nitsche_term(                              \
    const BoundaryConditions<dim> &,                                             \
    const TissueMaterial &,                                                      \
    const Tissue<dim> &,                                                         \
    const SplineSpace<dim> &,                                                    \
    const DevelopmentOfStep<dim> &,                                              \
    const double,                                                                \
    const std::string &);                                                        \
  template LoadedPoints<dim>            loaded_points(const Tissue<dim> &,       \
                                                      const SplineSpace<dim> &); \
  template Enclosure<dim>               enclosure(const Lumen<dim> &,            \
                                                  const Tissue<dim> &,           \
                                                  const SplineSpace<dim> &,      \
                                                  const MPI_Comm);               \
  template std::vector<LumenPatch<dim>> lumen_patches(                           \
    const Lumen<dim> &, const Tissue<dim> &, const DisplacementField<dim> *);    \
  template std::vector<typename RigidModes<dim>::Support> supports(              \
    const BoundaryConditions<dim> &,                                             \
    const Tissue<dim> &,                                                         \
    const SplineSpace<dim> &);                                                   \
  template std::vector<HeldPoint<dim>> held_points(                              \
    const BoundaryConditions<dim> &,                                             \
    const Tissue<dim> &,                                                         \
    const double,                                                                \
    const double);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
