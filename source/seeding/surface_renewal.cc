// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/particles/point_exchange.h>
#include <morula/seeding/filling.h>
#include <morula/seeding/shape.h>
#include <morula/seeding/surface_renewal.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/numerics/rtree.h>

#include <algorithm>
#include <cmath>
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

      /** The point nearest to @p x (µm) of this kind: held or not; nothing if
       *  there is none. */
      std::optional<std::size_t>
      nearest(const Point<dim> &x, const bool held) const
      {
        std::vector<std::size_t> found;
        tree.query(bgi::nearest(x, 1) &&
                     bgi::satisfies(
                       [&](const std::size_t i) { return is_held(i) == held; }),
                   std::back_inserter(found));
        return found.empty() ? std::optional<std::size_t>() : found[0];
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
                  const std::optional<unsigned int> &body)
  {
    // All ranks give their cells and points to all, by id; rank 0 makes the
    // surface around the cells, since CGAL works on one rank. Held points stay
    // as they are. Patches beside one of these are left out, as the surface is
    // there already; all others become free or loaded points like their nearest
    // former one. Whether there is a surface, and how many ids it takes, is
    // told to all ranks. The new points stand on rank 0; placing the tissue
    // sends them to their owners.
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
      const auto patches = surface_around(all.positions, all.numbers, wanted);
      if (!patches)
        return;
      found = true;
      for (std::size_t i = 0; i < all_present.size(); ++i)
        if (kept.is_held(i))
          list.add(all_present.ids[i],
                   all_present.positions[i],
                   ArrayView<const double>(all_present.row(i)));
      // New ids follow the order of the patches.
      for (std::size_t k = 0; k < patches->areas.size(); ++k)
        {
          const Point<dim>     x = patches->positions[k];
          const Tensor<1, dim> n = patches->normals[k];
          if (!is_beside(
                kept, true, x, n, std::pow(wanted.patch_area, 1. / (dim - 1))))
            add_patch(like, next_id + n_new++, x, patches->areas[k] * n, list);
        }
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
      // Cut surfaces must close what the points that stay leave open: the areas
      // of all add up to some vector, which is taken out of the cuts' in
      // proportion to their areas. Normals turn a little by that.
      Tensor<1, dim> opening; // Σ a n
      for (std::size_t i = 0; i < present.points.size(); ++i)
        opening += present[i].area_vector();
      std::vector<SurfacePatch<dim>> cuts;
      double                         area = 0.;
      for (std::size_t k = 0; k < around.areas.size(); ++k)
        {
          const Point<dim>     x = around.positions[k];
          const Tensor<1, dim> n = around.normals[k];
          if (is_beside(present, true, x, n, side) ||
              is_beside(present, false, x, n, side))
            continue;
          cuts.push_back({x, n, around.areas[k]});
          area += around.areas[k];
          opening += around.areas[k] * n;
        }
      for (SurfacePatch<dim> &patch : cuts)
        {
          const Tensor<1, dim> A = patch.area * (patch.normal - opening / area);
          patch.area             = A.norm();
          patch.normal           = A / patch.area;
        }
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
                 const MPI_Comm                                  comm)
  {
    // As in renewed_surface(), with two differences. All present points stay,
    // as their cells do. The patches of the cuts have no former point whose
    // condition they could take; so each is decided about as at t = 0.
    const PointList<dim>  all         = volumes_of_all_ranks(cells, comm);
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
          const std::vector<double> row =
            columns.initial_point(patch.position,
                                  patch.normal,
                                  patch.area,
                                  condition(patch.position, patch.normal));
          list.add(next_id + n_new++, patch.position, make_array_view(row));
        }
    });
    next_id += Utilities::MPI::broadcast(comm, n_new, 0);
    if (!Utilities::MPI::broadcast(comm, found, 0))
      return {};
    return list;
  }

#define INSTANTIATE(dim)                                             \
  template std::optional<PointList<dim>> renewed_surface(            \
    const Cells<dim> &,                                              \
    const PointList<dim> &,                                          \
    const PointList<dim> &,                                          \
    const BoundaryColumns<dim> &,                                    \
    const SurfaceWish &,                                             \
    const double,                                                    \
    types::particle_index &,                                         \
    const MPI_Comm,                                                  \
    const std::optional<unsigned int> &);                            \
  template std::optional<PointList<dim>> carved_surface(             \
    const Cells<dim> &,                                              \
    const PointList<dim> &,                                          \
    const BoundaryColumns<dim> &,                                    \
    const std::function<SurfaceCondition(const Point<dim> &,         \
                                         const Tensor<1, dim> &)> &, \
    types::particle_index &,                                         \
    const MPI_Comm);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
