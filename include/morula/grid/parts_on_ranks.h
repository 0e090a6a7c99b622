// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_parts_on_ranks_h
#define morula_grid_parts_on_ranks_h

#include <mpi.h>

#include <cstdint>
#include <functional>
#include <map>
#include <vector>

namespace Morula
{
  /** A part of a grid cell (see Parting) in one number, which orders by grid
   *  cell first. */
  using NodeName = std::uint64_t;

  /** The name of a part of a grid cell of the grid's box. */
  inline NodeName
  node_name(const unsigned int grid_cell, const unsigned int part)
  {
    return (NodeName(grid_cell) << 32) | part;
  }

  /** The number of the grid cell in the grid's box. */
  inline unsigned int
  grid_cell_of(const NodeName name)
  {
    return name >> 32;
  }

  /** The part of its grid cell. */
  inline unsigned int
  part_of(const NodeName name)
  {
    return static_cast<std::uint32_t>(name);
  }

  /**
   * Joins the parts of all ranks to wholes. Parts of two ranks belong together
   * if they have a node in common. Every rank gets the list of all wholes.
   * (Boost's disjoint sets, one for each part of a rank.)
   */
  class PartsOnRanks
  {
  public:
    /** A node, and this rank's part that holds it. */
    struct NodeOfPart
    {
      NodeName     node;
      unsigned int part;
    };

    /** Nodes of other ranks that this rank's parts hold, by owner. */
    using Seen = std::map<unsigned int, std::vector<NodeOfPart>>;

    /**
     * Collective.
     * @param lowest  lowest node that this rank knows of each of its parts
     * @param part_of the part that holds a node of this rank
     */
    PartsOnRanks(const std::vector<NodeName>                       &lowest,
                 const Seen                                        &seen,
                 const std::function<unsigned int(const NodeName)> &part_of,
                 const MPI_Comm                                     comm);

    /** Number of the whole that this rank's part belongs to. */
    unsigned int
    whole_of(const unsigned int part) const;

    /** The lowest node of each whole, increasing. */
    const std::vector<NodeName> &
    lowest() const;

  private:
    std::vector<unsigned int> wholes; // of this rank's parts
    std::vector<NodeName>     lowest_;
  };
} // namespace Morula

#endif
