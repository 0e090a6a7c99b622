// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/surface/carriers.h>
#include <morula/particles/detached_points.h>
#include <morula/particles/even_spread.h>
#include <morula/particles/surface_refinement.h>
#include <morula/scene/seeded_tissue.h>
#include <morula/seeding/surface_renewal.h>
#include <morula/simulation/following_surface.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <set>
#include <vector>

namespace Morula
{
  namespace
  {
    /** Part of the boundary points that a step may lose before the surface is
     *  made anew at once. */
    constexpr double largest_loss = 0.01;

    /** The largest |F|/√dim that a point may have come to since the surface was
     *  made. More is no motion of the tissue, but of a point that it has left
     *  behind. */
    constexpr double largest_stretch = 1.5;

    /** The largest |Σ a n|/Σ a of a surface that counts as closed. On coarse
     *  surfaces the patches' vectors do not quite add up to nothing. */
    constexpr double largest_opening = 0.02;

    /** The largest change of q/q₀ in doc/theory.md (4.12f): of the part of the
     *  cells' volume that the surface of flowing tissue encloses. */
    constexpr double largest_misfit = 0.01;

    /** A misfit that the volumes of growing cells can have. A larger one is a
     *  hole, or a surface that has left its cells. */
    constexpr double slight_misfit = 0.05;

    /** In this time, day, the volumes of cells that grow and flow are brought
     * in line with their space: slowly beside the flow, which must carry the
     *  pressure away, and fast beside a cell cycle. */
    constexpr double evening_time = 0.5;

    /** Whether a boundary point of any rank has a larger |F| than that.
     *  Collective. */
    template <int dim>
    bool
    is_stretched(const Tissue<dim> &tissue)
    {
      double largest = 0.;
      for (unsigned int p = 0; p < tissue.boundary_points().size(); ++p)
        largest = std::max(largest, tissue.boundary_points().F(p).norm());
      return Utilities::MPI::max(largest, tissue.communicator()) >
             largest_stretch * std::sqrt(dim);
    }

    /** The points of body number @p b. */
    template <int dim>
    PointList<dim>
    of_body(const PointList<dim>       &list,
            const BoundaryColumns<dim> &columns,
            const unsigned int          b)
    {
      PointList<dim> some(list.n_numbers);
      for (std::size_t i = 0; i < list.size(); ++i)
        if (columns.body.get(list.row(i)) == b)
          some.add(list.ids[i],
                   list.positions[i],
                   ArrayView<const double>(list.row(i)));
      return some;
    }

    /** What a renewed surface shall be like in a scene. */
    SurfaceWish
    wish_of(const Scene &scene)
    {
      SurfaceWish wish;
      wish.gap = scene.tissue.closed_gap;
      return wish;
    }

    /** Evens out the volumes of cells in each body by @p part, at most whole.
     *  Collective. */
    template <int dim>
    void
    even_out(Tissue<dim>            &tissue,
             const SplineSpace<dim> &space,
             const double            part)
    {
      for (unsigned int b = 0; b < space.n_bodies(); ++b)
        relax_volumes_to_space(tissue,
                               space.occupancy(b),
                               std::min(1., part),
                               b);
    }
  } // namespace


  template <int dim>
  FollowingSurface<dim>::FollowingSurface(const TissueModel<dim> &model,
                                          types::particle_index  &next_id,
                                          TimerOutput            &timer,
                                          const MPI_Comm          comm)
    : model(model)
    , next_id(next_id)
    , timer(timer)
    , comm(comm)
    , longest_edge(0.5 * model.scene.grid.spacing)
    , flows(model.scene.flows())
    , grows(model.scene.has_active_tissue())
    , spreads(grows &&
              model.material.volumetric_form() == VolumetricStrain::pooled)
    , exists_(has_surface(model))
  {}


  template <int dim>
  std::optional<double>
  FollowingSurface<dim>::begin(Tissue<dim> &tissue)
  {
    // No place counts as crowded at the start: there is no occupancy yet, and
    // the surface is not crumpled.
    refine(tissue, [](const Point<dim> &) { return false; });
    const SurfaceFit fit = surface_fit(tissue);
    if (fit.opening > largest_opening || !(fit.enclosed > 0.))
      return {};
    return fit.share();
  }


  template <int dim>
  std::optional<double>
  FollowingSurface<dim>::close_cuts(Tissue<dim> &tissue)
  {
    if (!exists_)
      return {};
    // The conditions of the new patches are decided here, as those of all
    // patches at t = 0. Rank 0 makes them, around the cells of each body, and
    // none where these have no common surface.
    const BoundaryPoints<dim> &points  = tissue.boundary_points();
    const PointList<dim>       present = points.copy();
    const auto                 add_cuts = [&](const PointList<dim>              &of_these,
                              const std::optional<unsigned int> &body,
                              PointList<dim>                    &list) {
      const auto carved = carved_surface<dim>(
        tissue.cells(),
        of_these,
        points.columns(),
        [this](const Point<dim> &x, const Tensor<1, dim> &n) {
          return model.boundary_conditions.condition(x, n);
        },
        next_id,
        comm,
        body);
      list.append(carved ? *carved : of_these);
    };
    PointList<dim> list(points.columns().n_numbers());
    if (!points.has_bodies())
      add_cuts(present, {}, list);
    else
      for (unsigned int b = 0; b < n_bodies(tissue); ++b)
        add_cuts(of_body(present, points.columns(), b), b, list);
    tissue.replace_surface(list);
    return begin(tissue);
  }


