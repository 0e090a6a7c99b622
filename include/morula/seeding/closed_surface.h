// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_closed_surface_h
#define morula_seeding_closed_surface_h

#include <morula/base/key.h>
#include <morula/base/surface_mesh.h>
#include <morula/grid/grid_parameters.h>
#include <morula/seeding/seeding.h>

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <mpi.h>

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /** Outward unit normal of a triangle times its area, µm². */
  Tensor<1, 3>
  area_vector(const std::array<Point<3>, 3> &triangle);

  /**
   * Cuts a triangle into @p n_pieces triangles of equal area and appends them
   * to @p pieces. Each cut divides the longest edge as nearly in halves as the
   * number of pieces allows.
   */
  void
  cut_triangle(const std::array<Point<3>, 3>        &triangle,
               const std::uint64_t                   n_pieces,
               std::vector<std::array<Point<3>, 3>> &pieces);

  /**
   * Tiles a closed surface with about @p n_wished patches of about equal area.
   * Triangles larger than the mean patch are cut. Smaller ones are merged, the
   * smallest first, each into the neighbour whose centre is nearest, but never
   * across an edge sharper than 30 degrees. So more patches than wished may
   * remain. A patch has its triangles' mean normal. It lies at their common
   * centroid, moved onto the nearest of them and off its edges.
   * @param projected whether a patch's area is that along its mean normal, so
   * that areas times normals add up to zero; else it is that of the triangles,
   * and the areas add up to the surface's
   */
  std::vector<SurfacePatch<3>>
  cut_into_patches(const std::vector<SurfaceTriangle> &triangles,
                   const std::uint64_t                 n_wished,
                   const bool                          projected = false);

  /**
   * Tiles the closed surface around cells in the file that a key names: STL,
   * OFF, PLY or OBJ (see SurfaceMesh). A cavity is a surface of its own. All
   * ranks get all patches. Collective.
   * @param n_wished about so many patches; 0: as many as faces of cells
   * @throws InputError for a file that cannot be used, and where cells stand
   * outside of the surface, with their number
   */
  std::vector<SurfacePatch<3>>
  patches_of_file(const Key<std::string> &file,
                  const Founders<3>      &founders,
                  const double            n_wished,
                  const MPI_Comm          comm);

  /** Tiles that of 2-D tissue: a POLYGON or MULTIPOLYGON of well-known text
   *  (WKT), which Boost.Geometry reads. */
  std::vector<SurfacePatch<2>>
  patches_of_file(const Key<std::string> &file,
                  const Founders<2>      &founders,
                  const double            n_wished,
                  const MPI_Comm          comm);

  /** Tiles closed lines (µm), of which each repeats its first point at its
   *  end, by patches of about this length. */
  std::vector<SurfacePatch<2>>
  cut_into_patches(const std::vector<std::vector<Point<2>>> &lines,
                   const double                              length);

  /** How many patches a surface of this area (µm^(dim-1)) shall have. Refuses
   *  its file if @p is_inside does not hold for all cells. Collective.
   *  @param n_wished see patches_of_file()
   *  @throws InputError with the number of those that stand outside */
  template <int dim>
  double
  n_patches(const Key<std::string>                        &file,
            const Founders<dim>                           &founders,
            const std::function<bool(const Point<dim> &)> &is_inside,
            const double                                   area,
            const double                                   n_wished,
            const MPI_Comm                                 comm);

  /** The straight parts of the lines of well-known text (WKT) in a file, in µm.
   *  @throws InputError if the text is none */
  std::vector<std::array<Point<2>, 2>>
  read_segments(const Key<std::string> &file);


  /**
   * Tiles a surface around cells from a file: that of surface_of_cells(), which
   * encloses the sum of their volumes. The patches are those of the lattice of
   * the scene's grid, or of a finer or coarser one on which they are about as
   * many as Boundary points says. Where founders know their bodies, each body
   * has a surface of its own, see part_bodies(). Where Points surface names a
   * file, the patches tile that surface. The same to the bit on any number of
   * ranks. Collective.
   * @throws InputError if there is no surface around all cells, or if that of
   * the file leaves cells outside
   */
  template <int dim>
  SurfacePatches<dim>
  seed_points_surface(const TissueParameters &parameters,
                      const GridParameters   &grid,
                      const Founders<dim>    &founders,
                      const MPI_Comm          comm);
} // namespace Morula

#endif
