// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_unknown_numbers_h
#define morula_grid_unknown_numbers_h

#include <morula/grid/background_grid.h>
#include <morula/grid/small_pieces.h>
#include <morula/grid/spline_copies.h>

#include <deal.II/base/index_set.h>

#include <map>
#include <vector>

namespace Morula
{
  /**
   * The numbers of the unknowns over all ranks. They run rank by rank, since an
   * unknown belongs to the rank that owns the grid cell on which its spline
   * stands: on each rank first the splines in the order of the grid's box, then
   * the unknowns of small pieces. A rank knows the numbers of its own unknowns,
   * and of those that it has asked for.
   */
  template <int dim>
  class UnknownNumbers
  {
  public:
    using SmallPieces = std::map<unsigned int, PiecePolynomial<dim>>;

    UnknownNumbers() = default;

    /**
     * Collective.
     * @param own copies that are unknowns of this rank
     * @param small_pieces of all ranks; their first unknowns are set
     */
    UnknownNumbers(const SplineCopies<dim>         &copies,
                   const std::vector<unsigned int> &own,
                   SmallPieces                     &small_pieces,
                   const BackgroundGrid<dim>       &grid);

    /** Asks the owners of these copies for their numbers. Collective. */
    void
    ask(const std::vector<unsigned int> &of_others,
        const SplineCopies<dim>         &copies,
        const BackgroundGrid<dim>       &grid);

    /** Whether the number of a copy is known: it is an unknown. */
    bool
    has(const unsigned int copy) const;

    /** Number of a copy's unknown. */
    unsigned int
    operator[](const unsigned int copy) const;

    /** The number of unknowns of all ranks. */
    unsigned int
    n() const
    {
      return owned_.size();
    }

    /** The unknowns of this rank. */
    const IndexSet &
    owned() const
    {
      return owned_;
    }

    /** The piece of each of this rank's unknowns, in order. */
    const std::vector<unsigned int> &
    pieces() const
    {
      return pieces_;
    }

  private:
    /** Numbers the small pieces' unknowns behind @p next, which are this
     *  rank's. Collective. */
    void
    add_small_pieces(const SplineCopies<dim>   &copies,
                     SmallPieces               &small_pieces,
                     const BackgroundGrid<dim> &grid,
                     unsigned int               next);

    std::vector<unsigned int> numbers; // by copy
    std::vector<unsigned int> pieces_;
    IndexSet                  owned_;
  };
} // namespace Morula

#endif
