// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/grid/piece_watch.h>

#include <deal.II/base/types.h>

#include <algorithm>
#include <limits>

namespace Morula
{
  namespace
  {
    constexpr unsigned int no_former = numbers::invalid_unsigned_int;

    /** Whether a piece of @p space holds grid cells of two former pieces. */
    template <int dim>
    bool
    any_joined(const SplineSpace<dim>          &space,
               const std::vector<unsigned int> &former)
    {
      std::vector<unsigned int> former_of(space.n_pieces(), no_former);
      for (unsigned int number = 0; number < former.size(); ++number)
        if (former[number] != no_former)
          {
            unsigned int &first = former_of[space.piece(number)];
            if (first == no_former)
              first = former[number];
            if (first != former[number])
              return true;
          }
      return false;
    }

    /** The middle between the two nearest grid cells of one piece that belonged
     *  to two former pieces. There must be such grid cells. */
    template <int dim>
    Point<dim>
    middle(const SplineSpace<dim>          &space,
           const std::vector<unsigned int> &former)
    {
      const GridBox<dim> &box      = space.box();
      double              shortest = std::numeric_limits<double>::max();
      Point<dim>          place;
      // A pair found at one radius can be farther apart, by the diagonal, than
      // a pair of the next radius. So the search goes one radius further than
      // the first that finds a pair.
      int last = std::numeric_limits<int>::max();
      for (int radius = 1; radius <= last; ++radius)
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
                                      space.piece(other) != space.piece(number))
                                    return;
                                  const Point<dim> there = box.center(index);
                                  if (here.distance(there) < shortest)
                                    {
                                      shortest = here.distance(there);
                                      place    = here + 0.5 * (there - here);
                                      last     = std::min(last, radius + 1);
                                    }
                                });
            }
      return place;
    }
  } // namespace

  template <int dim>
  std::vector<unsigned int>
  PieceWatch<dim>::former_pieces(const SplineSpace<dim> &space) const
  {
    std::vector<unsigned int> former(space.box().size(), no_former);
    for (unsigned int number = 0; number < former.size(); ++number)
      {
        const GridIndex<dim> index = space.box().index(number);
        if (space.piece(number) != no_former && box.contains(index))
          former[number] = pieces[box.number(index)];
      }
    return former;
  }

  template <int dim>
  std::optional<Point<dim>>
  PieceWatch<dim>::joined(const SplineSpace<dim> &space)
  {
    std::optional<Point<dim>> place;
    if (!pieces.empty())
      if (const auto former = former_pieces(space); any_joined(space, former))
        place = middle(space, former);
    box = space.box();
    pieces.resize(box.size());
    for (unsigned int number = 0; number < pieces.size(); ++number)
      pieces[number] = space.piece(number);
    return place;
  }

  template <int dim>
  unsigned int
  pieces_with_cells(const SplineSpace<dim> &space)
  {
    std::vector<char> holds_cells(space.n_pieces(), false);
    for (unsigned int number = 0; number < space.box().size(); ++number)
      if (space.piece(number) != no_former &&
          space.occupancy().n_particles(number) > 0)
        holds_cells[space.piece(number)] = true;
    return std::count(holds_cells.begin(), holds_cells.end(), true);
  }

  template class PieceWatch<2>;
  template class PieceWatch<3>;
  template unsigned int
  pieces_with_cells(const SplineSpace<2> &);
  template unsigned int
  pieces_with_cells(const SplineSpace<3> &);
} // namespace Morula