  template <int dim>
  bool
  FollowingSurface<dim>::is_cut(const std::uint64_t n_before,
                                const std::uint64_t n_left) const
  {
    return !renews() && n_before - n_left > largest_loss * n_before;
  }


  template <int dim>
  void
  FollowingSurface<dim>::follow(Tissue<dim>                 &tissue,
                                const SplineSpace<dim>      &space,
                                const PointList<dim>        &former,
                                const std::optional<double> &share,
                                const double                 t,
                                const double                 dt)
  {
    // A renewal is due by time, by loss or by stretch, and comes before
    // splitting, so that new patches are split as well where they are too long.
    // The volumes of cells are evened out with the same relaxation time,
    // doc/theory.md (6.9c). If splitting finds a torn surface, nothing has been
    // split yet: the surface is made anew where the scene has a way to do so,
    // from the points before the losses or to fit the cells (4.12f). All three
    // ways are collective, and torn surfaces are reported on all ranks.
    if (renews())
      {
        even_out(tissue, space, dt / model.scene.tissue.renew_surface);
        renew_if_due(tissue, former, t, dt);
      }
    bool is_torn = false;
    try
      {
        refine(tissue, [&space](const Point<dim> &x) {
          bool crowded = false;
          for (unsigned int b = 0; b < space.n_bodies(); ++b)
            crowded = crowded || space.occupancy(b).crowded(x);
          return crowded;
        });
      }
    catch (const SurfaceTorn &)
      {
        const bool is_new =
          renews() && renew(tissue, former, wish_of(model.scene));
        is_torn = !is_new && restores(share);
        if (!is_new && !is_torn)
          throw;
      }
    if (restores(share))
      {
        if (grows)
          {
            change_volumes(tissue, [&]() {
              even_out(tissue, space, dt / evening_time);
            });
            if (spreads)
              spread_uneven_growth(tissue, dt);
          }
        restore_fit(tissue, *share, is_torn);
      }
    if (model.interaction && model.interaction->effect->fuses())
      fuse_what_touches(tissue, dt);
  }


  template <int dim>
  void
  FollowingSurface<dim>::restore_fit(Tissue<dim> &tissue,
                                     const double share,
                                     const bool   is_torn)
  {
    // The length ℓ of doc/theory.md (4.12f) is known first, as it measures both
    // the distance at which points have left the cells and the smoothness of
    // the new surface. Points that are left alone are pulled back at the end,
    // whether the surface is new or not.
    const SurfaceFit fit = surface_fit(tissue);
    const auto       n =
      Utilities::MPI::sum<std::uint64_t>(tissue.cells().size(), comm);
    if (n == 0)
      return;
    // No spline sees what is smaller than half a grid spacing. Nothing that is
    // smaller than a cell is a feature of the surface.
    const double length =
      std::max(longest_edge, std::pow(fit.cells / n, 1. / dim));
    const double misfit = fit.share() / share;
    if (is_torn || !(fit.enclosed > 0.) || fit.distance > 2. * length ||
        std::abs(misfit - 1.) > largest_misfit)
      {
        // Where the volumes of growing cells are integrals of their motion over
        // many steps, a slight misfit is one of the volumes, as the surface
        // stands where the tissue ends. A surface that gave way to them would
        // leave its outermost cells behind. Pooled volumes are what the cells
        // have grown to, and it is the surface that is wrong, unless it is
        // held. A held surface also stays as it is then: one that is made anew
        // leaves its walls here and there, and tissue gets out.
        const bool is_held        = is_mostly_held(tissue);
        const bool follow_surface = grows && !is_torn && fit.enclosed > 0. &&
                                    std::abs(misfit - 1.) < slight_misfit &&
                                    (!spreads || is_held);
        if (follow_surface)
          change_volumes(tissue, [&]() {
            const double stretch = std::pow(misfit, 1. / dim);
            for (unsigned int p = 0; p < tissue.cells().size(); ++p)
              {
                const CellView<dim, double> cell = tissue.cell(p);
                cell.set(cell.columns().deformation, stretch * cell.F());
              }
          });
        if (!follow_surface || !is_held || fit.distance > 2. * length)
          renew(tissue,
                tissue.boundary_points().copy(),
                {0.,
                 length,
                 follow_surface ? fit.enclosed : share * fit.cells});
      }
    pull_to_cells(tissue, length);
  }


