// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_tissue_sums_h
#define morula_output_tissue_sums_h

#include <morula/output/cell_fields.h>

#include <deal.II/base/point.h>

#include <mpi.h>

#include <array>
#include <limits>

namespace Morula
{
  using namespace dealii;

  /** Sums and extremes over all cells, for statistics.csv. */
  struct TissueTotals
  {
    double total_volume             = 0.; // Σ V⁰ det F, µm^dim
    double grown_volume             = 0.; // Σ V⁰ det F_g, µm^dim
    double mean_energy_density      = 0.; // weighted by V⁰, kPa
    double cell_mean_energy_density = 0.; // each cell counted once, kPa
    double max_energy_density       = 0.; // kPa
    double min_elastic_volume_ratio = 0.;
    double max_elastic_volume_ratio = 0.;
    /**
     * Smallest and largest coordinates of the boundary points, or of the cells
     * if there are no boundary points, µm. In 2-D z is 0.
     */
    std::array<double, 3> lower = {{0., 0., 0.}};
    std::array<double, 3> upper = {{0., 0., 0.}};
  };

  /** Collects TissueTotals point by point. */
  template <int dim>
  class TissueSums
  {
  public:
    /** Adds one of this rank's cells. */
    void
    add_cell(const CellScalars &quantities, const Point<dim> &position);

    /** Adds one of this rank's boundary points. */
    void
    add_boundary_point(const Point<dim> &position);

    /** The totals over all ranks' points. Collective. */
    TissueTotals
    totals(const MPI_Comm comm) const;

  private:
    /** Smallest box around points. Without points, lower is above upper. */
    struct Box
    {
      Box();

      /** Widens the box so that it holds @p position. */
      void
      include(const Point<dim> &position);

      std::array<double, dim> lower;
      std::array<double, dim> upper;
    };

    double n_cells            = 0.;
    double initial_volume     = 0.;
    double total_volume       = 0.;
    double grown_volume       = 0.;
    double energy             = 0.; // Σ V⁰ Ψ
    double energy_density_sum = 0.; // Σ Ψ
    double max_energy_density = std::numeric_limits<double>::lowest();
    double min_volume_ratio   = std::numeric_limits<double>::max();
    double max_volume_ratio   = std::numeric_limits<double>::lowest();
    double n_boundary_points  = 0.;
    Box    cell_box;
    Box    boundary_box;
  };
} // namespace Morula

#endif
