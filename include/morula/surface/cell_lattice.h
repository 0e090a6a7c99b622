// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_surface_cell_lattice_h
#define morula_surface_cell_lattice_h

#include <morula/grid/background_grid.h>
#include <morula/particles/point_list.h>

#include <array>
#include <cstdint>
#include <vector>

namespace Morula
{
  /** Nodes on one side of a surface that edges of simplices connect. */
  struct LatticePart
  {
    bool          is_inside;
    std::uint64_t first; // the lowest key
  };

  /**
   * The smoothed filling of a body's cells at the nodes of a lattice, as a
   * signed distance, which is positive inside. Cells of the lattice come in
   * blocks of 3^dim: a block is a grid cell, or one of the equal parts of one.
   */
  template <int dim>
  struct CellLattice
  {
    /** The signed distance beyond the reach of all cells, and the reach, in
     *  widths. */
    static constexpr double least = -2.2, reach = 4.;

    /** Collective. @param cells this rank's, whose only number is the volume,
     *  µm^dim */
    CellLattice(const PointList<dim> &cells, const BackgroundGrid<dim> &grid);

    /** Finds the parts inside and outside of the surface where the distance is
     *  @p level (µm). Collective. */
    void
    find_parts(const double level);

    /** Calls visit(number, index) for the lowest node of each of this rank's
     *  lattice cells, block by block. */
    template <typename Visit>
    void
    for_cells(const Visit &visit) const
    {
      for (const unsigned int block : own)
        {
          GridIndex<dim> lower = blocks.index(block), upper;
          for (unsigned int d = 0; d < dim; ++d)
            {
              lower[d] = 3 * (lower[d] - blocks.first()[d]);
              upper[d] = lower[d] + 2;
            }
          nodes.for_range(lower, upper, visit);
        }
    }

    /** Orders the nodes of all ranks, block by block. 0 is at a corner. */
    std::uint64_t
    key(const GridIndex<dim> &node) const
    {
      std::uint64_t block = 0, in_block = 0;
      for (int d = dim - 1; d >= 0; --d)
        {
          block    = block * (blocks.n()[d] + 1) + node[d] / 3;
          in_block = in_block << 2 | node[d] % 3;
        }
      return block << 2 * dim | in_block;
    }

    const MPI_Comm            comm;
    double                    volume, n_cells; // of all ranks' cells, µm^dim
    double                    width = 0.;      // s, of the smoothing, µm
    GridBox<dim>              blocks;   // the outer ones are beyond all reach
    std::vector<unsigned int> own;      // this rank's, by number
    GridBox<dim>              nodes;    // around those of own blocks
    std::vector<double>       distance; // µm, at those of own blocks
    std::array<unsigned int, 1 << dim> corners; // of a lattice cell: what is
                                                // added to its lowest node
    std::vector<LatticePart> parts; // of all ranks, by their first nodes; 0 is
                                    // the space around the body
    std::vector<unsigned int> part_of; // by node; 0 at those of others' blocks
  };
} // namespace Morula

#endif
