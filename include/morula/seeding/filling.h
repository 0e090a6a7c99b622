// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_filling_h
#define morula_seeding_filling_h

#include <morula/seeding/seeding.h>

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>
#include <deal.II/boost_adaptors/bounding_box.h>
#include <deal.II/boost_adaptors/point.h>
#include <deal.II/numerics/rtree.h>

#include <utility>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /** Places and volumes of all cells. */
  template <int dim>
  struct AllCells
  {
    /** @param length over which they are seen, µm; 0: that of the mean cell */
    AllCells(const std::vector<Point<dim>> &positions,
             const std::vector<double>     &volumes,
             const double                   length = 0.);

    const std::vector<Point<dim>> positions; // µm
    const std::vector<double>     volumes;   // µm^dim
    /** Sum of the volumes, µm^dim. */
    double volume;
    /** Over which they are seen, µm; 0 if there are no cells. */
    double length;
  };

  /**
   * The part of space that cells fill, smoothed: each cell spreads its volume
   * as a Gaussian. For cells side by side on a lattice of any direction it is 1
   * inside, to 0.5 %, and 1/2 at the surface: doc/theory.md (1.9).
   */
  template <int dim>
  class Filling
  {
  public:
    /** @param cells must outlive this */
    explicit Filling(const AllCells<dim> &cells);

    /** The value of the filling and its gradient (1/µm) at @p x (µm). */
    std::pair<double, Tensor<1, dim>>
    value_and_gradient(const Point<dim> &x) const;

    /** The value of the filling inside the tissue: the upper quartile over some
     *  cells. */
    double
    inside() const;

  private:
    using Tree = decltype(pack_rtree_of_indices(
      std::declval<const std::vector<Point<dim>> &>()));

    const AllCells<dim> &cells;
    const double         sigma;
    const Tree           tree;
  };


  /**
   * About how much room without cells a surface encloses, µm^dim: gaps and
   * cavities with room for a cell, which are narrower than what a surface
   * around points leaves open. On one rank, with all cells.
   * @param patches of a closed surface around the cells
   */
  template <int dim>
  double
  room_without_cells(const AllCells<dim>       &cells,
                     const SurfacePatches<dim> &patches);
} // namespace Morula

#endif
