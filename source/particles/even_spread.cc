// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/grid/grid_box.h>
#include <morula/particles/even_spread.h>
#include <morula/particles/point_exchange.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/numbers.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <vector>

namespace Morula
{
  namespace
  {
    /** The length H of the kernel in widths of the cell, or of the mean
     *  one if that is wider. */
    constexpr double kernel_width = 1.3;

    /** κ of a cell that spreads fully for the spreading time or longer, and the
     *  part of its width that it moves then at most. */
    constexpr double spread_part = 0.2;
    constexpr double longest_way = 0.1;

    /** The depth below the surface, in widths of the cell, above which a cell
     *  is not moved towards it. */
    constexpr double least_depth = 0.25;

    /** Patches whose normals differ by more than 60° are not one plane. */
    constexpr double alike_cosine = 0.5;

    /** The edge of the boxes in which cells are looked up, in reaches: smaller
     *  ones hold fewer cells beyond the reach, but there are more of them. */
    constexpr double bin_part = 0.5;

    /** Volume and body of a cell. */
    using Grain = std::tuple<double, unsigned int>;

    /** Outward normal, area, spacing and body of a patch. */
    template <int dim>
    using Patch = std::tuple<Tensor<1, dim>, double, double, unsigned int>;

    /** The cells of this rank, and those of others within @p reach. */
    template <int dim>
    PointList<dim>
    cells_around(const Tissue<dim> &tissue, const double reach)
    {
      const Cells<dim> &cells = tissue.cells();
      PointList<dim>    list(Flat<Grain>::n);
      for (unsigned int p = 0; p < cells.size(); ++p)
        list.add_value(cells.id(p),
                       cells.position(p),
                       Grain(cells.volume(p), cells.body(p)));
      list.append(halo(list, tissue.grid(), reach));
      return list;
    }

    /** The patches of this rank, and those of others within @p reach. */
    template <int dim>
    PointList<dim>
    patches_around(const Tissue<dim> &tissue, const double reach)
    {
      const BoundaryPoints<dim> &points = tissue.boundary_points();
      PointList<dim>             list(Flat<Patch<dim>>::n);
      for (unsigned int p = 0; p < points.size(); ++p)
        {
          const Tensor<1, dim> area = points[p].area_vector();
          list.add_value(points.id(p),
                         points.position(p),
                         Patch<dim>(area / area.norm(),
                                    area.norm(),
                                    points[p].spacing(),
                                    points.body(p)));
        }
      list.append(halo(list, tissue.grid(), reach));
      return list;
    }

    /** -dW/dq of Wendland's kernel, q = r/H, but for what all q have. */
    double
    slope(const double q)
    {
      return q < 2. ? q * Utilities::fixed_power<3>(1. - 0.5 * q) : 0.;
    }

    /** What is missing there, for the length @p H, µm^-dim. */
    template <int dim>
    double
    slope_factor(const double H)
    {
      return 5. *
             (dim == 2 ? 7. / (4. * numbers::PI) : 21. / (16. * numbers::PI)) /
             Utilities::fixed_power<dim>(H);
    }

    /** Where a cell's surroundings end, if they do: x with n·x = offset. */
    template <int dim>
    struct Plane
    {
      Tensor<1, dim> normal;
      double         offset = 0.;

      double
      depth(const Point<dim> &x) const
      {
        return offset - normal * x;
      }
    };

    /** What the motions of cells depend on. */
    template <int dim>
    struct SpreadAround
    {
      const PointList<dim> cells;
      const PointList<dim> patches;
      const GridBox<dim>   cell_box;
      const PointBins<dim> cell_bins;
      const PointBins<dim> patch_bins;
      const double         patch_reach; // µm
      const double         mean_width;  // of the cells of all ranks, µm

      /** @param reach of the largest kernel, µm
       *  @param largest_spacing of patches, µm
       *  @param mean_width of cells, µm */
      SpreadAround(const Tissue<dim> &tissue,
                   const double       reach,
                   const double       largest_spacing,
                   const double       mean_width)
        : cells(cells_around(tissue, reach))
        , patches(patches_around(tissue, reach + largest_spacing))
        , cell_box(cells.positions.empty() ?
                     tissue.grid().box() :
                     box_around(cells.positions, bin_part * reach))
        , cell_bins(cell_box, cells.positions)
        , patch_bins(tissue.grid().box(), patches.positions)
        , patch_reach(reach + largest_spacing)
        , mean_width(mean_width)
      {}
    };

