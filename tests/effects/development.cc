// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
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
} // namespace


TEST_2D_3D(CellGrowth, FollowsTheGrowthLaw)
{
  const CellDevelopment<dim> growth(isotropic_growth<dim>("1 + t*(1 + X/100)"),
                                    {});
  EXPECT_TRUE(growth.present());
  EXPECT_EQ(growth.cycle(), nullptr);
  SmallBall<dim> tissue(growth, true);
  const auto     before = all_cells(tissue);
  const auto     step   = growth.of_step(tissue, 0., 0.2);
  EXPECT_TRUE(step.present);
  ASSERT_EQ(step.current.size(), tissue.cells().size());
  for (std::size_t i = 0; i < step.current.size(); ++i)
    {
      const auto   cell  = tissue.cells()[i];
      const double theta = 1. + 0.2 * (1. + cell.founder_position()[0] / 100.);
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
                  determinant(cell.F()) / std::pow(step.current[i][0][0], dim),
                  1e-14);
    }
}


/** A law sees its own growth, without that of the cycle. */
TEST_2D_3D(CellGrowth, ShowsALawItsOwnGrowth)
{
  const CellDevelopment<dim> both(std::make_unique<const Compounding<dim>>(),
                                  cell_cycle<dim>("waiting"));
  const CellDevelopment<dim> cycle({}, cell_cycle<dim>("waiting"));
  SmallBall<dim>             tissue(both, false);
  SmallBall<dim>             other(cycle, false);
  double                     factor = 1.;
  for (const double t : {0., 0.2, 0.4, 0.6})
    {
      grow(tissue, both, t, t + 0.2);
      grow(other, cycle, t, t + 0.2);
      factor *= 1.1;
      for (std::size_t i = 0; i < tissue.cells().size(); ++i)
        EXPECT_LE((tissue.cells()[i].growth() -
                   factor * other.cells()[i].growth())
                    .norm(),
                  1e-13);
    }
}


TEST_2D_3D(CellGrowth, GivesACycleTheRulesAxis)
{
  for (const std::string start : {"together", "waiting"})
    {
      const CellDevelopment<dim> growth(
        {}, cell_cycle<dim>(start), std::make_unique<const AlongXOrY<dim>>());
      SmallBall<dim> tissue(growth, false);
      unsigned int   n_growing = 0;
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
TEST_2D_3D(CellGrowth, TakesTheCheckpointAtTheStartOfTheStep)
{
  const CellDevelopment<dim> growth({}, cell_cycle<dim>("together", "1.05"));
  SmallBall<dim>             tissue(growth, true);
  std::vector<double>        J;
  for (unsigned int p = 0; p < tissue.cells().size(); ++p)
    J.push_back(determinant(tissue.cells()[p].F()));
  const auto n_large =
    std::count_if(J.begin(), J.end(), [](const double j) { return j > 1.05; });
  ASSERT_GT(n_large, 0);
  ASSERT_LT(n_large, static_cast<int>(J.size()));
  grow(tissue, growth, 0.1, 0.3);
  for (std::size_t i = 0; i < J.size(); ++i)
    EXPECT_NEAR(determinant(tissue.cells()[i].growth()),
                J[i] > 1.05 ? 1.2 : 1.,
                1e-12);
}


// A cell that has flowed far behaves as one that has not.
TEST(CellDevelopment, RefersAnew)
{
  for (const std::string law : {"none", "cell cycle"})
    {
      const std::vector<std::string> settings = {
        "Dimension=2",
        "Proliferation/Law=" + law,
        std::string("Division by size/Volume=") + (law == "none" ? "150" : "0"),
        "Growth/Law=rate",
        "Growth/Rate/Rate=0.3",
        "Growth/Rate/Share along=1",
        "Growth/Rate/Direction=1; 0",
        "Material/Relaxation time=0.3"};
      Alone alone(settings), far(settings);
      alone.live(0., 0.1);
      far.live(0., 0.1);
      const Tensor<2, 2> shear({{1., 3000.}, {0., 1.}});
      const auto         cell    = far.tissue.cell(0);
      const auto        &columns = cell.columns();
      const auto         F_r     = law == "none" ?
                                     columns.relaxed :
                                     columns.find<Tensor<2, 2>>("growth_before_the_cycle");
      for (const auto &column : {columns.deformation, columns.growth, F_r})
        cell.set(column, cell.get(column) * shear);
      far.development.refer_anew(far.tissue);
      EXPECT_NEAR(cell.growth().norm(),
                  std::sqrt(2. * determinant(cell.growth())),
                  1e-6);
      for (const double t : {0.1, 0.2})
        {
          EXPECT_NEAR((far.cell().elastic_deformation() -
                       alone.cell().elastic_deformation())
                        .norm(),
                      0.,
                      1e-8)
            << law << t;
          EXPECT_NEAR(determinant(far.cell().growth()),
                      determinant(alone.cell().growth()),
                      1e-8);
          alone.live(t, t + 0.1);
          far.live(t, t + 0.1);
        }
      if (columns.shape.exists())
        {
          EXPECT_NEAR((far.cell().shape() - alone.cell().shape()).norm(),
                      0.,
                      1e-6);
        }
    }
}
