// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_background_grid_h
#define morula_grid_background_grid_h

#include <morula/grid/grid_box.h>
#include <morula/grid/grid_parameters.h>

#include <deal.II/distributed/tria.h>

#include <vector>

namespace Morula
{
  /**
   * The background grid: a Cartesian `parallel::distributed::Triangulation`
   * around the tissue, distributed over the ranks by the number of points in
   * each grid cell. The user gives a spacing, never a box: the triangulation
   * is kept while the tissue stays inside its padding, and re-made larger
   * otherwise. The grid cells of the box are the leaves of an octree of which
   * it takes the middle; what is left of the tree stays coarse.
   *
   * Tables over the grid cells of the box (owner, fill, ...) are replicated on
   * all ranks. There are some hundred times fewer grid cells than points, so
   * that this stays small (8 MB for 10⁶ grid cells, 10⁸ points), and it lets
   * every rank classify and number the splines by itself, identically.
   */
  template <int dim>
  class BackgroundGrid
  {
  public:
    using CellIterator = typename Triangulation<dim>::active_cell_iterator;

    BackgroundGrid(const GridParameters &parameters, const MPI_Comm comm);

    /**
     * Whether grid cells first...last and their neighbours lie in the box.
     */
    bool
    covers(const GridIndex<dim> &first, const GridIndex<dim> &last) const;

    /**
     * Makes the triangulation for tissue in grid cells first...last, with
     * padding.
     */
    void
    enclose(const GridIndex<dim> &first, const GridIndex<dim> &last);

    /**
     * Makes the triangulation of exactly this box (as stored in a snapshot).
     */
    void
    make(const GridIndex<dim> &first, const GridIndex<dim> &n);

    /**
     * Distributes the grid cells over the ranks.
     * @param weights points per grid cell of the box, the same on all ranks
     */
    void
    partition(const std::vector<unsigned int> &weights);

    /** Weights of the last partition, needed to make it again. */
    const std::vector<unsigned int> &
    weights() const;

    const GridBox<dim> &
    box() const;

    /** Rank that owns the grid cell with this number. */
    unsigned int
    owner(const unsigned int number) const;

    /** The triangulation's cell; only for grid cells that this rank owns. */
    CellIterator
    grid_cell(const unsigned int number) const;

    const Triangulation<dim> &
    triangulation() const;

    MPI_Comm
    communicator() const;

    /** Grid lines stand at offset + i h; no box needed. */
    GridIndex<dim>
    locate(const Point<dim> &x) const;

  private:
    void
    tabulate();

    const MPI_Comm comm;
    const double   h;
    Point<dim>     offset;

    GridBox<dim>                              box_;
    parallel::distributed::Triangulation<dim> tria;
    std::vector<unsigned int>                 weights_;
    std::vector<unsigned int>                 owners;
    std::vector<CellIterator>                 grid_cells;
  };
} // namespace Morula

#endif