    /** The points of a list for which is_one(i) holds, not farther than
     *  @p radius from @p x, by id: so sums do not depend on the ranks. */
    template <int dim, typename Select>
    std::vector<unsigned int>
    near(const PointBins<dim> &bins,
         const PointList<dim> &list,
         const Point<dim>     &x,
         const double          radius,
         const Select         &is_one)
    {
      std::vector<unsigned int> found;
      bins.visit_within(x, radius, [&](const unsigned int i) {
        if (is_one(i))
          found.push_back(i);
      });
      std::sort(found.begin(),
                found.end(),
                [&list](const unsigned int a, const unsigned int b) {
                  return list.ids[a] < list.ids[b];
                });
      return found;
    }

    /** The plane at the patches around @p x that look the same way as patch
     *  @p first of @p near. */
    template <int dim>
    Plane<dim>
    plane_at(const unsigned int               first,
             const Point<dim>                &x,
             const std::vector<unsigned int> &near,
             const PointList<dim>            &patches,
             const double                     radius)
    {
      const Tensor<1, dim> like =
        std::get<0>(patches.template value<Patch<dim>>(first));
      Plane<dim>     plane;
      double         sum = 0.;
      Tensor<1, dim> centre;
      for (const unsigned int k : near)
        {
          const auto [normal, area, spacing, body] =
            patches.template value<Patch<dim>>(k);
          const Tensor<1, dim> way = patches.positions[k] - x;
          const double         far = way.norm() / radius;
          if (normal * like < alike_cosine || far >= 1.)
            continue;
          const double weight = area * Utilities::fixed_power<4>(1. - far);
          sum += weight;
          plane.normal += weight * normal;
          centre += weight * way;
        }
      plane.normal /= plane.normal.norm();
      plane.offset = plane.normal * (x + centre / sum);
      return plane;
    }

    /** The planes at @p x: one at the nearest patch, and where faces meet one
     *  at the nearest of those that look another way. */
    template <int dim>
    std::vector<Plane<dim>>
    planes_at(const Point<dim>                &x,
              const std::vector<unsigned int> &near,
              const PointList<dim>            &patches,
              const double                     radius)
    {
      // The nearest patch of those that are left is the next plane's first one.
      // All that look the same way as it go with it, so that what is left
      // belongs to other faces. At a corner dim faces meet, and no more count.
      std::vector<unsigned int> rest;
      for (const unsigned int k : near)
        if (x.distance(patches.positions[k]) < radius)
          rest.push_back(k);
      std::vector<Plane<dim>> planes;
      while (!rest.empty() && planes.size() < dim)
        {
          const unsigned int first =
            *std::min_element(rest.begin(),
                              rest.end(),
                              [&](const unsigned int a, const unsigned int b) {
                                return x.distance_square(patches.positions[a]) <
                                       x.distance_square(patches.positions[b]);
                              });
          const Tensor<1, dim> like =
            std::get<0>(patches.template value<Patch<dim>>(first));
          planes.push_back(plane_at(first, x, rest, patches, radius));
          rest.erase(
            std::remove_if(rest.begin(),
                           rest.end(),
                           [&](const unsigned int k) {
                             return std::get<0>(
                                      patches.template value<Patch<dim>>(k)) *
                                      like >=
                                    alike_cosine;
                           }),
            rest.end());
        }
      return planes;
    }

    /** Calls @p visit for @p y and its mirror images beyond planes that it is
     *  not deeper below than @p reach; along edges the images have images. */
    template <int dim, typename Visit>
    void
    with_images(const Point<dim>              &y,
                const std::vector<Plane<dim>> &planes,
                const double                   reach,
                const Visit                   &visit)
    {
      std::array<Point<dim>, (1 << dim)> all = {{y}}; // of dim planes at most
      unsigned int                       n   = 1;
      for (const Plane<dim> &plane : planes)
        for (unsigned int i = 0, n_before = n; i < n_before; ++i)
          if (const double depth = plane.depth(all[i]);
              depth > 0. && depth < reach)
            all[n++] = all[i] + 2. * depth * plane.normal;
      for (unsigned int i = 0; i < n; ++i)
        visit(all[i]);
    }

