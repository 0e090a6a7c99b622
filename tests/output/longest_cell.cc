// ranks: 1 2 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/longest_cell.h>

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

using namespace Morula;

namespace
{
  /** A cell at @p x of 10 µm, stretched by @p stretch along a diagonal. */
  template <int dim>
  ParticleDomain<dim>
  cell(const double x, const double stretch)
  {
    Tensor<1, dim> e;
    e[0] = 0.6;
    e[1] = -0.8;
    const Tensor<2, dim> A =
      10. * (Tensor<2, dim>(unit_symmetric_tensor<dim>()) +
             (stretch - 1.) * outer_product(e, e));
    Point<dim> position;
    position[0]       = x;
    position[dim - 1] = -x;
    return ParticleDomain<dim>(position, A);
  }

  /** Cells 0 to 11, stretched by 1 to 2.65, in turn on the ranks. */
  template <int dim>
  void
  check_lengths()
  {
    const unsigned int rank = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
    const unsigned int n_ranks =
      Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
    LongestCell<dim> cells(40.);
    for (unsigned int i = 0; i < 12; ++i)
      if (i % n_ranks == rank)
        cells.add(cell<dim>(i, 1. + 0.15 * i));
    const CellLengths all = cells.over_all_ranks(MPI_COMM_WORLD);
    EXPECT_NEAR(all.min_cells_per_spacing, 4. / 2.65, 1e-12);
    EXPECT_DOUBLE_EQ(all.place[0], 11.);
    EXPECT_DOUBLE_EQ(all.place[dim - 1], -11.);
    EXPECT_EQ(all.n_too_long, 5u); // 2.05, 2.2, 2.35, 2.5, 2.65
  }
} // namespace


TEST(LongestCell, IsFoundOnAllRanks)
{
  check_lengths<2>();
  check_lengths<3>();
}


TEST(LongestCell, ExactlyTwoPerSpacingAreEnough)
{
  LongestCell<2> cells(20.);
  cells.add(cell<2>(0., 1.));
  EXPECT_EQ(cells.over_all_ranks(MPI_COMM_SELF).n_too_long, 0u);
}
