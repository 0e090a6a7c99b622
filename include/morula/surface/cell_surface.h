// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_surface_cell_surface_h
#define morula_surface_cell_surface_h

#include <morula/grid/background_grid.h>
#include <morula/particles/point_list.h>

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <cstdint>
#include <vector>

namespace Morula
{
  /** What a surface that is made from cells shall be like. */
  struct CellSurfaceWish
  {
    /** The volume that it encloses, as a share of the cells' volume. */
    double share = 1.;
    /** Cavities with less room than a cube of this edge are filled, in lengths
     *  l of the mean cell. */
    double gap = 2.;
  };

  /**
   * The surface of a body as a quadrature rule. Patches belong to the rank that
   * owns the grid cell in which they were made; all other numbers are the same
   * on all ranks, and all numbers are the same to the bit for any number of
   * ranks.
   */
  template <int dim>
  struct CellSurface
  {
    /** Of this rank's patches, µm. */
    std::vector<Point<dim>> positions;
    /** Their outward area vectors, µm^(dim-1). */
    std::vector<Tensor<1, dim>> areas;
    /** Which cavity they face: 0 is the outside, k the one with the volume
     *  cavities[k - 1]. */
    std::vector<unsigned int> faced;
    /** Their places in an order of all patches: 0, 1, ..., n_patches - 1. With
     *  the next free id added they are ids. */
    std::vector<std::uint64_t> places;
    /** Of all ranks. */
    std::uint64_t n_patches = 0;

    /** Volumes of the cavities, µm^dim. Tissue that floats in a cavity is no
     *  part of it. */
    std::vector<double> cavities;
    /** Volume of those that were filled, µm^dim. */
    double filled = 0.;
    /** How many parts the body has. */
    unsigned int n_parts = 0;
    /** What the surface encloses, µm^dim. */
    double volume = 0.;
    /** Sum of the patches' areas, µm^(dim-1). */
    double area = 0.;
    /** How far outwards the surface stands from where the smoothed filling is
     *  1/2, so that it encloses the volume, µm. */
    double offset = 0.;
    /** The spacing of the lattice, µm: h/3, or less around a body that is
     *  smaller than a grid cell. */
    double edge = 0.;
    /** l: of the mean cell, µm. */
    double cell_length = 0.;
  };

  /**
   * Makes the surface of a body from its cells, doc/theory.md (1.9), (1.10),
   * (1.11), (1.12) and (1.13): the surface of their smoothed filling that
   * encloses their volume, with about one patch for each cell of a lattice of
   * h/3 that it crosses. Bodies without cells have no patches. Collective.
   * @param cells this rank's cells of the body, in grid cells of the box; the
   *   only number of each is its volume, µm^dim
   */
  template <int dim>
  CellSurface<dim>
  surface_of_cells(const PointList<dim>      &cells,
                   const BackgroundGrid<dim> &grid,
                   const CellSurfaceWish     &wish = CellSurfaceWish());
} // namespace Morula

#endif
