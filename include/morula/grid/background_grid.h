// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_background_grid_h
#define morula_grid_background_grid_h

#include <morula/grid/grid_box.h>
#include <morula/grid/grid_parameters.h>

#include <deal.II/distributed/tria.h>

#include <mpi.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace Morula
{
  /** How many points a grid cell holds. */
  struct GridCellCount
  {
    unsigned int number; // of the grid cell in the box
    unsigned int n;

    bool
    operator==(const GridCellCount &other) const
    {
      return number == other.number && n == other.n;
    }
  };

  /** Counts of grid cells, in the order of their numbers. Grid cells that are
   *  not among them hold nothing. */
  using GridCellCounts = std::vector<GridCellCount>;

  /**
   * The background grid: a Cartesian `parallel::distributed::Triangulation`
   * around the tissue. The ranks share it by the number of points in each grid
   * cell. The user gives a spacing and no box: the triangulation is kept while
   * the tissue stays inside its padding, and is made anew and larger otherwise.
   * The grid cells of the box are leaves in the middle of an octree; the tree's
   * other leaves stay coarse.
   *
   * A rank knows its own grid cells, and the owner of any other one, without a
   * table over the box: the ranks share the leaves of the octrees in the order
   * of the trees (Morton order), so that the first leaf of every rank says who
   * owns any grid cell.
   */
  template <int dim>
  class BackgroundGrid
  {
  public:
    using CellIterator = typename Triangulation<dim>::active_cell_iterator;

    /** A grid cell of the box that this rank owns. */
    struct OwnedGridCell
    {
      unsigned int number; // in the box
      CellIterator cell;   // of the triangulation
    };

    BackgroundGrid(const GridParameters &parameters, const MPI_Comm comm)
      : comm(comm)
      , h(parameters.spacing)
      , tria(comm)
    {
      for (unsigned int d = 0; d < dim; ++d)
        offset[d] = parameters.offset.value()[d];
      box_ = GridBox<dim>({}, {}, h, offset);
    }

    /**
     * Whether the grid cells first...last and their neighbours lie in the box.
     */
    bool
    covers(const GridIndex<dim> &first, const GridIndex<dim> &last) const
    {
      for (unsigned int d = 0; d < dim; ++d)
        // The neighbours of tissue must be in the box, too: splines stand on
        // them.
        if (first[d] - 1 < box_.first()[d] ||
            last[d] + 1 >= box_.first()[d] + box_.n()[d])
          return false;
      return true;
    }

    /**
     * Makes the triangulation for tissue in the grid cells first...last, with
     * padding around them.
     */
    void
    enclose(const GridIndex<dim> &first, const GridIndex<dim> &last)
    {
      GridIndex<dim> lower, n;
      for (unsigned int d = 0; d < dim; ++d)
        {
          // The padding lets the tissue grow for some steps before the
          // triangulation has to be made anew: two grid cells, and an eighth of
          // its extent on each side.
          const int padding = 2 + (last[d] - first[d] + 1) / 8;
          lower[d]          = first[d] - padding;
          n[d]              = last[d] + padding + 1 - lower[d];
        }
      make(lower, n);
    }

    /**
     * Makes the triangulation of exactly this box, e.g. that of a snapshot.
     * @param first coordinates of the first grid cell
     * @param n     number of grid cells per direction
     */
    void
    make(const GridIndex<dim> &first, const GridIndex<dim> &n);

    /**
     * Distributes the grid cells over the ranks. Collective.
     * @param weights points in grid cells of the box, each counted by one rank,
     *   which need not own it
     */
    void
    partition(const GridCellCounts &weights);

    /** This rank's part of the weights of the last partition. With the parts of
     *  all ranks the partition can be made again. */
    const GridCellCounts &
    weights() const
    {
      return weights_;
    }

    /** Sum of the weights of the last partition over all ranks. */
    double
    total_weight() const
    {
      return total_weight_;
    }

    const GridBox<dim> &
    box() const
    {
      return box_;
    }

    /** Rank that owns the grid cell of the box with this number. */
    unsigned int
    owner(const unsigned int number) const
    {
      return owner(box_.index(number));
    }

    /** Rank that owns a grid cell of the box. */
    unsigned int
    owner(const GridIndex<dim> &index) const
    {
      if (first_keys.empty())
        return 0;
      // The owner is the last rank whose first key is not behind that of the
      // grid cell.
      return std::upper_bound(first_keys.begin(),
                              first_keys.end(),
                              key(index)) -
             first_keys.begin() - 1;
    }

    /** This rank's grid cells of the box, in the order of their numbers. */
    const std::vector<OwnedGridCell> &
    owned_grid_cells() const
    {
      return owned;
    }

    /** The triangulation's cell of a grid cell that this rank owns; the
     *  triangulation's end() for one of another rank. */
    CellIterator
    grid_cell(const unsigned int number) const
    {
      const auto found = std::lower_bound(owned.begin(),
                                          owned.end(),
                                          number,
                                          [](const OwnedGridCell &grid_cell,
                                             const unsigned int   n) {
                                            return grid_cell.number < n;
                                          });
      return found != owned.end() && found->number == number ?
               found->cell :
               CellIterator(tria.end());
    }

    /**
     * The counts of this rank's grid cells, summed over all ranks. Collective.
     * @param counts of any grid cells of the box, in any order; a grid cell may
     *   be among them several times
     */
    GridCellCounts
    sum_at_owners(const GridCellCounts &counts) const;

    const Triangulation<dim> &
    triangulation() const
    {
      return tria;
    }

    MPI_Comm
    communicator() const
    {
      return comm;
    }

    /** Coordinates of the grid cell that holds @p x, in the box or not. The
     *  grid lines stand at offset + i h. */
    GridIndex<dim>
    locate(const Point<dim> &x) const
    {
      return box_.locate(x);
    }

  private:
    unsigned int
    weight(const unsigned int number) const;

    /** Finds out who owns what. Collective. */
    void
    find_owners();

    /** The place of a grid cell in the order of the trees' leaves. */
    std::uint64_t
    key(GridIndex<dim> grid_cell) const
    {
      // Coordinates in the trees, then in one of them; the tree is the highest
      // digit of the key.
      for (unsigned int d = 0; d < dim; ++d)
        grid_cell[d] -= first_of_trees[d];
      const bool second = (grid_cell[split] >> n_levels) != 0;
      if (second)
        grid_cell[split] -= 1 << n_levels;
      // Morton order: the bits of the coordinates in turn, the highest ones
      // first.
      std::uint64_t key = second != second_tree_first;
      for (int level = n_levels - 1; level >= 0; --level)
        for (int d = dim - 1; d >= 0; --d)
          key = (key << 1) | ((grid_cell[d] >> level) & 1);
      return key;
    }

    const MPI_Comm comm;
    const double   h;
    Point<dim>     offset;

    GridBox<dim>                              box_;
    parallel::distributed::Triangulation<dim> tria;
    // Two octrees of grid cells: the grid cell with the smallest coordinates,
    // the direction from the first tree to the second, and the levels: a tree
    // has 2^n_levels grid cells per direction.
    GridIndex<dim>             first_of_trees{};
    unsigned int               split             = 0;
    int                        n_levels          = 0;
    bool                       second_tree_first = false;
    std::vector<std::uint64_t> first_keys; // by rank; empty on one rank
    std::vector<OwnedGridCell> owned;
    GridCellCounts             weights_;
    double                     total_weight_ = 0.;
  };
} // namespace Morula

#endif
