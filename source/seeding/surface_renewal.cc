// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/instantiate.h>
#include <morula/base/near_tree.h>
#include <morula/grid/parting.h>
#include <morula/particles/point_exchange.h>
#include <morula/seeding/filling.h>
#include <morula/seeding/shape.h>
#include <morula/seeding/surface_renewal.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/numerics/rtree.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <utility>

namespace Morula
{
  namespace
  {
    namespace bgi = boost::geometry::index;

    /** How near to a held point a patch is the same part of the surface, in
     *  sides of a patch, and the cosine of the largest angle between them. */
    constexpr double beside = 1.5, least_cosine = 0.5;

    /** The two faces of a sheet are behind each other by its thickness, points
     *  that touch by less than this, in units of a patch's longest edge. */
    constexpr double overlap = 0.8;

    /** How far a renewed surface moves at most to enclose its volume, in units
     *  of the cells' length. */
    constexpr double farthest = 0.25;

    /** Former points of all ranks, by id, to find the nearest one. */
    template <int dim>
    class FormerPoints
    {
    public:
      // The tree indexes the positions, as surfaces are renewed with many
      // queries.
      FormerPoints(const PointList<dim>       &points,
                   const BoundaryColumns<dim> &columns)
        : points(points)
        , columns(columns)
        , tree(pack_rtree_of_indices(points.positions))
      {}

      BoundaryView<dim>
      operator[](const std::size_t i) const
      {
        return {points.row(i), columns};
      }

      /** The point nearest to @p x (µm) of those that @p counts; nothing if
       *  there is none. */
      std::optional<std::size_t>
      nearest(const Point<dim>                             &x,
              const std::function<bool(const std::size_t)> &counts) const
      {
        std::vector<std::size_t> found;
        tree.query(bgi::nearest(x, 1) && bgi::satisfies(counts),
                   std::back_inserter(found));
        return found.empty() ? std::optional<std::size_t>() : found[0];
      }

      /** Likewise of this kind: held or not. */
      std::optional<std::size_t>
      nearest(const Point<dim> &x, const bool held) const
      {
        return nearest(x,
                       [&](const std::size_t i) { return is_held(i) == held; });
      }

      bool
      is_held(const std::size_t i) const
      {
        const SurfaceCondition condition = (*this)[i].condition();
        return condition == SurfaceCondition::fixed ||
               condition == SurfaceCondition::slip;
      }

      /** Mean area that a patch shall have, µm^(dim-1). */
      double
      wanted_area(const double longest_edge) const
      {
        double sum = 0.;
        for (std::size_t i = 0; i < points.size(); ++i)
          sum += (*this)[i].wanted_area(longest_edge);
        return sum / points.size();
      }

      const PointList<dim>       &points;
      const BoundaryColumns<dim> &columns;

    private:
      using Tree = decltype(pack_rtree_of_indices(
        std::declval<const std::vector<Point<dim>> &>()));
      const Tree tree;
    };

    /** Whether the patch is that of a point which stays, a held one or not. */
    template <int dim>
    bool
    is_beside(const FormerPoints<dim> &present,
              const bool               held,
              const Point<dim>        &x,
              const Tensor<1, dim>    &n,
              const double             side)
    {
      const auto i = present.nearest(x, held);
      if (!i || present.points.positions[*i].distance(x) > beside * side)
        return false;
      const Tensor<1, dim> area = present[*i].area_vector();
      return area * n > least_cosine * area.norm();
    }

    /** Which points face others across a gap that is narrower than @p reach
     *  (µm), or none. */
    template <int dim>
    std::vector<bool>
    points_at_gaps(const FormerPoints<dim> &points,
                   const double             reach,
                   const double             longest_edge)
    {
      std::vector<Tensor<1, dim>> n;
      for (std::size_t i = 0; i < points.points.size(); ++i)
        n.push_back(points[i].area_vector() / points[i].area_vector().norm());
      const std::vector<Point<dim>> &x = points.points.positions;
      const NearTree<dim>            tree(x);
      std::vector<bool>              at_gap;
      for (std::size_t i = 0; i < n.size(); ++i)
        {
          const auto near = tree.within(x[i], reach);
          at_gap.push_back(
            std::any_of(near.begin(), near.end(), [&](const unsigned int j) {
              return n[i] * n[j] < Parting<dim>::facing &&
                     0.5 * ((n[j] - n[i]) * (x[i] - x[j])) >
                       -overlap * longest_edge;
            }));
        }
      return at_gap;
    }

