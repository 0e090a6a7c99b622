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
   * around the tissue. The ranks share it by the number of points in each grid
   * cell. The user gives a spacing and no box: the triangulation is kept while
   * the tissue stays inside its padding, and is made anew and larger otherwise.
   * The grid cells of the box are leaves in the middle of an octree; the tree's
   * other leaves stay coarse.
   *
   * Every rank has tables over all grid cells of the box (owner, fill, ...).
   * They are small, since grid cells are some hundred times fewer than points
   * (8 MB for 10⁶ grid cells, 10⁸ points). With them every rank classifies and
   * numbers the splines by itself, with the same result.
   */
  template <int dim>
  class BackgroundGrid
  {
  public:
    using CellIterator = typename Triangulation<dim>::active_cell_iterator;

    BackgroundGrid(const GridParameters &parameters, const MPI_Comm comm);

    /**
     * Whether the grid cells first...last and their neighbours lie in the box.
     */
    bool
    covers(const GridIndex<dim> &first, const GridIndex<dim> &last) const;

    /**
     * Makes the triangulation for tissue in the grid cells first...last, with
     * padding around them.
     */
    void
    enclose(const GridIndex<dim> &first, const GridIndex<dim> &last);

    /**
     * Makes the triangulation of exactly this box, e.g. that of a snapshot.
     * @param first coordinates of the first grid cell
     * @param n     number of grid cells per direction
     */
    void
    make(const GridIndex<dim> &first, const GridIndex<dim> &n);

    /**
     * Distributes the grid cells over the ranks. Collective.
     * @param weights points per grid cell of the box, equal on all ranks
     */
    void
    partition(const std::vector<unsigned int> &weights);

    /** Weights of the last partition. With them it can be made again. */
    const std::vector<unsigned int> &
    weights() const;

    const GridBox<dim> &
    box() const;

    /** Rank that owns the grid cell with this number. */
    unsigned int
    owner(const unsigned int number) const;

    /** The triangulation's cell of a grid cell that this rank owns. */
    CellIterator
    grid_cell(const unsigned int number) const;

    const Triangulation<dim> &
    triangulation() const;

    MPI_Comm
    communicator() const;

    /** Coordinates of the grid cell that holds @p x, in the box or not. The
     *  grid lines stand at offset + i h. */
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
