// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "seeding/room.h"

struct Moments
{
  double volume = 0., first = 0., second = 0.;
};

/** Volume, |Σ V x| and Σ V x·x of the tissue of all ranks. */
template <int dim>
Moments
moments(const Founders<dim> &founders)
{
  double         volume = 0., second = 0.;
  Tensor<1, dim> first;
  for (std::size_t i = 0; i < founders.volumes.size(); ++i)
    {
      volume += founders.volumes[i];
      first += founders.volumes[i] * founders.positions[i];
      second += founders.volumes[i] * founders.positions[i].square();
    }
  return {sum_over_ranks(volume),
          sum_over_ranks(first).norm(),
          sum_over_ranks(second)};
}

TissueParameters
sphere(const std::string &surface_cells)
{
  TissueParameters parameters;
  parameters.radius        = 83.;
  parameters.cell_spacing  = 10.;
  parameters.surface_cells = surface_cells;
  return parameters;
}


TEST_2D_3D(Trimming, GivesTheSphereItsMoments)
{
  const double R      = 83.;
  const double volume = (dim == 3 ? 4. / 3. * R : 1.) * numbers::PI * R * R;
  const double second = volume * R * R * dim / (dim + 2.);
  const auto   whole =
    moments(seed_founders<dim>(sphere("whole"), MPI_COMM_WORLD));
  const auto trimmed =
    moments(seed_founders<dim>(sphere("trimmed"), MPI_COMM_WORLD));
  EXPECT_NEAR(trimmed.volume, volume, 3e-4 * volume);
  EXPECT_LT(trimmed.first, 1e-4 * volume * 10.);
  // What is left is that each part's own second moment is missing:
  // V L_p^2 dim/12.
  EXPECT_NEAR(trimmed.second + trimmed.volume * 100. * dim / 12.,
              second,
              1e-3 * second);
  EXPECT_GT(std::abs(whole.volume - volume),
            5. * std::abs(trimmed.volume - volume));
}


TEST(Trimming, IsExactForABoxThatCutsTheSamplesEvenly)
{
  TissueParameters parameters;
  parameters.shape          = "box";
  parameters.size           = {95., 50., 40.};
  parameters.cell_spacing   = 10.;
  parameters.lattice_offset = {2.5, 0., 0.};
  parameters.surface_cells  = "trimmed";
  const auto   founders     = seed_founders<3>(parameters, MPI_COMM_WORLD);
  const double volume       = 95. * 50. * 40.;
  EXPECT_NEAR(moments(founders).volume, volume, 1e-9 * volume);
  for (std::size_t i = 0; i < founders.volumes.size(); ++i)
    {
      // A quarter box at the lower end goes to the first cells, a half one
      // is left of the last.
      const double x = founders.positions[i][0];
      const double V = x < -40. ? 1250. : x > 40. ? 1250. : 1000.;
      EXPECT_NEAR(founders.volumes[i], V, 1e-9) << x;
    }
}


TEST(Trimming, IsTheSameForAllNumbersOfRanks)
{
  const auto mine = seed_founders<3>(sphere("trimmed"), MPI_COMM_WORLD);
  const auto all  = seed_founders<3>(sphere("trimmed"), MPI_COMM_SELF);
  ASSERT_EQ(mine.n_global, all.n_global);
  for (std::size_t i = 0; i < mine.volumes.size(); ++i)
    {
      EXPECT_EQ(mine.volumes[i], all.volumes[mine.first_id + i]);
      EXPECT_EQ(mine.positions[i], all.positions[mine.first_id + i]);
    }
}


TEST(Trimming, LeavesCellsInsideAlone)
{
  const auto whole   = seed_founders<3>(sphere("whole"), MPI_COMM_SELF);
  const auto trimmed = seed_founders<3>(sphere("trimmed"), MPI_COMM_SELF);
  ASSERT_EQ(whole.positions.size(), trimmed.positions.size());
  for (std::size_t i = 0; i < whole.positions.size(); ++i)
    if (whole.positions[i].norm() < 83. - 30.)
      {
        EXPECT_EQ(trimmed.volumes[i], 1000.);
        EXPECT_LT(trimmed.positions[i].distance(whole.positions[i]), 1e-12);
      }
    else
      EXPECT_GT(trimmed.volumes[i], 400.);
}


TEST(Trimming, RefusesAPlateThatIsTooThinToSample)
{
  TissueParameters parameters;
  parameters.shape          = "box";
  parameters.size           = {50., 50., 0.5};
  parameters.cell_spacing   = 10.;
  parameters.lattice_offset = {0., 0., -4.75};
  parameters.surface_cells  = "trimmed";
  EXPECT_THROW(seed_founders<3>(parameters, MPI_COMM_WORLD), InputError);
}
