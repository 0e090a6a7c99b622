// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_longest_cell_h
#define morula_output_longest_cell_h

#include <morula/grid/particle_domain.h>

#include <mpi.h>

#include <array>
#include <cstdint>

namespace Morula
{
  /** How long the tissue's cells are on the grid. */
  struct CellLengths
  {
    /** Grid spacing over the length of the longest cell. */
    double min_cells_per_spacing = 0.;
    /** Where that cell is, µm; in 2-D with z = 0. */
    std::array<double, 3> place{};
    /** Cells of which fewer than `fewest` fill a grid spacing. */
    std::uint64_t n_too_long = 0;

    /** One F a cell cannot hold what a grid cell's splines can do if fewer
     *  cells than these stand along it: doc/theory.md, section 2.1. */
    static constexpr double fewest = 2.;
  };

  /** Finds the longest cell. */
  template <int dim>
  class LongestCell
  {
  public:
    /** @param h grid spacing, µm */
    explicit LongestCell(const double h);

    /** Counts a cell of this rank. */
    void
    add(const ParticleDomain<dim> &cell);

    /** Over all ranks. Collective. */
    CellLengths
    over_all_ranks(const MPI_Comm comm) const;

  private:
    double        h;
    double        longest = 0.; // µm
    Point<dim>    place;
    std::uint64_t n_too_long = 0;
  };
} // namespace Morula

#endif
