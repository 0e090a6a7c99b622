// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/development.h>

#include <gtest/gtest.h>

#include <cmath>

#include "effects/small_tissue.h"

using namespace Morula;

namespace
{
  /** A small ball of cells at t = 0. */
  template <int dim>
  struct Ball : public Tissue<dim>
  {
    Ball(const CellDevelopment<dim> &growth, const bool strained)
      : Tissue<dim>(GridParameters(), growth.columns(), MPI_COMM_SELF)
    {
      this->place(founders(ball_points(Point<dim>(), 60., 20.),
                           std::pow(20., dim),
                           growth,
                           [=](const Point<dim> &x) {
                             return strained ? some_deformation<dim>(x) :
                                               unit_tensor<dim>();
                           }),
                  PointList<dim>());
    }
  };

  template <int dim>
  void
  check_isotropic()
  {
    const CellDevelopment<dim> growth(
      isotropic_growth<dim>("1 + t*(1 + X/100)"), {});
    EXPECT_TRUE(growth.present());
    EXPECT_EQ(growth.cycle(), nullptr);
    Ball<dim>  tissue(growth, true);
    const auto before = all_cells(tissue);
    const auto step   = growth.of_step(tissue, 0., 0.2);
    EXPECT_TRUE(step.present);
    ASSERT_EQ(step.current.size(), tissue.cells().size());
    for (std::size_t i = 0; i < step.current.size(); ++i)
      {
        const auto   cell = tissue.cells()[i];
        const double theta =
          1. + 0.2 * (1. + cell.founder_position()[0] / 100.);
        EXPECT_EQ(step.previous[i], unit_tensor<dim>());
        EXPECT_LE((step.current[i] - theta * unit_tensor<dim>()).norm(), 1e-15);
      }
    // A trial changes nothing.
    EXPECT_TRUE(all_cells(tissue) == before);

    grow(tissue, growth, 0., 0.2);
    const auto next = growth.of_step(tissue, 0.2, 0.3);
    EXPECT_EQ(next.previous, step.current);
    for (std::size_t i = 0; i < next.current.size(); ++i)
      {
        const auto cell = tissue.cells()[i];
        EXPECT_EQ(cell.growth(), step.current[i]);
        EXPECT_NEAR(cell.elastic_volume_ratio(),
                    determinant(cell.F()) /
                      std::pow(step.current[i][0][0], dim),
                    1e-14);
      }
  }

  template <int dim>
  void
  check_cycle()
  {
    const CellDevelopment<dim> growth({}, cell_cycle<dim>("together"));
    Ball<dim>                  tissue(growth, false);
    const Cells<dim>          &cells = tissue.cells();
    for (unsigned int p = 0; p < cells.size(); ++p)
      {
        const auto cell = cells[p];
        EXPECT_EQ(cell.growth(), unit_tensor<dim>());
        EXPECT_EQ(cell.parent(), -1);
        EXPECT_EQ(cell.generation(), 0u);
      }
    grow(tissue, growth, 0., 0.3);
    for (unsigned int p = 0; p < cells.size(); ++p)
      {
        const auto cell = cells[p];
        const auto axis = growth.clock(cell).axis;
        EXPECT_NEAR(axis.norm(), 1., 1e-12);
        EXPECT_LE((cell.growth() - unit_tensor<dim>() -
                   0.3 * outer_product(axis, axis))
                    .norm(),
                  1e-14);
      }
  }

  /** F_g = θ F_g,cycle. */
  template <int dim>
  void
  check_both()
  {
    const CellDevelopment<dim> both(isotropic_growth<dim>("1 + t"),
                                    cell_cycle<dim>("waiting"));
    const CellDevelopment<dim> cycle({}, cell_cycle<dim>("waiting"));
    Ball<dim>                  tissue(both, false);
    Ball<dim>                  other(cycle, false);
    unsigned int               n_growing = 0;
    for (const double t : {0., 0.2, 0.4, 0.6})
      {
        grow(tissue, both, t, t + 0.2);
        grow(other, cycle, t, t + 0.2);
        for (std::size_t i = 0; i < tissue.cells().size(); ++i)
          {
            const auto F_g       = tissue.cells().growth(i);
            const auto cycle_F_g = other.cells().growth(i);
            EXPECT_LE((F_g - (1.2 + t) * cycle_F_g).norm(), 1e-13);
            n_growing += determinant(cycle_F_g) > 1.01;
          }
      }
    EXPECT_GT(n_growing, 0u);
  }

  /** Grows by a tenth of what it was in each step. */
  template <int dim>
  class Compounding : public GrowthLaw<dim>
  {
  public:
    Tensor<2, dim>
    growth(const GrowingCell<dim> &cell,
           const double,
           const double) const override
    {
      EXPECT_LE((cell.elastic - unit_tensor<dim>()).norm(), 0.7);
      return 1.1 * cell.growth;
    }
  };