    /** What is left of a motion from @p x where patches are in its way. */
    template <int dim>
    Tensor<1, dim>
    inside_part(Tensor<1, dim>                   way,
                const Point<dim>                &x,
                const double                     width,
                const std::vector<unsigned int> &near_patches,
                const PointList<dim>            &patches)
    {
      for (const unsigned int k : near_patches)
        {
          const auto [normal, area, spacing, body] =
            patches.template value<Patch<dim>>(k);
          const Tensor<1, dim> to_patch = patches.positions[k] - x;
          const double         depth    = to_patch * normal;
          const double         room = std::max(0., depth - least_depth * width);
          if ((to_patch - depth * normal).norm() <= spacing && depth > -width &&
              way * normal > room)
            way -= (way * normal - room) * normal;
        }
      return way;
    }

    /** The motion of cell @p i, µm, if it takes @p share of that in the
     *  spreading time: doc/theory.md (6.9e). */
    template <int dim>
    Tensor<1, dim>
    motion_of(const SpreadAround<dim> &around,
              const unsigned int       i,
              const double             share)
    {
      // The cells around push in proportion to their volumes, and so do their
      // mirror images beyond the planes where the body ends: as if tissue went
      // on there, so that cells along an even surface stay. Then the cell takes
      // no more than the part of the way that leaves it inside.
      const Point<dim> &x           = around.cells.positions[i];
      const auto [volume, own_body] = around.cells.template value<Grain>(i);
      const unsigned int body       = own_body;
      const double       width      = std::pow(volume, 1. / dim);
      const double       H = kernel_width * std::max(width, around.mean_width);
      const auto         patches =
        near(around.patch_bins,
             around.patches,
             x,
             around.patch_reach,
             [&](const unsigned int k) {
               return std::get<3>(
                        around.patches.template value<Patch<dim>>(k)) == body;
             });
      const std::vector<Plane<dim>> planes =
        planes_at(x, patches, around.patches, around.patch_reach);
      const auto is_of_body = [&](const unsigned int k) {
        return std::get<1>(around.cells.template value<Grain>(k)) == body;
      };
      Tensor<1, dim> way;
      for (const unsigned int j :
           near(around.cell_bins, around.cells, x, 2. * H, is_of_body))
        {
          const double other =
            std::get<0>(around.cells.template value<Grain>(j));
          with_images(around.cells.positions[j],
                      planes,
                      2. * H,
                      [&](const Point<dim> &y) {
                        // a cell does not push itself, but its image does
                        if (const double r = x.distance(y); r > 0.)
                          way += other * slope(r / H) * H / r * (x - y);
                      });
        }
      way *= slope_factor<dim>(H) * share * spread_part;
      if (way.norm() > share * longest_way * width)
        way *= share * longest_way * width / way.norm();
      return inside_part(way, x, width, patches, around.patches);
    }
  } // namespace

  template <int dim>
  void
  spread_cells(Tissue<dim>               &tissue,
               const double               dt,
               const std::vector<double> &parts)
  {
    // All motions are those of the same configuration. The kernel of the
    // largest cell reaches farthest.
    const Cells<dim>          &cells  = tissue.cells();
    const BoundaryPoints<dim> &points = tissue.boundary_points();
    if (cells.has_parts())
      return;
    const MPI_Comm comm  = tissue.communicator();
    double         width = 0., spacing = 0., volume = 0.;
    for (unsigned int p = 0; p < cells.size(); ++p)
      {
        width = std::max(width, std::pow(cells.volume(p), 1. / dim));
        volume += cells.volume(p);
      }
    for (unsigned int p = 0; p < points.size(); ++p)
      spacing = std::max(spacing, points[p].spacing());
    const auto n = Utilities::MPI::sum<std::uint64_t>(cells.size(), comm);
    if (n == 0)
      return;
    const SpreadAround<dim> around(
      tissue,
      2. * kernel_width * Utilities::MPI::max(width, comm),
      Utilities::MPI::max(spacing, comm),
      std::pow(Utilities::MPI::sum(volume, comm) / n, 1. / dim));
    std::vector<Point<dim>> places = cells.positions();
    const double            part   = std::min(1., dt / spreading_time);
    for (unsigned int p = 0; p < cells.size(); ++p)
      if (const double share = part * parts[p]; share > 0.)
        places[p] += motion_of(around, p, share);
    tissue.move(places, points.positions());
  }

  MORULA_INSTANTIATE(spread_cells);
} // namespace Morula
