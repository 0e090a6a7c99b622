// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/near_tree.h>
#include <morula/base/send_records.h>
#include <morula/grid/piece_watch.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/types.h>

#include <algorithm>
#include <limits>
#include <map>

namespace Morula
{
  namespace
  {
    constexpr unsigned int no_former = numbers::invalid_unsigned_int;

    /** A grid cell that is active now and was active before. */
    template <int dim>
    struct Kept
    {
      GridIndex<dim> grid_cell;
      unsigned int   piece, former;
    };

    /** Tells for each piece whether it holds grid cells of two former pieces.
     *  Collective. */
    template <int dim>
    std::vector<bool>
    pieces_that_joined(const std::vector<Kept<dim>> &kept,
                       const unsigned int            n_pieces,
                       const MPI_Comm                comm)
    {
      // A piece has joined if the lowest and the highest number of its former
      // pieces differ: two reductions find that, however many ranks a piece
      // has.
      std::vector<unsigned int> lowest(n_pieces, no_former),
        highest(n_pieces, 0);
      for (const Kept<dim> &grid_cell : kept)
        {
          unsigned int &low  = lowest[grid_cell.piece];
          unsigned int &high = highest[grid_cell.piece];
          low                = std::min(low, grid_cell.former);
          high               = std::max(high, grid_cell.former);
        }
      Utilities::MPI::min(lowest, comm, lowest);
      Utilities::MPI::max(highest, comm, highest);
      std::vector<bool> joined;
      for (unsigned int piece = 0; piece < n_pieces; ++piece)
        joined.push_back(lowest[piece] != no_former &&
                         lowest[piece] != highest[piece]);
      return joined;
    }

    /** The middle between the two nearest grid cells of one piece that belonged
     *  to two former pieces. There must be such grid cells. */
    template <int dim>
    Point<dim>
    middle(const std::vector<Kept<dim>> &kept, const GridBox<dim> &lines)
    {
      // Pieces that join are near each other, so the first reaches find the
      // pair. What is within a reach holds the nearest one. The order of the
      // grid cells must not depend on the ranks.
      std::vector<Point<dim>> centers;
      for (const Kept<dim> &one : kept)
        centers.push_back(lines.center(one.grid_cell));
      const NearTree<dim> tree(centers);
      double              shortest = std::numeric_limits<double>::max();
      Point<dim>          place;
      for (double reach = 2. * lines.spacing(); shortest > reach; reach *= 2.)
        for (std::size_t i = 0; i < kept.size(); ++i)
          for (const unsigned int k : tree.within(centers[i], reach))
            if (const double distance = centers[i].distance(centers[k]);
                kept[k].former != kept[i].former &&
                kept[k].piece == kept[i].piece && distance < shortest)
              {
                shortest = distance;
                place    = centers[i] + 0.5 * (centers[k] - centers[i]);
              }
      return place;
    }
  } // namespace

  template <int dim>
  std::optional<Point<dim>>
  PieceWatch<dim>::joined(const SplineSpace<dim>    &space,
                          const BackgroundGrid<dim> &grid)
  {
    // First, the grid cells that are active now and were before get their
    // present and their former piece. A piece with two former ones has just
    // been joined. Only then, which is rare, the grid cells of such pieces are
    // gathered on all ranks, and each finds the place by itself. In the end the
    // pieces of now are remembered for the next call; the calls are collective,
    // so no rank may leave early.
    const MPI_Comm            comm = grid.communicator();
    const GridBox<dim>       &box  = space.box();
    std::optional<Point<dim>> place;
    if (n_pieces > 1) // else nothing can join
      {
        // by grid cell and body
        std::map<std::pair<unsigned int, unsigned int>, unsigned int> former;
        for (const Former &one : former_pieces(grid))
          former[{box.number(one.grid_cell), one.body}] = one.piece;
        std::vector<Kept<dim>> kept;
        for (const auto &grid_cell : space.grid_cells())
          if (const auto found =
                former.find({grid_cell.number, grid_cell.part});
              found != former.end())
            kept.push_back({box.index(grid_cell.number),
                            space.piece(grid_cell.number, grid_cell.part),
                            found->second});
        const auto joined = pieces_that_joined(kept, space.n_pieces(), comm);
        if (std::find(joined.begin(), joined.end(), true) != joined.end())
          {
            kept.erase(std::remove_if(kept.begin(),
                                      kept.end(),
                                      [&](const Kept<dim> &one) {
                                        return !joined[one.piece];
                                      }),
                       kept.end());
            // This is rare, so all ranks may look at all grid cells of the
            // joined pieces.
            std::vector<Kept<dim>> all = in_one(gather_everywhere(kept, comm));
            std::sort(all.begin(), all.end(), [](const auto &x, const auto &y) {
              return x.grid_cell < y.grid_cell;
            });
            place = middle(all, box);
          }
      }
    remembered.clear();
    n_pieces = space.n_pieces();
    for (const auto &grid_cell : space.grid_cells())
      remembered.push_back({box.index(grid_cell.number),
                            space.piece(grid_cell.number, grid_cell.part),
                            grid_cell.part});
    return place;
  }

  template <int dim>
  unsigned int
  pieces_with_cells(const SplineSpace<dim> &space, const MPI_Comm comm)
  {
    std::vector<unsigned int> holds_cells(space.n_pieces(), 0);
    for (const auto &grid_cell : space.grid_cells())
      if (space.occupancy(grid_cell.part).n_particles(space.node(grid_cell)) >
          0)
        holds_cells[space.piece(grid_cell.number, grid_cell.part)] = 1;
    Utilities::MPI::max(holds_cells, comm, holds_cells);
    return std::count(holds_cells.begin(), holds_cells.end(), 1);
  }

  template class PieceWatch<2>;
  template class PieceWatch<3>;
  MORULA_INSTANTIATE(pieces_with_cells);
} // namespace Morula
