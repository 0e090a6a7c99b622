// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/near_tree.h>
#include <morula/base/surface_mesh.h>
#include <morula/seeding/bodies.h>
#include <morula/seeding/closed_surface.h>
#include <morula/seeding/seeding.h>

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/mpi.templates.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace Morula
{
  namespace
  {
    /** A patch of a cut is inside the tissue only if on either side a cell is
     *  so near, in cell lengths: on a lattice the nearest one is at most half
     *  the diagonal of a cell away. */
    constexpr double beside_cut = 1.;

    /** Cells so near to a cut are on it, and corners so near to the surface are
     *  not outside of it, in cell lengths. */
    constexpr double on_the_cut = 1e-9, on_the_surface = 1e-6;

    /** A piece that is partly inside the tissue is halved so often, in each
     *  direction: what is missing of a cut at the surface is far less than a
     *  cell then, and no bond slips through. */
    constexpr unsigned int halvings = 3;

    /** A piece of a cut: a segment in 2-D, a triangle in 3-D. */
    template <int dim>
    using CutPiece = std::array<Point<dim>, dim>;

    template <int dim>
    Tensor<1, dim>
    vector_of(const CutPiece<dim> &piece)
    {
      if constexpr (dim == 2)
        return cross_product_2d(piece[1] - piece[0]);
      else
        return area_vector(piece);
    }

    /** Appends a piece in @p n equal ones. */
    template <int dim>
    void
    cut_piece(const CutPiece<dim>        &piece,
              const std::uint64_t         n,
              std::vector<CutPiece<dim>> &pieces)
    {
      const Tensor<1, dim> way = piece[1] - piece[0];
      if constexpr (dim == 3)
        cut_triangle(piece, n, pieces);
      else
        for (std::uint64_t k = 0; k < n; ++k)
          pieces.push_back(
            {{piece[0] + (1. * k / n) * way, piece[0] + ((k + 1.) / n) * way}});
    }

    /** All ranks' patches of a surface. */
    template <int dim>
    struct WholeSurface
    {
      /** Collective. */
      WholeSurface(const SurfacePatches<dim> &surface, const MPI_Comm comm)
        : positions(of_all_ranks(surface.positions, comm))
        , normals(of_all_ranks(surface.normals, comm))
        , tree(positions)
      {}

      /** How far @p x is above the plane of the patch that is nearest to it,
       *  µm: below it is inside. */
      double
      height(const Point<dim> &x) const
      {
        const unsigned int i = tree.nearest(x);
        return (x - positions[i]) * normals[i];
      }

      const std::vector<Point<dim>>     positions;
      const std::vector<Tensor<1, dim>> normals;
      const NearTree<dim>               tree;
    };

    /** Appends what of a piece overlaps a box, in pieces of about this area. */
    template <int dim>
    void
    divide(const CutPiece<dim>        &piece,
           const BoundingBox<dim>     &box,
           const double                area,
           std::vector<CutPiece<dim>> &pieces)
    {
      // A long piece is halved, in each direction, and what is off the tissue
      // is dropped, so that few are left of one that reaches far beyond it.
      constexpr double       large = 64.;
      const BoundingBox<dim> own(
        std::vector<Point<dim>>(piece.begin(), piece.end()));
      for (unsigned int d = 0; d < dim; ++d)
        if (own.lower_bound(d) > box.upper_bound(d) ||
            own.upper_bound(d) < box.lower_bound(d))
          return;
      const double               n = vector_of<dim>(piece).norm() / area;
      std::vector<CutPiece<dim>> parts;
      if (n < large)
        return cut_piece<dim>(piece,
                              std::max<std::uint64_t>(1, std::llround(n)),
                              pieces);
      cut_piece<dim>(piece, Utilities::pow(2, dim - 1), parts);
      for (const CutPiece<dim> &part : parts)
        divide<dim>(part, box, area, pieces);
    }

    template <int dim>
    Point<dim>
    middle_of(const CutPiece<dim> &piece)
    {
      Point<dim> x;
      for (const Point<dim> &vertex : piece)
        x += 1. / dim * vertex;
      return x;
    }

    /** Appends what of a piece is inside, in smaller pieces where its corners
     *  differ. Corners within @p tolerance (µm) of the surface are inside. */
    template <int dim>
    void
    add_inside(const CutPiece<dim>            &piece,
               const WholeSurface<dim>        &surface,
               const double                    tolerance,
               const unsigned int              more_halvings,
               std::vector<SurfacePatch<dim>> &patches)
    {
      const auto n =
        std::count_if(piece.begin(), piece.end(), [&](const Point<dim> &x) {
          return surface.height(x) < tolerance;
        });
      const bool is_middle = surface.height(middle_of<dim>(piece)) < -tolerance;
      if (more_halvings > 0 && (n != dim || !is_middle) && (n > 0 || is_middle))
        {
          std::vector<CutPiece<dim>> parts;
          cut_piece<dim>(piece, Utilities::pow(2, dim - 1), parts);
          for (const CutPiece<dim> &part : parts)
            add_inside<dim>(
              part, surface, tolerance, more_halvings - 1, patches);
        }
      else if (const Tensor<1, dim> vector = vector_of<dim>(piece);
               is_middle && vector.norm() > 0.)
        patches.push_back(
          {middle_of<dim>(piece), vector / vector.norm(), vector.norm()});
    }

    /** Adds faces to the surface. The last rank takes all of them, so that they
     *  have the highest numbers however many ranks there are. */
    template <int dim>
    void
    add_to_last_rank(const SurfacePatches<dim> &faces,
                     const MPI_Comm             comm,
                     SurfacePatches<dim>       &surface)
    {
      surface.n_global += faces.areas.size();
      if (Utilities::MPI::this_mpi_process(comm) + 1 !=
          Utilities::MPI::n_mpi_processes(comm))
        return;
      const auto append = [](auto &list, const auto &more) {
        list.insert(list.end(), more.begin(), more.end());
      };
      append(surface.positions, faces.positions);
      append(surface.normals, faces.normals);
      append(surface.areas, faces.areas);
      append(surface.bodies, faces.bodies);
    }
  } // namespace


  template <int dim>
  std::string
  add_cuts(const Key<std::string> &file,
           const Founders<dim>    &founders,
           const MPI_Comm          comm,
           SurfacePatches<dim>    &surface)
  {
    // Every rank reads the cuts, divides them into pieces as large as the
    // patches of the surface, and takes what is behind it. Then it asks its own
    // cells on which sides of each patch they stand: tissue is cut where cells
    // of any ranks are on both.
    const double area =
      sum_of_all_ranks(surface.areas, comm) / surface.n_global;
    const double                   longest = longest_length(founders, comm);
    const WholeSurface<dim>        whole(surface, comm);
    const BoundingBox<dim>         box(whole.positions);
    std::vector<SurfacePatch<dim>> patches;
    // The straight parts of the lines of a file, or its triangles.
    std::vector<CutPiece<dim>> cuts;
    if constexpr (dim == 2)
      cuts = read_segments(file);
    else
      cuts = read_triangles(file.path(), file);
    for (const CutPiece<dim> &cut : cuts)
      {
        std::vector<CutPiece<dim>> pieces;
        divide<dim>(cut, box, area, pieces);
        for (const CutPiece<dim> &piece : pieces)
          add_inside<dim>(
            piece, whole, on_the_surface * longest, halvings, patches);
      }
    const NearTree<dim>       tree(founders.positions);
    std::vector<unsigned int> sides(2 * patches.size(), 0);
    unsigned int              on_cut = 0;
    for (std::size_t k = 0; k < patches.size(); ++k)
      for (const unsigned int i :
           tree.within(patches[k].position, beside_cut * longest))
        {
          const Tensor<1, dim> distance =
            founders.positions[i] - patches[k].position;
          const double height = distance * patches[k].normal;
          if (std::abs(height) > on_the_cut * longest)
            sides[2 * k + (height > 0.)] = 1;
          else if (2. * distance.norm() <
                   std::pow(patches[k].area, 1. / (dim - 1)))
            ++on_cut;
        }
    Utilities::MPI::max(sides, comm, sides);
    on_cut = Utilities::MPI::sum(on_cut, comm);
    if (on_cut > 0)
      file.refuse("cuts in um that run between cells",
                  std::to_string(on_cut) +
                    " cells have their middle on a cut: shift it, or the "
                    "lattice of the cells, by a part of a cell.");

    SurfacePatches<dim> faces;
    for (std::size_t k = 0; k < patches.size(); ++k)
      if (sides[2 * k] + sides[2 * k + 1] == 2)
        for (const double sign : {1., -1.})
          {
            faces.add(
              {patches[k].position, sign * patches[k].normal, patches[k].area});
          }
    if (faces.areas.empty())
      file.refuse("cuts in um that run between cells",
                  "There is no place on them that has cells on both sides: do "
                  "they have the same origin and unit as the tissue?");
    faces.bodies = bodies_of_patches(faces, founders, comm);
    add_to_last_rank(faces, comm, surface);
    // Both sides of a patch have its area.
    double cut = 0.;
    for (std::size_t k = 0; k < faces.areas.size(); k += 2)
      cut += faces.areas[k];
    return as_text(cut) + (dim == 2 ? " um" : " um^2") + " in " +
           std::to_string(faces.areas.size() / 2) + " patches on each side";
  }


  MORULA_INSTANTIATE(add_cuts);
} // namespace Morula
