// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  template <int dim>
  double
  spacing()
  {
    return dim == 2 ? 10. : 20.;
  }

  /** A strained ball of cells that has grown to @p t, and divided. */
  template <int dim>
  struct Division
  {
    using Cells = std::map<types::particle_index,
                           std::pair<Point<dim>, std::vector<double>>>;

    const CellDevelopment<dim> growth;
    Tissue<dim>                tissue;
    Cells                      before, after;
    types::particle_index      next_id;
    std::vector<Birth<dim>>    births;
    std::size_t                n_due;

    Division(const std::string &start, const double t, const MPI_Comm comm)
      : growth({}, cell_cycle<dim>(start))
      , tissue(GridParameters(), growth.columns(), comm)
    {
      const auto points =
        ball_points(Point<dim>(), 5. * spacing<dim>(), spacing<dim>());
      tissue.place(only_first_rank(founders(points,
                                            std::pow(spacing<dim>(), dim),
                                            growth,
                                            some_deformation<dim>),
                                   comm),
                   PointList<dim>());
      next_id           = points.size();
      const double half = 0.5 * t;
      grow(tissue, growth, 0., half);
      grow(tissue, growth, half, t);
      before         = all_cells(tissue);
      const auto due = cells_due(tissue, growth, t);
      n_due          = Utilities::MPI::sum(due.size(), comm);
      std::vector<CellEvent> events;
      births = divide(tissue, growth, due, t, next_id, events);
      after  = all_cells(tissue);
    }

    CellView<dim, const double>
    view(const std::pair<Point<dim>, std::vector<double>> &cell) const
    {
      return {ArrayView<const double>(cell.second.data(), cell.second.size()),
              growth.columns()};
    }

    /** Σ V⁰ and Σ V. */
    std::pair<double, double>
    volumes(const Cells &cells) const
    {
      std::pair<double, double> sums(0., 0.);
      for (const auto &[id, cell] : cells)
        {
          const double V0 = view(cell).initial_volume();
          sums.first += V0;
          sums.second += V0 * determinant(view(cell).F());
        }
      return sums;
    }
  };
} // namespace


TEST_2D_3D(Divide, ConservesVolume)
{
  for (const auto &[start, t] :
       {std::pair<std::string, double>("together", 0.5), {"waiting", 0.9}})
    {
      const Division<dim> division(start, t, MPI_COMM_WORLD);
      const std::size_t   n = division.before.size();
      ASSERT_GT(division.n_due, 0u);
      EXPECT_EQ(division.n_due == n, start == "together");
      EXPECT_EQ(division.after.size(), n + division.n_due);
      EXPECT_EQ(division.next_id, n + 2 * division.n_due);

      const auto [V0, V]             = division.volumes(division.before);
      const auto [V0_after, V_after] = division.volumes(division.after);
      EXPECT_NEAR(V0_after, V0, 1e-12 * V0);
      EXPECT_NEAR(V_after, V, 1e-12 * V);
    }
}


TEST_2D_3D(Divide, DaughtersInheritTheMothersState)
{
  const Division<dim>         division("waiting", 0.9, MPI_COMM_WORLD);
  const CellDevelopment<dim> &growth = division.growth;
  const std::size_t           n      = division.before.size();
  std::set<int>               mothers;
  std::set<std::uint64_t>     keys;
  double                      last_time = 0.;
  for (const auto &[id, cell] : division.after)
    {
      const auto view  = division.view(cell);
      const auto clock = growth.clock(view);
      keys.insert(clock.key);
      if (id < n)
        {
          EXPECT_TRUE(cell == division.before.at(id)); // did not divide
          continue;
        }
      ASSERT_GE(view.parent(), 0);
      mothers.insert(view.parent());
      const auto &mother_cell = division.before.at(view.parent());
      const auto  mother      = division.view(mother_cell);
      EXPECT_EQ(division.after.count(view.parent()), 0u);
      EXPECT_EQ(view.generation(), mother.generation() + 1);
      EXPECT_EQ(view.initial_volume(), 0.5 * mother.initial_volume());
      EXPECT_EQ(view.founder_position(), mother.founder_position());
      EXPECT_EQ(view.F(), mother.F());
      EXPECT_EQ(view.growth(), mother.growth());
      const auto before = growth.clock(mother);
      EXPECT_EQ(clock.event_time, before.event_time);
      EXPECT_EQ(clock.axis, before.axis);
      EXPECT_EQ(clock.growth_pre, before.growth_pre);
      EXPECT_EQ(clock.phase, CyclePhase::divided);
      // Along the axis: the first daughter on the side of -n_s.
      const Tensor<1, dim> from_mother = cell.first - mother_cell.first;
      const double         along =
        from_mother * clock.axis * ((id - n) % 2 == 0 ? -1. : 1.);
      EXPECT_GT(along, 0.);
      EXPECT_NEAR(along, from_mother.norm(), 1e-10);
      // Numbered by the time of their birth.
      const double time = clock.event_time + 0.5;
      EXPECT_GE(time, last_time);
      EXPECT_LE(time, 0.9 + 1e-9);
      last_time = time;
    }
  EXPECT_EQ(mothers.size(), division.n_due);
  EXPECT_EQ(keys.size(), division.after.size());

  EXPECT_EQ(Utilities::MPI::sum(division.births.size(), MPI_COMM_WORLD),
            2 * division.n_due);
  for (const auto &birth : division.births)
    {
      const auto &cell = division.after.at(birth.id);
      const auto  view = division.view(cell);
      EXPECT_EQ(birth.parent, view.parent());
      EXPECT_EQ(birth.generation, 1u);
      EXPECT_EQ(birth.position, cell.first);
      EXPECT_NEAR(birth.time, growth.clock(view).event_time + 0.5, 1e-15);
    }
}


// A single cell has no walls: equation (20) of the paper.
TEST(Divide, ASingleCell)
{
  const CellDevelopment<3> growth({}, cell_cycle<3>("together"));
  Tissue<3>  tissue(GridParameters(), growth.columns(), MPI_COMM_WORLD);
  const auto unstrained = [](const Point<3> &) { return unit_tensor<3>(); };
  tissue.place(only_first_rank(
                 founders<3>({Point<3>(1., 2., 3.)}, 8000., growth, unstrained),
                 MPI_COMM_WORLD),
               PointList<3>());
  grow(tissue, growth, 0., 0.5);
  types::particle_index  next_id = 1;
  std::vector<CellEvent> events;
  divide(tissue, growth, cells_due(tissue, growth, 0.5), 0.5, next_id, events);
  const auto cells = all_cells(tissue);
  ASSERT_EQ(cells.size(), 2u);
  EXPECT_NEAR(cells.at(1).first.distance(cells.at(2).first), 10., 1e-10);
  EXPECT_LT((0.5 * (Tensor<1, 3>(cells.at(1).first) + cells.at(2).first) -
             Point<3>(1., 2., 3.))
              .norm(),
            1e-10);
}
