// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_parts_on_ranks_h
#define morula_grid_parts_on_ranks_h

#include <mpi.h>

#include <functional>
#include <map>
#include <vector>

namespace Morula
{
  /**
   * Joins the parts of all ranks to wholes. Parts of two ranks belong together
   * if they have a grid cell in common. Every rank gets the list of all wholes.
   * (Boost's disjoint sets, one for each part of a rank.)
   */
  class PartsOnRanks
  {
  public:
    /** A grid cell, by its number in the grid's box, and this rank's part of
     *  it. */
    struct GridCellOfPart
    {
      unsigned int number, part;
    };

    /** Grid cells of other ranks that this rank's parts hold, by owner. */
    using Seen = std::map<unsigned int, std::vector<GridCellOfPart>>;

    /**
     * Collective.
     * @param lowest  lowest grid cell that this rank knows of each of its parts
     * @param part_of the part of a grid cell of this rank, by its number in the
     *        grid's box
     */
    PartsOnRanks(const std::vector<unsigned int>                       &lowest,
                 const Seen                                            &seen,
                 const std::function<unsigned int(const unsigned int)> &part_of,
                 const MPI_Comm                                         comm);

    /** Number of the whole that this rank's part belongs to. */
    unsigned int
    whole_of(const unsigned int part) const;

    /** The lowest grid cell of each whole, increasing. */
    const std::vector<unsigned int> &
    lowest() const;

  private:
    std::vector<unsigned int> wholes; // of this rank's parts
    std::vector<unsigned int> lowest_;
  };
} // namespace Morula

#endif
