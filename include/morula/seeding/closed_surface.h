// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_closed_surface_h
#define morula_seeding_closed_surface_h

#include <morula/base/key.h>
#include <morula/seeding/seeding.h>

#include <deal.II/base/point.h>

#include <mpi.h>

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace Morula
{
  using namespace dealii;

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
} // namespace Morula

#endif