  /** A law sees its own growth, without that of the cycle. */
  template <int dim>
  void
  check_law_with_memory()
  {
    const CellDevelopment<dim> both(std::make_unique<const Compounding<dim>>(),
                                    cell_cycle<dim>("waiting"));
    const CellDevelopment<dim> cycle({}, cell_cycle<dim>("waiting"));
    Ball<dim>                  tissue(both, false);
    Ball<dim>                  other(cycle, false);
    double                     factor = 1.;
    for (const double t : {0., 0.2, 0.4, 0.6})
      {
        grow(tissue, both, t, t + 0.2);
        grow(other, cycle, t, t + 0.2);
        factor *= 1.1;
        for (std::size_t i = 0; i < tissue.cells().size(); ++i)
          EXPECT_LE((tissue.cells().growth(i) -
                     factor * other.cells().growth(i))
                      .norm(),
                    1e-13);
      }
  }

  /** Turns the drawn axis into one that depends on the place. */
  template <int dim>
  class AlongXOrY : public DivisionRule<dim>
  {
  public:
    Tensor<1, dim>
    axis(const CellAtOnset<dim> &cell) const override
    {
      EXPECT_NEAR(cell.random.norm(), 1., 1e-12);
      Tensor<1, dim> axis;
      axis[cell.founder_position[0] > 0.] = 7.;
      return axis;
    }
  };

  template <int dim>
  void
  check_rule()
  {
    for (const std::string start : {"together", "waiting"})
      {
        const CellDevelopment<dim> growth(
          {}, cell_cycle<dim>(start), std::make_unique<const AlongXOrY<dim>>());
        Ball<dim>    tissue(growth, false);
        unsigned int n_growing = 0;
        for (const double t : {0., 0.2, 0.4})
          {
            grow(tissue, growth, t, t + 0.2);
            for (unsigned int p = 0; p < tissue.cells().size(); ++p)
              {
                const auto cell = tissue.cells()[p];
                if (determinant(cell.growth()) < 1. + 1e-12)
                  continue;
                ++n_growing;
                Tensor<1, dim> axis;
                axis[cell.founder_position()[0] > 0.] = 1.;
                EXPECT_EQ(growth.clock(cell).axis, axis);
              }
          }
        EXPECT_GT(n_growing, 0u);
      }
  }

  /** The checkpoint sees J_e at the step's start. */
  template <int dim>
  void
  check_checkpoint()
  {
    const CellDevelopment<dim> growth({}, cell_cycle<dim>("together", "1.05"));
    Ball<dim>                  tissue(growth, true);
    std::vector<double>        J;
    for (unsigned int p = 0; p < tissue.cells().size(); ++p)
      J.push_back(determinant(tissue.cells().F(p)));
    const auto n_large = std::count_if(J.begin(), J.end(), [](const double j) {
      return j > 1.05;
    });
    ASSERT_GT(n_large, 0);
    ASSERT_LT(n_large, static_cast<int>(J.size()));
    grow(tissue, growth, 0.1, 0.3);
    for (std::size_t i = 0; i < J.size(); ++i)
      EXPECT_NEAR(determinant(tissue.cells().growth(i)),
                  J[i] > 1.05 ? 1.2 : 1.,
                  1e-12);
  }

  template <int dim>
  void
  check_none()
  {
    const CellDevelopment<dim> growth({}, {});
    EXPECT_FALSE(growth.present());
    Ball<dim>  tissue(growth, true);
    const auto before = all_cells(tissue);
    const auto step   = growth.of_step(tissue, 0., 1.);
    EXPECT_FALSE(step.present);
    EXPECT_TRUE(step.previous.empty());
    EXPECT_TRUE(step.current.empty());
    EXPECT_EQ(tissue.cells().growth(0), unit_tensor<dim>());
  }
} // namespace


TEST(CellGrowth, FollowsTheGrowthLaw){MORULA_BOTH_DIMENSIONS(check_isotropic)}


TEST(CellGrowth, FollowsTheCellCycle){MORULA_BOTH_DIMENSIONS(check_cycle)}


TEST(CellGrowth, MultipliesLawAndCycle){MORULA_BOTH_DIMENSIONS(check_both)}


TEST(CellGrowth,
     ShowsALawItsOwnGrowth){MORULA_BOTH_DIMENSIONS(check_law_with_memory)}


TEST(CellGrowth, GivesACycleTheRulesAxis){MORULA_BOTH_DIMENSIONS(check_rule)}


TEST(CellGrowth, TakesTheCheckpointAtTheStartOfTheStep){
  MORULA_BOTH_DIMENSIONS(check_checkpoint)}


TEST(CellGrowth, NothingGrowsWithoutLawAndCycle)
{
  MORULA_BOTH_DIMENSIONS(check_none)
}
