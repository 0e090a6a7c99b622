// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/longest_cell.h>

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace Morula
{
  template <int dim>
  LongestCell<dim>::LongestCell(const double h)
    : h(h)
  {}

  template <int dim>
  double
  LongestCell<dim>::limit() const
  {
    // A cell at the limit, as in an even lattice, is not too long.
    constexpr double slack = 1e-9; // for rounding
    return h / (CellLengths::fewest - slack);
  }

  template <int dim>
  void
  LongestCell<dim>::add(const ParticleDomain<dim> &cell)
  {
    const double length = cell.length();
    if (length > longest)
      {
        longest = length;
        place   = cell.position();
      }
    if (length > limit())
      ++n_too_long;
  }

  template <int dim>
  void
  LongestCell<dim>::add(const Point<dim> &x, const DeformedCube<dim> &cell)
  {
    // Most cells are shorter than the longest so far, which a bound shows
    // without eigenvalues.
    if (!cell.is_within_length(std::min(longest, limit())))
      add(cell.at(x));
  }

  template <int dim>
  CellLengths
  LongestCell<dim>::over_all_ranks(const MPI_Comm comm) const
  {
    const auto  over_ranks = Utilities::MPI::min_max_avg(longest, comm);
    CellLengths all;
    if (over_ranks.max > 0.)
      all.min_cells_per_spacing = h / over_ranks.max;
    for (unsigned int d = 0; d < dim; ++d)
      all.place[d] = place[d];
    all.place =
      // The place is known on the rank with the longest cell.
      Utilities::MPI::broadcast(comm, all.place, over_ranks.max_index);
    all.n_too_long = Utilities::MPI::sum(n_too_long, comm);
    return all;
  }

  template class LongestCell<2>;
  template class LongestCell<3>;
} // namespace Morula