    /** Corrects the areas of new patches, in proportion, so that all area
     *  vectors add up to nothing.
     *  @param opening that of the points which stay, Σ a n */
    template <int dim>
    void
    close_surface(Tensor<1, dim>                  opening,
                  std::vector<SurfacePatch<dim>> &patches)
    {
      double area = 0.;
      for (const SurfacePatch<dim> &patch : patches)
        {
          opening += patch.area * patch.normal;
          area += patch.area;
        }
      for (SurfacePatch<dim> &patch : patches)
        {
          const Tensor<1, dim> A = patch.area * (patch.normal - opening / area);
          patch.area             = A.norm();
          patch.normal           = A / patch.area;
        }
    }

    template <int dim>
    std::vector<SurfacePatch<dim>>
    patches_of(const SurfacePatches<dim> &around)
    {
      std::vector<SurfacePatch<dim>> patches;
      for (std::size_t k = 0; k < around.areas.size(); ++k)
        patches.push_back(
          {around.positions[k], around.normals[k], around.areas[k]});
      return patches;
    }

    /** Adds a point whose patch is new to a list, like its nearest former one.
     */
    template <int dim>
    void
    add_patch(const FormerPoints<dim>    &former,
              const types::particle_index id,
              const Point<dim>           &x,
              const Tensor<1, dim>       &area,
              PointList<dim>             &list)
    {
      // The new point takes over the row of the nearest former one, with its
      // condition, its X and its seed. Only its geometry begins anew: F = I,
      // and a square patch of the new area.
      const auto          like = former.nearest(x, false);
      std::vector<double> row;
      if (like)
        row.assign(former.points.row(*like).begin(),
                   former.points.row(*like).end());
      else
        row = former.columns.initial_point(x,
                                           area / area.norm(),
                                           area.norm(),
                                           SurfaceCondition::free);
      // The patch begins anew: doc/theory.md (4.12e).
      former.columns.set_square_patch(make_array_view(row),
                                      Tensor<2, dim>(
                                        unit_symmetric_tensor<dim>()),
                                      area);
      list.add(id, x, make_array_view(row));
    }

    /** The area of patches that are as long as the mean cell, but not longer
     *  than @p longest_edge (µm): that of t = 0, if the scene does not choose
     *  another; µm^(dim-1). */
    template <int dim>
    double
    area_of_cells(const PointList<dim> &volumes, const double longest_edge)
    {
      const double length =
        AllCells<dim>(volumes.positions, volumes.numbers).length;
      return std::pow(std::min(length, longest_edge), dim - 1);
    }

    /** Positions and present volumes (µm^dim) of the cells of all ranks. */
    template <int dim>
    PointList<dim>
    volumes_of_all_ranks(const Cells<dim>                  &cells,
                         const MPI_Comm                     comm,
                         const std::optional<unsigned int> &body = {})
    {
      PointList<dim> own(1);
      own.reserve(cells.size());
      for (unsigned int p = 0; p < cells.size(); ++p)
        if (!body || cells.body(p) == *body)
          own.add_value(cells.id(p), cells.position(p), cells.volume(p));
      return of_all_ranks(own, comm);
    }
    /** Adds the points that stay: held ones as they are, those at gaps begin
     *  anew. */
    template <int dim>
    void
    append_kept(const FormerPoints<dim> &present,
                const std::vector<bool> &at_gap,
                PointList<dim>          &list)
    {
      for (std::size_t i = 0; i < at_gap.size(); ++i)
        if (present.is_held(i) || at_gap[i])
          {
            std::vector<double> row(present.points.row(i).begin(),
                                    present.points.row(i).end());
            if (!present.is_held(i))
              present.columns.set_square_patch(make_array_view(row),
                                               Tensor<2, dim>(
                                                 unit_symmetric_tensor<dim>()),
                                               present[i].area_vector());
            list.add(present.points.ids[i],
                     present.points.positions[i],
                     make_array_view(row));
          }
    }

