// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/surface_mesh.h>
#include <morula/seeding/points_file.h>
#include <morula/seeding/reviews.h>

#include <deal.II/base/mpi.h>
#include <deal.II/boost_adaptors/point.h>
#include <deal.II/numerics/rtree.h>

#include <boost/algorithm/string/join.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Morula
{
  namespace
  {
    /** Usual distances of nearest cells, in units of their length. */
    constexpr double nearest_usual = 0.5, farthest_usual = 2.;

    /** Tissue of fewer cells along its longest axis was hardly meant. */
    constexpr double fewest_cells = 3.;

    /** Some founders, equally spaced in the order of ids, the same on all
     *  ranks: position and length of each. */
    template <int dim>
    std::vector<std::pair<Point<dim>, double>>
    sample(const Founders<dim> &founders, const MPI_Comm comm)
    {
      constexpr std::uint64_t most  = 1000;
      const std::uint64_t     n     = founders.n_global;
      const std::uint64_t     every = std::max<std::uint64_t>(1, n / most);
      std::vector<double>     mine;
      // Ids of a rank follow each other, so every n-th is known without asking.
      for (std::size_t i = 0; i < founders.positions.size(); ++i)
        if ((founders.first_id + i) % every == 0)
          {
            for (unsigned int d = 0; d < dim; ++d)
              mine.push_back(founders.positions[i][d]);
            mine.push_back(std::pow(founders.volumes[i], 1. / dim));
          }
      std::vector<std::pair<Point<dim>, double>> result;
      for (const auto &numbers : Utilities::MPI::all_gather(comm, mine))
        for (std::size_t k = 0; k < numbers.size(); k += dim + 1)
          {
            Point<dim> x;
            for (unsigned int d = 0; d < dim; ++d)
              x[d] = numbers[k + d];
            result.emplace_back(x, numbers[k + dim]);
          }
      return result;
    }

    /** Median over a sample of the distance to the nearest other founder, of
     *  whichever rank, in units of the founder's length. */
    template <int dim>
    double
    median_distance(const Founders<dim> &founders, const MPI_Comm comm)
    {
      const auto          chosen = sample(founders, comm);
      const auto          tree   = pack_rtree(founders.positions);
      std::vector<double> distances;
      for (const auto &[x, length] : chosen)
        {
          // The nearest founder may be of any rank: each rank looks among its
          // own, and the minimum over all is right.
          // Of the two nearest on its own rank one may be the founder itself.
          // No other one stands at its place.
          double                  shortest = std::numeric_limits<double>::max();
          std::vector<Point<dim>> found;
          tree.query(boost::geometry::index::nearest(x, 2),
                     std::back_inserter(found));
          for (const Point<dim> &y : found)
            if (y != x)
              shortest = std::min(shortest, x.distance(y) / length);
          distances.push_back(shortest);
        }
      Utilities::MPI::min(distances, comm, distances);
      const auto middle = distances.begin() + distances.size() / 2;
      std::nth_element(distances.begin(), middle, distances.end());
      return *middle;
    }

    /** Usual part of the cells' volume by which that within the surface around
     *  them differs. */
    constexpr double most_off = 0.1;

    /** The same of cells on a lattice, which fits a shape to a percent or so.
     */
    constexpr double most_off_of_lattice = 0.03;

    /** The volume within the surface in units of the founders' volume. */
    template <int dim>
    double
    enclosed_over_cells(const Founders<dim>       &founders,
                        const SurfacePatches<dim> &surface,
                        const MPI_Comm             comm)
    {
      double enclosed = 0., cells = 0.;
      for (std::size_t i = 0; i < surface.areas.size(); ++i)
        // By the divergence theorem the patches give the volume.
        enclosed +=
          surface.areas[i] / dim * (surface.normals[i] * surface.positions[i]);
      for (const double V : founders.volumes)
        cells += V;
      return Utilities::MPI::sum(enclosed, comm) /
             Utilities::MPI::sum(cells, comm);
    }

    /** So many times as many boundary points as cells of a smooth surface are
     *  too many: they only cost time. */
    constexpr double too_many = 3.;

    /** Warns of a surface from a file whose edges are those of voxels. Patches
     *  do not reach across sharp edges. */
    template <int dim>
    void
    review_patches(const TissueParameters    &tissue,
                   const Founders<dim>       &founders,
                   const SurfacePatches<dim> &surface,
                   const MPI_Comm             comm,
                   Review                    &review)
    {
      if (!tissue.has_surface_file() || tissue.boundary_points > 0)
        return;
      double volume = 0., area = 0.;
      for (const double V : founders.volumes)
        volume += V;
      for (const double A : surface.areas)
        area += A;
      const double patch =
        std::pow(Utilities::MPI::sum(volume, comm) / founders.n_global,
                 double(dim - 1) / dim);
      // As many patches as faces of cells would cover the area.
      const double wished = Utilities::MPI::sum(area, comm) / patch;
      if (surface.n_global > too_many * wished)
        review.warn(tissue.points_surface.path(),
                    tissue.points_surface,
                    "it becomes " + std::to_string(surface.n_global) +
                      " boundary points, where " + as_text(std::round(wished)) +
                      " are as large as a cell: patches end at edges sharper "
                      "than 30 degrees, such as those of voxels.",
                    "Smooth the surface; contrib/import does so with images.");
    }

    /** Largest distance of founders along an axis, and a cell. */
    template <int dim>
    double
    longest_extent(const Founders<dim> &founders,
                   const double         cell,
                   const MPI_Comm       comm)
    {
      double longest = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        {
          double lower = std::numeric_limits<double>::max(), upper = -lower;
          for (const Point<dim> &X : founders.positions)
            {
              lower = std::min(lower, X[d]);
              upper = std::max(upper, X[d]);
            }
          longest = std::max(longest,
                             Utilities::MPI::max(upper, comm) -
                               Utilities::MPI::min(lower, comm));
        }
      return longest + cell;
    }

    /** Usual lengths of cells, µm: bacteria have 1, egg cells 100. */
    constexpr double shortest_usual = 0.5, longest_usual = 300.;

    /** Warns of cells of which places and volumes are both in another unit, so
     *  that they fit each other. */
    template <int dim>
    void
    review_length(const Key<std::string> &file,
                  const Founders<dim>    &founders,
                  const MPI_Comm          comm,
                  Review                 &review)
    {
      double volume = 0.;
      for (const double V : founders.volumes)
        volume += V;
      const double length =
        std::pow(Utilities::MPI::sum(volume, comm) / founders.n_global,
                 1. / dim);
      if (length < shortest_usual || length > longest_usual)
        review.warn(file.path(),
                    file,
                    "its cells are " + as_text(length) +
                      " um long, where 5 to 50 is usual. Is it in another "
                      "unit than um, such as m, mm or nm?",
                    "Scale places to um and volumes to um^3 (2-D: um^2).");
    }
  } // namespace


  template <int dim>
  void
  review_units(const TissueParameters    &tissue,
               const Founders<dim>       &founders,
               const SurfacePatches<dim> &surface,
               const MPI_Comm             comm,
               Review                    &review)
  {
    // The units of a file are not known, but sizes that cannot be in µm show:
    // distances of neighbours in lengths of cells, the volume in the surface,
    // the number of cells along the tissue. Each is found over all ranks and
    // gives a warning with what is usual.
    if (tissue.is_points())
      {
        review_points_file<dim>(tissue.points_file, review);
        review_length(tissue.points_file, founders, comm, review);
      }
    if (tissue.is_points() && founders.n_global > 1)
      {
        const double ratio = median_distance(founders, comm);
        if (ratio < nearest_usual || ratio > farthest_usual)
          review.warn(
            tissue.points_file.path(),
            tissue.points_file,
            "the nearest cell is, in the median, " + as_text(ratio) +
              " of a cell's length away, where 0.5 to 2 is usual: cells " +
              (ratio < nearest_usual ? "overlap" : "leave gaps") +
              ". Is the file in another unit than um?",
            "If so, scale it to um; else set Tissue/Cell spacing to the length "
            "of the cells, or give each its volume in the file.");
      }
    if (tissue.is_points() && surface.n_global > 0)
      {
        const double ratio = enclosed_over_cells(founders, surface, comm);
        if (std::abs(ratio - 1.) > most_off)
          review.warn(tissue.points_file.path(),
                      tissue.points_file,
                      "the surface around the cells encloses " +
                        as_text(ratio) +
                        " times their volume: a pressure on it squeezes them "
                        "by so many times that pressure.",
                      "Give each cell its volume in the file, or set "
                      "Tissue/Cell spacing to the length of the cells.");
        if (surface.closed_room > 0.)
          review.warn(tissue.closed_gap.path(),
                      as_text(tissue.closed_gap) + " cell lengths",
                      "the surface around the cells has closed gaps or "
                      "cavities: it encloses about " +
                        as_text(surface.closed_room) +
                        (dim == 3 ? " um^3" : " um^2") +
                        " in which no cell is, and lies closer to the cells "
                        "elsewhere for it.",
                      "Lower this key, or fill the holes, or give the surface "
                      "as a file in Tissue/Points surface.");
        review_patches(tissue, founders, surface, comm, review);
      }
    if (!tissue.is_points() && surface.n_global > 0 &&
        tissue.surface_cells == "whole")
      {
        const double ratio = enclosed_over_cells(founders, surface, comm);
        if (std::abs(1. / ratio - 1.) > most_off_of_lattice)
          review.warn(tissue.cell_spacing.path(),
                      as_text(tissue.cell_spacing) + " um",
                      "the lattice does not fit the shape: its cells have " +
                        as_text(1. / ratio) + " of the shape's volume.",
                      "Choose a spacing that divides the shape, a smaller one, "
                      "or Tissue/Surface cells = trimmed.");
      }
    if (tissue.is_mesh())
      {
        review_mesh(TissueKeys::surface_mesh, tissue.surface_mesh, review);
        const double extent =
          longest_extent(founders, tissue.cell_spacing, comm);
        if (extent < fewest_cells * tissue.cell_spacing)
          review.warn(tissue.surface_mesh.path(),
                      tissue.surface_mesh,
                      "the tissue is only " +
                        as_text(std::round(extent / tissue.cell_spacing)) +
                        " cells long, " + as_text(extent) +
                        " um. Is the file in another unit than um?",
                      "If so, scale it to um, such as by 1000 from mm; else "
                      "choose a smaller Tissue/Cell spacing.");
      }
  }


  void
  review_unused(const TissueParameters &tissue, Review &review)
  {
    // Keys of other shapes are no error, as one changes shapes to and fro; but
    // what has been set and does nothing is worth saying.
    const std::vector<std::string> solid = {
      "sphere", "box", "ellipsoid", "cylinder", "mesh"};
    const std::vector<std::pair<const AnyKey *, std::vector<std::string>>>
      shapes_of = {{&tissue.radius, {"sphere", "cylinder"}},
                   {&tissue.inner_radius, {"sphere"}},
                   {&tissue.size, {"box", "ellipsoid", "cylinder"}},
                   {&tissue.center, solid},
                   {&tissue.lattice_offset, solid},
                   {&tissue.surface_cells, solid},
                   {&tissue.points_surface, {"points"}},
                   {&tissue.closed_gap, {"points"}}};
    for (const auto &[key, shapes] : shapes_of)
      if (!key->is_default() && review.has_set(*key) &&
          std::count(shapes.begin(), shapes.end(), tissue.shape.value()) == 0)
        review.warn(key->path(),
                    key->text(),
                    "it has no effect on Tissue/Shape = " + tissue.shape + ".",
                    "Remove it, or choose one of the shapes " +
                      boost::join(shapes, ", ") + ".");
  }


  MORULA_INSTANTIATE(review_units);
} // namespace Morula
