// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
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
      // Kept grid cells are put into a table over the box around them, so that
      // each looks at its neighbours by radius: pieces that join are near each
      // other, so the first radii find the pair.
      GridIndex<dim> first = kept[0].grid_cell, last = first, n;
      for (const Kept<dim> &one : kept)
        for (unsigned int d = 0; d < dim; ++d)
          {
            first[d] = std::min(first[d], one.grid_cell[d]);
            last[d]  = std::max(last[d], one.grid_cell[d]);
          }
      for (unsigned int d = 0; d < dim; ++d)
        n[d] = last[d] - first[d] + 1;
      const GridBox<dim>        box(first,
                             n,
                             lines.spacing(),
                             lines.corner(GridIndex<dim>{}));
      std::vector<unsigned int> former(box.size(), no_former),
        piece(box.size(), no_former);
      for (const Kept<dim> &one : kept)
        {
          former[box.number(one.grid_cell)] = one.former;
          piece[box.number(one.grid_cell)]  = one.piece;
        }

      double     shortest = std::numeric_limits<double>::max();
      Point<dim> place;
      // A pair found at one radius can be farther apart, by the diagonal, than
      // a pair of the next radius. So the search goes one radius further than
      // the first that finds a pair.
      int last_radius = std::numeric_limits<int>::max();
      for (int radius = 1; radius <= last_radius; ++radius)
        for (unsigned int number = 0; number < former.size(); ++number)
          if (former[number] != no_former)
            {
              const Point<dim> here = box.center(box.index(number));
              box.for_neighbors(box.index(number),
                                radius,
                                [&](const unsigned int    other,
                                    const GridIndex<dim> &index) {
                                  if (former[other] == no_former ||
                                      former[other] == former[number] ||
                                      piece[other] != piece[number])
                                    return;
                                  const Point<dim> there = box.center(index);
                                  if (here.distance(there) < shortest)
                                    {
                                      shortest = here.distance(there);
                                      place    = here + 0.5 * (there - here);
                                      last_radius =
                                        std::min(last_radius, radius + 1);
                                    }
                                });
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
            std::vector<Kept<dim>> all;
            for (const auto &list : gather_everywhere(kept, comm))
              all.insert(all.end(), list.begin(), list.end());
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
