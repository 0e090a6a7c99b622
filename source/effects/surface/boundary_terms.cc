// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/instantiate.h>
#include <morula/effects/part_of_step.h>
#include <morula/effects/surface/boundary_terms.h>
#include <morula/effects/surface/nitsche.h>
#include <morula/mechanics/elastic_point.h>
#include <morula/particles/detached_points.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <utility>

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
    if (!growth.lame.empty() ||
        (growth.present && conditions.nitsche().kind() != NitscheForm::bounded))
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
        const Tensor<2, dim> F = store[held.groups.points[k]].F();
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


  namespace
  {
    const std::string name = "carrier";

    template <int dim>
    Column<int>
    column(const Tissue<dim> &tissue)
    {
      // Only scenes with held points and growth have the column.
      return tissue.boundary_points().columns().template find<int>(name);
    }
  } // namespace


  template <int dim>
  void
  add_carriers(BoundaryColumns<dim> &columns)
  {
    columns.template add<int>(
      {name, "", "id of the cell whose growth a held point takes", -1});
  }


  template <int dim>
  std::vector<types::particle_index>
  carriers(const std::vector<unsigned int> &points, const Tissue<dim> &tissue)
  {
    const Column<int>                  ids = column(tissue);
    std::vector<types::particle_index> list;
    for (const unsigned int p : points)
      // -1 is the id of no cell.
      list.push_back(ids.exists() ? tissue.boundary_points().get(ids, p) : -1);
    return list;
  }


  template <int dim>
  void
  renew_carriers(Tissue<dim> &tissue)
  {
    // The carriers that are still there are looked for by their ids around the
    // points. Those that were not found are replaced by the nearest cell, over
    // all ranks. If several are equally near none of them becomes the carrier,
    // and the mean counts until one is nearer. The exchanges are collective, so
    // ranks without lost points take part, and all leave together where no rank
    // has any.
    const Column<int> ids = column(tissue);
    if (!ids.exists())
      return;
    const BoundaryPoints<dim> &store = tissue.boundary_points();
    std::vector<unsigned int>  held;
    for (unsigned int p = 0; p < store.size(); ++p)
      if (is_held(store.condition(p)))
        held.push_back(p);
    const auto id = [&](const unsigned int p) -> double {
      return tissue.cells().id(p);
    };
    const auto                present = values_by_id(carriers(held, tissue),
                                      store.positions_of(held),
                                      tissue.cells(),
                                      id,
                                      tissue.grid());
    std::vector<unsigned int> lost;
    for (std::size_t k = 0; k < held.size(); ++k)
      if (!present[k])
        lost.push_back(held[k]);
    const MPI_Comm comm = tissue.communicator();
    if (!Utilities::MPI::logical_or(!lost.empty(), comm) ||
        Utilities::MPI::sum(1. * tissue.cells().size(), comm) == 0.)
      return;
    // Among several nearest cells the mean of the ids is larger than the lowest
    // of them.
    const std::vector<Point<dim>> queries = store.positions_of(lost);
    const std::vector<Side<dim>>  sides   = store.sides_of(lost);
    const auto                    lowest  = nearest_values(
      queries, tissue.cells(), id, Ties::lowest_id, tissue.grid(), sides);
    const auto mean = nearest_values(
      queries, tissue.cells(), id, Ties::mean, tissue.grid(), sides);
    for (std::size_t k = 0; k < lost.size(); ++k)
      tissue.boundary_point(lost[k]).set(
        ids, mean[k] == lowest[k] ? static_cast<int>(lowest[k]) : -1);
  }


  MORULA_INSTANTIATE(add_carriers);
  MORULA_INSTANTIATE(carriers);
  MORULA_INSTANTIATE(renew_carriers);


  namespace
  {
    /** What is added to the least penalty for squeezed tissue, in units of the
     *  stiffness beyond that at rest by h: doc/theory.md (4.6). Less leaves the
     *  symmetric form indefinite; in the bounded one evenly squeezed tissue
     *  becomes uneven. */
    constexpr double squeezed_penalty = 100.;
  } // namespace


  void
  NitscheParameters::review(const bool all_is_fixed, Review &review) const
  {
    // A small penalty gives way under pressure, as where tissue grows between
    // its clamps.
    if (all_is_fixed && form == "unsymmetric" && penalty < 100.)
      review.warn(
        penalty.path(),
        as_text(penalty) + " E/h",
        "all of the surface is fixed, and gives way where tissue is pressed "
        "against it: in a ball that grows to 1.1 in all directions the "
        "energy is 9 % low at a penalty of 20 (doc/accuracy-and-cost.md, "
        "which method).",
        "Set " + form.path() + " = bounded, or raise the penalty to 1000.");
  }


  double
  NitscheParameters::beta(const double           E,
                          const Lame            &lame,
                          const double           stiffness,
                          const VolumetricStrain volumetric_form,
                          const double           h) const
  {
    // This is doc/theory.md (4.6), and section 2.4 where the pressure is the
    // pool's.
    const double at_rest = lame.lambda + 2. * lame.mu;
    if (kind() != NitscheForm::bounded &&
        volumetric_form != VolumetricStrain::pointwise)
      return penalty * at_rest / h;
    const double least =
      kind() == NitscheForm::unsymmetric ?
        0. :
        least_penalty * at_rest +
          squeezed_penalty * std::max(0., stiffness - at_rest);
    return std::max(penalty * E, least) / h;
  }


  template <int dim>
  std::vector<std::unique_ptr<PartOfStep<dim>>>
  BoundaryConditions<dim>::parts_of_step(
    const AttemptAtStep<dim> &attempt) const
  {
    // The bounded form holds a traction fixed for all points that are held
    // together. Its term stands behind the forces on cells, so that it is the
    // first part.
    std::vector<std::unique_ptr<PartOfStep<dim>>> parts;
    if (has_dirichlet() && nitsche_.kind() == NitscheForm::bounded)
      {
        const TimerOutput::Scope section(attempt.timer, "nitsche");
        everywhere(attempt.comm,
                   [&]() { parts.push_back(held_traction(*this, attempt)); });
      }
    for (const Named &named : list_)
      for (auto &part : named.condition->parts_of_step(attempt))
        parts.push_back(std::move(part));
    return parts;
  }


  template class BoundaryConditions<2>;
  template class BoundaryConditions<3>;
} // namespace Morula
