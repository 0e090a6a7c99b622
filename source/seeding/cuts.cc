// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/near_tree.h>
#include <morula/base/surface_mesh.h>
#include <morula/seeding/bodies.h>
#include <morula/seeding/closed_surface.h>
#include <morula/seeding/mesh_patches.h>
#include <morula/seeding/seeding.h>

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/mpi.templates.h>
#include <deal.II/boost_adaptors/point.h>
#include <deal.II/numerics/rtree.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
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

    Tensor<1, 2>
    vector_of(const CutPiece<2> &piece)
    {
      return cross_product_2d(piece[1] - piece[0]);
    }

    Tensor<1, 3>
    vector_of(const CutPiece<3> &piece)
    {
      return area_vector(piece);
    }

    /** Appends a piece in @p n equal ones. */
    void
    cut_piece(const CutPiece<2>        &piece,
              const std::uint64_t       n,
              std::vector<CutPiece<2>> &pieces)
    {
      const Tensor<1, 2> way = piece[1] - piece[0];
      for (std::uint64_t k = 0; k < n; ++k)
        pieces.push_back(
          {{piece[0] + (1. * k / n) * way, piece[0] + ((k + 1.) / n) * way}});
    }

    void
    cut_piece(const CutPiece<3>        &piece,
              const std::uint64_t       n,
              std::vector<CutPiece<3>> &pieces)
    {
      cut_triangle(piece, n, pieces);
    }

    /** The side of a surface's patches on which a place is. */
    template <int dim>
    class InsideOf
    {
    public:
      /** Collective. */
      InsideOf(const SurfacePatches<dim> &surface,
               const double               tolerance,
               const MPI_Comm             comm)
        : positions(of_all_ranks(surface.positions, comm))
        , normals(of_all_ranks(surface.normals, comm))
        , tree(pack_rtree_of_indices(positions))
        , box_(positions)
        , tolerance(tolerance)
      {}

      /** What is outside of it is outside of the surface. */
      const BoundingBox<dim> &
      box() const
      {
        return box_;
      }

      /** Whether @p x is behind the patch that is nearest to it, or on its
       *  plane. */
      bool
      operator()(const Point<dim> &x) const
      {
        return height(x) < tolerance;
      }

      /** The same, but not on its plane. */
      bool
      truly(const Point<dim> &x) const
      {
        return height(x) < -tolerance;
      }

    private:
      double
      height(const Point<dim> &x) const
      {
        std::vector<unsigned int> nearest;
        tree.query(boost::geometry::index::nearest(x, 1),
                   std::back_inserter(nearest));
        const unsigned int i = nearest.at(0);
        return (x - positions[i]) * normals[i];
      }

      const std::vector<Point<dim>>                       positions;
      const std::vector<Tensor<1, dim>>                   normals;
      const decltype(pack_rtree_of_indices(
        std::declval<const std::vector<Point<dim>> &>())) tree;
      const BoundingBox<dim>                              box_;
      const double                                        tolerance; // µm
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
      const double               n = vector_of(piece).norm() / area;
      std::vector<CutPiece<dim>> parts;
      if (n < large)
        return cut_piece(piece,
                         std::max<std::uint64_t>(1, std::llround(n)),
                         pieces);
      cut_piece(piece, Utilities::pow(2, dim - 1), parts);
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
     *  differ. */
    template <int dim>
    void
    add_inside(const CutPiece<dim>            &piece,
               const InsideOf<dim>            &is_inside,
               const unsigned int              more_halvings,
               std::vector<SurfacePatch<dim>> &patches)
    {
      const auto n         = std::count_if(piece.begin(),
                                   piece.end(),
                                   [&is_inside](const Point<dim> &x) {
                                     return is_inside(x);
                                   });
      const bool is_middle = is_inside.truly(middle_of<dim>(piece));
      if (more_halvings > 0 && (n != dim || !is_middle) && (n > 0 || is_middle))
        {
          std::vector<CutPiece<dim>> parts;
          cut_piece(piece, Utilities::pow(2, dim - 1), parts);
          for (const CutPiece<dim> &part : parts)
            add_inside<dim>(part, is_inside, more_halvings - 1, patches);
        }
      else if (const Tensor<1, dim> vector = vector_of(piece);
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
    double area = 0., longest = 0.;
    for (const double a : surface.areas)
      area += a;
    for (const double V : founders.volumes)
      longest = std::max(longest, std::pow(V, 1. / dim));
    area    = Utilities::MPI::sum(area, comm) / surface.n_global;
    longest = Utilities::MPI::max(longest, comm);
    const InsideOf<dim> is_inside(surface, on_the_surface * longest, comm);
    std::vector<SurfacePatch<dim>> patches;
    // The straight parts of the lines of a file, or its triangles.
    std::vector<CutPiece<dim>> cuts;
    if constexpr (dim == 2)
      cuts = read_segments(file);
    else
      cuts = read_triangles(file.path(), file);
    for (const CutPiece<dim> &whole : cuts)
      {
        std::vector<CutPiece<dim>> pieces;
        divide<dim>(whole, is_inside.box(), area, pieces);
        for (const CutPiece<dim> &piece : pieces)
          add_inside<dim>(piece, is_inside, halvings, patches);
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
            faces.positions.push_back(patches[k].position);
            faces.normals.push_back(sign * patches[k].normal);
            faces.areas.push_back(patches[k].area);
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
