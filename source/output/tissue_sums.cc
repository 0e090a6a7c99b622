// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/tissue_sums.h>

#include <deal.II/base/array_view.h>
#include <deal.II/base/mpi.h>

#include <algorithm>

namespace Morula
{
  template <int dim>
  TissueSums<dim>::Box::Box()
  {
    // An empty box: any point makes it larger on both sides.
    lower.fill(std::numeric_limits<double>::max());
    upper.fill(std::numeric_limits<double>::lowest());
  }

  template <int dim>
  void
  TissueSums<dim>::Box::include(const Point<dim> &position)
  {
    for (unsigned int d = 0; d < dim; ++d)
      {
        lower[d] = std::min(lower[d], position[d]);
        upper[d] = std::max(upper[d], position[d]);
      }
  }

  template <int dim>
  void
  TissueSums<dim>::add_cell(const CellScalars &q, const Point<dim> &position)
  {
    // Energies have the initial volume as their weight: doc/theory.md, section
    // 1.5.
    n_cells += 1.;
    initial_volume += q.initial_volume;
    total_volume += q.volume;
    grown_volume += q.initial_volume * q.growth_volume_ratio;
    energy += q.initial_volume * q.energy_density;
    energy_density_sum += q.energy_density;
    max_energy_density = std::max(max_energy_density, q.energy_density);
    min_volume_ratio   = std::min(min_volume_ratio, q.elastic_volume_ratio);
    max_volume_ratio   = std::max(max_volume_ratio, q.elastic_volume_ratio);
    cell_box.include(position);
  }

  template <int dim>
  void
  TissueSums<dim>::add_boundary_point(const Point<dim> &position)
  {
    n_boundary_points += 1.;
    boundary_box.include(position);
  }

  template <int dim>
  TissueTotals
  TissueSums<dim>::totals(const MPI_Comm comm) const
  {
    // One reduction for all sums; extremes take their own. Without cells, as at
    // the end of a tissue that dies out, there is nothing to divide by. The
    // extent is that of the surface, or of the cells where a scene has no
    // boundary points.
    std::array<double, 7> sums = {{n_cells,
                                   initial_volume,
                                   total_volume,
                                   grown_volume,
                                   energy,
                                   energy_density_sum,
                                   n_boundary_points}};
    Utilities::MPI::sum(ArrayView<const double>(sums.data(), sums.size()),
                        comm,
                        ArrayView<double>(sums.data(), sums.size()));

    TissueTotals all;
    if (sums[0] == 0.)
      return all;
    all.total_volume             = sums[2];
    all.grown_volume             = sums[3];
    all.mean_energy_density      = sums[4] / sums[1];
    all.cell_mean_energy_density = sums[5] / sums[0];
    all.max_energy_density = Utilities::MPI::max(max_energy_density, comm);
    all.min_elastic_volume_ratio = Utilities::MPI::min(min_volume_ratio, comm);
    all.max_elastic_volume_ratio = Utilities::MPI::max(max_volume_ratio, comm);

    const Box &box = sums[6] > 0. ? boundary_box : cell_box;
    for (unsigned int d = 0; d < dim; ++d)
      {
        all.lower[d] = Utilities::MPI::min(box.lower[d], comm);
        all.upper[d] = Utilities::MPI::max(box.upper[d], comm);
      }
    return all;
  }

  template class TissueSums<2>;
  template class TissueSums<3>;
} // namespace Morula
