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
  /** How long the cells of the tissue are, compared with the grid spacing. */
  struct CellLengths
  {
    /** Grid spacing over the length of the longest cell. */
    double min_cells_per_spacing = 0.;
    /** Position of that cell, µm; in 2-D z = 0. */
    std::array<double, 3> place{};
    /** Number of cells of which fewer than `fewest` fill a grid spacing. */
    std::uint64_t n_too_long = 0;

    /** Fewest cells along a grid spacing. With fewer cells, the splines of a
     *  grid cell can deform in ways that one F per cell does not see:
     *  doc/theory.md, section 2.1. */
    static constexpr double fewest = 2.;
  };

  /** Finds the longest cell. */
  template <int dim>
  class LongestCell
  {
  public:
    /** @param h grid spacing, µm */
    explicit LongestCell(const double h);

    /** Adds a cell of this rank. */
    void
    add(const ParticleDomain<dim> &cell);

    /** The same, of a cell at @p x, µm. Cheap, unless it may be the longest. */
    void
    add(const Point<dim> &x, const DeformedCube<dim> &cell);

    /** The result over all ranks. Collective. */
    CellLengths
    over_all_ranks(const MPI_Comm comm) const;

  private:
    /** Longer than this is too long, µm. */
    double
    limit() const;

    double        h;
    double        longest = 0.; // µm
    Point<dim>    place;
    std::uint64_t n_too_long = 0;
  };
} // namespace Morula

#endif
