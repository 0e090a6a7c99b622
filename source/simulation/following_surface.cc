// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/particles/detached_points.h>
#include <morula/particles/surface_refinement.h>
#include <morula/scene/seeded_tissue.h>
#include <morula/simulation/following_surface.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <set>

namespace Morula
{
  namespace
  {
    /** The largest |Σ a n|/Σ a of a surface that counts as closed. On coarse
     *  surfaces the patches' vectors do not quite add up to nothing. */
    constexpr double largest_opening = 0.02;

    /** A surface is made from the cells when it has moved by this part of a
     *  patch's longest edge: half a cell of the lattice. Each new tiling is a
     *  disturbance of tissue that is pressed hard, so that none comes without
     *  need. */
    constexpr double longest_way = 1. / 3.;

    /** How far points hand on what they are to new patches of their side, in
     *  spacings of the grid: in a step, and at t = 0, when places decide. */
    constexpr double far = 2., near = 0.5;

    /** The points of body number @p b. */
    template <int dim>
    PointList<dim>
    of_body(const PointList<dim>       &list,
            const BoundaryColumns<dim> &columns,
            const unsigned int          b)
    {
      if (!columns.body.exists())
        return list;
      PointList<dim> some(list.n_numbers);
      for (std::size_t i = 0; i < list.size(); ++i)
        if (columns.body.get(list.row(i)) == b)
          some.add(list.ids[i],
                   list.positions[i],
                   ArrayView<const double>(list.row(i)));
      return some;
    }
  } // namespace


  template <int dim>
  FollowingSurface<dim>::FollowingSurface(const TissueModel<dim> &model,
                                          RunState               &state,
                                          TimerOutput            &timer,
                                          const MPI_Comm          comm)
    : model(model)
    , state(state)
    , timer(timer)
    , comm(comm)
    , longest_edge(0.5 * model.scene.grid.spacing)
    , exists_(has_surface(model))
    , remakes(exists_ && model.any_surface(true))
    , tracks(exists_ && model.any_surface(false))
  {}


  template <int dim>
  void
  FollowingSurface<dim>::begin(Tissue<dim> &tissue)
  {
    // No place counts as crowded at the start: there is no occupancy yet, and
    // the surface is not crumpled.
    if (may_make())
      state.walls = walls_of(tissue.boundary_points(), comm);
    refine(tissue, 0., [](const Point<dim> &) { return false; });
    const SurfaceFit fit = surface_fit(tissue);
    state.enclosed_share.reset();
    if (fit.opening <= largest_opening && fit.enclosed > 0.)
      state.enclosed_share = fit.share();
    if (remakes)
      make_from_cells(
        tissue,
        tissue.boundary_points().copy(),
        far,
        [this](const unsigned int b) { return model.remakes_surface(b); },
        false,
        words(0.));
  }


  template <int dim>
  void
  FollowingSurface<dim>::close_cuts(Tissue<dim>          &tissue,
                                    const PointList<dim> &former)
  {
    if (!exists_)
      return;
    // The conditions of the new patches are those of all patches at t = 0.
    PlaceConditions<dim> scene = words(0.);
    scene.of_new               = scene.condition;
    make_from_cells(
      tissue,
      former,
      near,
      [](const unsigned int) { return true; },
      true,
      scene);
    begin(tissue);
  }


  template <int dim>
  bool
  FollowingSurface<dim>::follow(Tissue<dim>            &tissue,
                                const SplineSpace<dim> &space,
                                const PointList<dim>   &former,
                                const double            t,
                                const double            dt)
  {
    if (!exists_)
      return false;
    // The surface comes last in a step, when the cells have their places and
    // volumes. Whether it is made anew follows from its way since the last
    // time, which is saved, and from losses of all ranks. A tracked surface is
    // made anew once where it has lost points.
    const auto n_points = [this](const std::uint64_t own) {
      return Utilities::MPI::sum(own, comm);
    };
    const bool has_lost =
      may_make() &&
      n_points(former.size()) > n_points(tissue.boundary_points().size());
    const bool is_due =
      remakes && (has_lost || state.surface_way > longest_way * longest_edge);
    if (is_due || has_lost)
      make_from_cells(
        tissue,
        former,
        far,
        [&](const unsigned int b) {
          return has_lost || model.remakes_surface(b);
        },
        true,
        words(t));
    if (is_due || !remakes)
      state.surface_way = 0.;
    refine(tissue, t, [&space](const Point<dim> &x) {
      bool crowded = false;
      for (unsigned int b = 0; b < space.n_bodies(); ++b)
        crowded = crowded || space.occupancy(b).crowded(x);
      return crowded;
    });
    if (model.interaction && model.interaction->effect->fuses())
      fuse_what_touches(tissue, t, dt);
    return has_lost;
  }