  template <int dim>
  void
  FollowingSurface<dim>::renew_if_due(Tissue<dim>          &tissue,
                                      const PointList<dim> &former,
                                      const double          t,
                                      const double          dt)
  {
    // Times of renewal are multiples of the interval: one is due if the step
    // has passed or met a multiple. The slack lets a step that ends within
    // rounding of it count. Losses are those of all ranks.
    const double every = model.scene.tissue.renew_surface;
    const double slack = model.scene.time.slack();
    const bool   is_due =
      std::floor((t + slack) / every) > std::floor((t - dt + slack) / every);
    const auto n = Utilities::MPI::sum<std::uint64_t>(former.size(), comm);
    const auto n_left =
      Utilities::MPI::sum<std::uint64_t>(tissue.boundary_points().size(), comm);
    if (is_due || n - n_left > largest_loss * n || is_stretched(tissue))
      renew(tissue, former, wish_of(model.scene));
  }


  template <int dim>
  bool
  FollowingSurface<dim>::renew(Tissue<dim>          &tissue,
                               const PointList<dim> &former,
                               const SurfaceWish    &wish)
  {
    // Rank 0 makes the surface from the cells of all ranks, so that it does not
    // depend on their number. It has all points until replace_surface() sends
    // them to their owners. Without a list, where the cells have no common
    // surface, the old one stays.
    const TimerOutput::Scope   section(timer, "surface renewal");
    const BoundaryPoints<dim> &points = tissue.boundary_points();
    if (points.has_bodies())
      return renew_bodies(tissue, former, wish, [](const unsigned int) {
        return true;
      });
    const auto list = renewed_surface(tissue.cells(),
                                      former,
                                      points.copy(),
                                      points.columns(),
                                      wish,
                                      longest_edge,
                                      next_id,
                                      comm);
    if (list)
      tissue.replace_surface(*list);
    return list.has_value();
  }


  template <int dim>
  void
  FollowingSurface<dim>::fuse_what_touches(Tissue<dim> &tissue, const double dt)
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
    if (!renew_bodies(tissue,
                      tissue.boundary_points().copy(),
                      wish_of(model.scene),
                      [&](const unsigned int body) {
                        return fused.count(body) > 0;
                      }))
      throw SurfaceTorn("bodies that are to fuse have no surface in common, as "
                        "some of their cells are lost");
    refine(tissue, [](const Point<dim> &) { return false; });
  }


  template <int dim>
  bool
  FollowingSurface<dim>::renew_bodies(
    Tissue<dim>                             &tissue,
    const PointList<dim>                    &former,
    const SurfaceWish                       &wish,
    const std::function<bool(unsigned int)> &selects)
  {
    // Each body gets a surface around its own cells, which encloses its share
    // of the wished volume: one around all would close the gaps between them.
    // If one of them has no common surface the old ones stay.
    const Cells<dim>          &cells   = tissue.cells();
    const BoundaryPoints<dim> &points  = tissue.boundary_points();
    const auto                &columns = points.columns();
    const unsigned int         n       = n_bodies(tissue);
    std::vector<double>        volumes(n, 0.);
    for (unsigned int p = 0; p < cells.size(); ++p)
      volumes[cells.body(p)] += cells.volume(p);
    Utilities::MPI::sum(volumes, comm, volumes);
    const double   all = std::accumulate(volumes.begin(), volumes.end(), 0.);
    PointList<dim> list(columns.n_numbers());
    for (unsigned int b = 0; b < n; ++b)
      {
        if (volumes[b] == 0.)
          continue;
        if (!selects(b))
          {
            list.append(of_body(points.copy(), columns, b));
            continue;
          }
        SurfaceWish of_this = wish;
        of_this.volume *= volumes[b] / all;
        const auto more = renewed_surface(cells,
                                          of_body(former, columns, b),
                                          of_body(points.copy(), columns, b),
                                          columns,
                                          of_this,
                                          longest_edge,
                                          next_id,
                                          comm,
                                          b,
                                          cells.has_parts());
        if (!more)
          return false;
        list.append(*more);
      }
    tissue.replace_surface(list);
    return true;
  }


  template <int dim>
  void
  FollowingSurface<dim>::refine(
    Tissue<dim> &tissue, const std::function<bool(const Point<dim> &)> &crowded)
  {
    if (!model.scene.tissue.refine_surface)
      return;
    // Merging comes before splitting: a merged patch may be longer than half a
    // grid spacing, and is split then. Both work on a copy of the points, which
    // replaces those of the tissue only if something has changed. doc/theory.md
    // (4.11), (4.12), (4.12b) say which patches are too long or too small.
    const TimerOutput::Scope section(timer, "surface refinement");
    PointList<dim>           points  = tissue.boundary_points().copy();
    const auto              &columns = tissue.boundary_points().columns();
    const auto               alike   = [&](const auto &a, const auto &b) {
      return model.boundary_conditions.alike(a, b) &&
             (!columns.body.exists() ||
              a.get(columns.body) == b.get(columns.body));
    };
    const bool has_merged =
      model.scene.tissue.coarsen_surface &&
      coarsen_surface<dim>(points, columns, longest_edge, alike, comm);
    const bool has_split =
      refine_surface(points, columns, longest_edge, crowded, next_id, comm);
    if (has_merged || has_split)
      tissue.replace_surface(points);
  }


  template class FollowingSurface<2>;
  template class FollowingSurface<3>;
} // namespace Morula