    /** The patches of a surface around all cells with which the points at gaps
     *  enclose the cells. A surface around cells closes gaps that are narrower
     *  than it can see, and is too small by what it encloses there. */
    template <int dim>
    std::vector<SurfacePatch<dim>>
    patches_beside_gaps(const FormerPoints<dim>   &present,
                        const std::vector<bool>   &at_gap,
                        const SurfacePatches<dim> &around,
                        const double               volume,
                        const double               farthest_way)
    {
      // The old surface is divided between its points, and a new patch counts
      // where the nearest one of its side is at no gap. With the points that
      // stay the patches shall be closed and enclose the cells' volume, as they
      // do where there are no gaps: (1.10) for areas, a shift along normals for
      // volume.
      std::vector<SurfacePatch<dim>> patches;
      for (std::size_t k = 0; k < around.areas.size(); ++k)
        {
          const Tensor<1, dim> n = around.normals[k];
          const auto           old =
            present.nearest(around.positions[k], [&](const std::size_t i) {
              return present[i].area_vector() * n > 0.;
            });
          if (!old || !at_gap[*old])
            patches.push_back({around.positions[k], n, around.areas[k]});
        }
      if (patches.empty())
        return patches;
      const Point<dim> apex = patches.front().position;
      Tensor<1, dim>   opening;
      double           missing = volume, area = 0.;
      for (std::size_t i = 0; i < at_gap.size(); ++i)
        if (at_gap[i])
          {
            const Tensor<1, dim> a = present[i].area_vector();
            opening += a;
            missing -= (present.points.positions[i] - apex) * a / dim;
          }
      close_surface(opening, patches);
      for (const SurfacePatch<dim> &patch : patches)
        {
          missing -=
            patch.area / dim * ((patch.position - apex) * patch.normal);
          area += patch.area;
        }
      const double way =
        std::clamp(dim * missing / area, -farthest_way, farthest_way);
      for (SurfacePatch<dim> &patch : patches)
        patch.position += way * patch.normal;
      return patches;
    }
  } // namespace


  template <int dim>
  std::optional<PointList<dim>>
  renewed_surface(const Cells<dim>                  &cells,
                  const PointList<dim>              &former,
                  const PointList<dim>              &present,
                  const BoundaryColumns<dim>        &columns,
                  const SurfaceWish                 &wish,
                  const double                       longest_edge,
                  types::particle_index             &next_id,
                  const MPI_Comm                     comm,
                  const std::optional<unsigned int> &body,
                  const bool                         keeps_gaps)
  {
    // All ranks give their cells and points to all, by id; rank 0 makes the
    // surface around the cells, since CGAL works on one rank. Held points stay
    // as they are, and those at gaps begin anew there. Patches beside one of
    // these are left out, as the surface is there already; all others become
    // free or loaded points like their nearest former one. Whether there is a
    // surface, and how many ids it takes, is told to all ranks. The new points
    // stand on rank 0; placing the tissue sends them to their owners.
    const PointList<dim> all         = volumes_of_all_ranks(cells, comm, body);
    const PointList<dim> all_former  = of_all_ranks(former, comm);
    const PointList<dim> all_present = of_all_ranks(present, comm);
    const bool           is_possible = all.size() > 0 && all_former.size() > 0;
    // Without cells or without a surface there is nothing to make.
    if (!is_possible)
      return {};
    PointList<dim>        list(columns.n_numbers());
    types::particle_index n_new = 0;
    bool                  found = false;
    on_root(comm, [&]() {
      const FormerPoints<dim> like(all_former, columns);
      const FormerPoints<dim> kept(all_present, columns);
      SurfaceWish             wanted = wish;
      if (wanted.patch_area == 0.)
        wanted.patch_area = columns.reference_area.exists() ?
                              like.wanted_area(longest_edge) :
                              area_of_cells(all, longest_edge);
      const auto around = surface_around(all.positions, all.numbers, wanted);
      if (!around)
        return;
      found                        = true;
      const AllCells<dim> together = {all.positions,
                                      all.numbers,
                                      wanted.length};
      const double        side = std::pow(wanted.patch_area, 1. / (dim - 1));
      std::vector<bool>   at_gap(all_present.size(), false);
      if (keeps_gaps)
        at_gap = points_at_gaps(kept,
                                wanted.gap * together.length + side,
                                longest_edge);
      append_kept(kept, at_gap, list);
      const bool has_gaps =
        std::find(at_gap.begin(), at_gap.end(), true) != at_gap.end();
      // New ids follow the order of the patches.
      for (const SurfacePatch<dim> &patch :
           has_gaps ? patches_beside_gaps(kept,
                                          at_gap,
                                          *around,
                                          wanted.volume > 0. ? wanted.volume :
                                                               together.volume,
                                          farthest * together.length) :
                      patches_of(*around))
        if (!is_beside(kept, true, patch.position, patch.normal, side))
          add_patch(like,
                    next_id + n_new++,
                    patch.position,
                    patch.area * patch.normal,
                    list);
    });
    next_id += Utilities::MPI::broadcast(comm, n_new, 0);
    if (!Utilities::MPI::broadcast(comm, found, 0))
      return {};
    return list;
  }