  template <int dim>
  PlaceConditions<dim>
  FollowingSurface<dim>::words(const double t) const
  {
    return {[this](const Point<dim> &x, const Tensor<1, dim> &n) {
              return model.boundary_conditions.condition(x, n);
            },
            [this](const Point<dim> &x, const Tensor<1, dim> &n) {
              const auto &list = model.boundary_conditions.list();
              return std::any_of(list.begin(),
                                 list.end(),
                                 [&](const auto &named) {
                                   return named.condition->kind() ==
                                            SurfaceCondition::loaded &&
                                          named.condition->acts_on(x, n);
                                 }) ?
                       SurfaceCondition::loaded :
                       SurfaceCondition::free;
            },
            [this, t](const BoundaryView<dim> &point) {
              return model.boundary_conditions.displacement(point, t);
            }};
  }


  template <int dim>
  void
  FollowingSurface<dim>::make_from_cells(Tissue<dim>                &tissue,
                                         const PointList<dim>       &former,
                                         const double                reach,
                                         const Bodies               &select,
                                         const bool                  keeps,
                                         const PlaceConditions<dim> &scene)
  {
    // Each body gets a surface around its own cells: one around all would close
    // the gaps between them. A tracked one keeps its points if it has no cut.
    // Where all surfaces are new the ids of points begin anew, too.
    const TimerOutput::Scope section(timer, "surface of cells");
    const auto              &columns = tissue.boundary_points().columns();
    const PointList<dim>     present = tissue.boundary_points().copy();
    const unsigned int       n       = std::max(1u, n_bodies(tissue));
    bool                     is_new  = true;
    for (unsigned int b = 0; b < n; ++b)
      is_new = is_new && select(b) && (!keeps || model.remakes_surface(b));
    if (is_new)
      state.next_boundary_id = 0;
    const Walls<dim> walls(state.walls, scene, columns);
    PointList<dim>   list(columns.n_numbers());
    for (unsigned int b = 0; b < n; ++b)
      {
        const PointList<dim> own = of_body(present, columns, b);
        if (!select(b))
          list.append(own);
        else
          list.append(
            surface_from_cells<dim>(tissue,
                                    {b,
                                     state.enclosed_share.value_or(1.),
                                     of_body(former, columns, b),
                                     reach * tissue.grid().box().spacing(),
                                     keeps && !model.remakes_surface(b) ?
                                       std::make_optional(own) :
                                       std::nullopt,
                                     state.walls.empty() ? nullptr : &walls,
                                     scene},
                                    state.next_boundary_id));
      }
    tissue.replace_surface(list);
  }


  template <int dim>
  void
  FollowingSurface<dim>::fuse_what_touches(Tissue<dim> &tissue,
                                           const double t,
                                           const double dt)
  {
    // Where a body can touch itself the surface between what fuses goes, and
    // the rest stays. Otherwise a body that several go into gets its new
    // surface once, around all its cells.
    const TimerOutput::Scope section(timer, "fusion");
    const Fusion fusion    = model.interaction->effect->fusion(tissue, dt);
    const bool   is_of_all = tissue.cells().has_parts();
    if (is_of_all)
      remove_fused_surface(fusion, tissue);
    if (fusion.into.empty())
      return;
    fuse_bodies(fusion, tissue);
    if (is_of_all)
      return;
    std::set<unsigned int> fused;
    for (const auto &[body, into] : fusion.into)
      fused.insert(into);
    make_from_cells(
      tissue,
      tissue.boundary_points().copy(),
      far,
      [&](const unsigned int body) { return fused.count(body) > 0; },
      false,
      words(t));
    refine(tissue, t, [](const Point<dim> &) { return false; });
  }


  template <int dim>
  void
  FollowingSurface<dim>::refine(
    Tissue<dim>                                   &tissue,
    const double                                   t,
    const std::function<bool(const Point<dim> &)> &crowded)
  {
    if (!model.scene.tissue.refine_surface || !tracks)
      return;
    // Merging comes before splitting: a merged patch may be longer than half a
    // grid spacing, and is split then. Both work on a copy of the points, which
    // replaces those of the tissue only if something has changed. doc/theory.md
    // (4.11), (4.12), (4.12b) say which patches are too long or too small. A
    // surface whose points have left the tissue is made anew.
    const TimerOutput::Scope section(timer, "surface refinement");
    PointList<dim>           points  = tissue.boundary_points().copy();
    const auto              &columns = tissue.boundary_points().columns();
    const auto               alike   = [&](const auto &a, const auto &b) {
      return model.boundary_conditions.alike(a, b) &&
             (!columns.body.exists() ||
              a.get(columns.body) == b.get(columns.body));
    };
    if (has_torn_patch(points, columns, longest_edge, crowded, comm))
      {
        // What holds the tissue holds the new surface, too.
        if (state.walls.empty())
          state.walls = walls_of(tissue.boundary_points(), comm);
        make_from_cells(
          tissue,
          points,
          far,
          [this](const unsigned int b) { return !model.remakes_surface(b); },
          false,
          words(t));
        return;
      }
    const bool has_merged =
      model.scene.tissue.coarsen_surface &&
      coarsen_surface<dim>(points, columns, longest_edge, alike, comm);
    const bool has_split = refine_surface(
      points, columns, longest_edge, crowded, state.next_boundary_id, comm);
    if (has_merged || has_split)
      tissue.replace_surface(points);
  }


  template class FollowingSurface<2>;
  template class FollowingSurface<3>;
} // namespace Morula