  namespace
  {
    /** The patches around carved tissue that no present point stands for, with
     *  areas that close the surface. */
    template <int dim>
    std::vector<SurfacePatch<dim>>
    patches_of_cuts(const FormerPoints<dim>   &present,
                    const SurfacePatches<dim> &around,
                    const double               side)
    {
      // Cut surfaces must close what the points that stay leave open. Normals
      // turn a little by that.
      Tensor<1, dim> opening; // Σ a n
      for (std::size_t i = 0; i < present.points.size(); ++i)
        opening += present[i].area_vector();
      std::vector<SurfacePatch<dim>> cuts;
      for (std::size_t k = 0; k < around.areas.size(); ++k)
        {
          const Point<dim>     x = around.positions[k];
          const Tensor<1, dim> n = around.normals[k];
          if (!is_beside(present, true, x, n, side) &&
              !is_beside(present, false, x, n, side))
            cuts.push_back({x, n, around.areas[k]});
        }
      close_surface(opening, cuts);
      return cuts;
    }
  } // namespace


  template <int dim>
  std::optional<PointList<dim>>
  carved_surface(const Cells<dim>                               &cells,
                 const PointList<dim>                           &present,
                 const BoundaryColumns<dim>                     &columns,
                 const std::function<SurfaceCondition(
                   const Point<dim> &, const Tensor<1, dim> &)> &condition,
                 types::particle_index                          &next_id,
                 const MPI_Comm                                  comm,
                 const std::optional<unsigned int>              &body)
  {
    // As in renewed_surface(), with two differences. All present points stay,
    // as their cells do. The patches of the cuts have no former point whose
    // condition they could take; so each is decided about as at t = 0.
    const PointList<dim>  all         = volumes_of_all_ranks(cells, comm, body);
    const PointList<dim>  all_present = of_all_ranks(present, comm);
    PointList<dim>        list(columns.n_numbers());
    types::particle_index n_new = 0;
    bool                  found = false;
    if (all.size() == 0)
      return {};
    on_root(comm, [&]() {
      const FormerPoints<dim> kept(all_present, columns);
      double                  area = 0.;
      for (std::size_t i = 0; i < all_present.size(); ++i)
        area += kept[i].initial_area() / all_present.size();
      // Where no point is left patches are as large as the cells.
      if (all_present.size() == 0)
        area = area_of_cells(all, std::numeric_limits<double>::infinity());
      const auto around =
        surface_around(all.positions, all.numbers, SurfaceWish{area});
      if (!around)
        return;
      found = true;
      list  = all_present;
      for (const SurfacePatch<dim> &patch :
           patches_of_cuts(kept, *around, std::pow(area, 1. / (dim - 1))))
        {
          std::vector<double> row =
            columns.initial_point(patch.position,
                                  patch.normal,
                                  patch.area,
                                  condition(patch.position, patch.normal));
          if (body)
            columns.body.set(make_array_view(row), *body);
          list.add(next_id + n_new++, patch.position, make_array_view(row));
        }
    });
    next_id += Utilities::MPI::broadcast(comm, n_new, 0);
    if (!Utilities::MPI::broadcast(comm, found, 0))
      return {};
    return list;
  }

  MORULA_INSTANTIATE(renewed_surface);
  MORULA_INSTANTIATE(carved_surface);
} // namespace Morula
