// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  /** A key of cells with this text. */
  ExpressionKey
  key(const std::string &text, const Evaluated evaluated = Evaluated::step)
  {
    ExpressionKey result("Section/Key", "0", "A number.", evaluated);
    result = text;
    return result;
  }

  const std::string all =
    "x + y + generation + age + cycle_phase + volume + growth + J_e + pressure "
    "+ tension + shear + energy + depth + noise + type_age";

  /** A cell in some state, in 3-D. */
  struct SomeCell
  {
    StateColumns<3>                 state;
    CellColumns<3>                  columns;
    TissueMaterial                  material{MaterialParameters()};
    std::vector<double>             row;
    Tensor<2, 3>                    F, F_g;
    std::optional<Proliferation<3>> cycle;

    SomeCell()
    {
      state.use(key(all));
      columns.need_growth();
      cycle.emplace(CellCycle<3>(CellCycleParameters(), 7, 1e-9), columns, 7);
      state.declare(columns);
      row = columns.founder(Point<3>(1., 2., 3.), 50.);
      F   = Tensor<2, 3>({{1.2, 0.1, 0.}, {0., 0.9, 0.2}, {0.05, 0., 1.1}});
      F_g = 1.05 * Tensor<2, 3>(unit_symmetric_tensor<3>());
      const CellView<3, double> cell = view();
      cell.set(columns.deformation, F);
      cell.set(columns.growth, F_g);
      cell.set(columns.generation, 4u);
      cell.set(state.birth_time, 0.5);
      cell.set(state.type_since, 1.);
      cell.set(state.depth, 8.);
      CycleState<3> waiting;
      waiting.phase = CyclePhase::waiting;
      waiting.key   = 99;
      cycle->set_clock(cell, waiting);
    }

    CellView<3, double>
    view()
    {
      return {make_array_view(row), columns};
    }

    double
    value(const std::string &text, const double t = 2.)
    {
      const CellReader<3>  reader{state, material, &*cycle, 7, t};
      const PresentCell<3> cell(view(), 5, Point<3>(4., 5., 6.), reader);
      return cell.value(state.use(key(text)), t);
    }
  };
} // namespace


TEST(PresentCell, KnowsItsVariables)
{
  SomeCell             cell;
  const CellQuantities q =
    cell_quantities<3>(CellView<3, const double>(cell.view()),
                       cell.material.material(),
                       lame(1., 0.4),
                       true);
  const auto   principal = eigenvalues(q.stress);
  const double von_mises =
    std::sqrt(0.5 * (std::pow(principal[0] - principal[1], 2) +
                     std::pow(principal[1] - principal[2], 2) +
                     std::pow(principal[2] - principal[0], 2)));
  const std::map<std::string, double> expected = {
    {"X", 1.},
    {"Z", 3.},
    {"t", 2.},
    {"x", 4.},
    {"z", 6.},
    {"generation", 4.},
    {"age", 1.5},
    {"type_age", 1.},
    {"cycle_phase", 0.},
    {"volume", 50. * determinant(cell.F)},
    {"growth", std::pow(1.05, 3)},
    {"J_e", determinant(cell.F) / std::pow(1.05, 3)},
    {"pressure", -trace(q.stress) / 3.},
    {"tension", principal[0]},
    {"shear", von_mises},
    {"energy", q.energy_density},
    {"depth", 8.},
    {"noise", Random::noise(7, 99)}};
  for (const auto &[name, value] : expected)
    EXPECT_NEAR(cell.value(name), value, 1e-12 * (1. + std::abs(value)))
      << name;
  EXPECT_EQ(cell.value("age", 3.), 2.5);
}


/** In plane strain the stress across the plane counts, too:
 *  J_e σ = λ ln J_e I + μ (b_e - I), here with b_e = diag(1.44, 1, 1). */
TEST(PresentCell, PressureInThePlaneCountsTheStressAcrossIt)
{
  StateColumns<2>  state;
  CellColumns<2>   columns;
  const Expression pressure = state.use(key("pressure"));
  columns.need_growth();
  state.declare(columns);
  std::vector<double>       row = columns.founder(Point<2>(1., 2.), 50.);
  const CellView<2, double> cell(make_array_view(row), columns);
  cell.set(columns.deformation, Tensor<2, 2>({{1.2, 0.}, {0., 1.}}));
  const TissueMaterial material{MaterialParameters()};
  const CellReader<2>  reader{state, material, nullptr, 7, 0.};
  const PresentCell<2> present(cell, 5, Point<2>(), reader);
  const Lame           moduli = lame(1., 0.4);
  EXPECT_NEAR(present.value(pressure, 0.),
              -(moduli.lambda * std::log(1.2) + moduli.mu * 0.44 / 3.) / 1.2,
              1e-14);
}


TEST(PresentCell, KnowsWhatItWouldFeelIfItHadGrown)
{
  SomeCell             cell;
  const CellReader<3>  reader{cell.state, cell.material, nullptr, 7, 0.};
  const PresentCell<3> present(cell.view(), 5, Point<3>(), reader);
  const Expression     J_e = cell.state.use(key("J_e"));
  EXPECT_NEAR(present.value_if_grown(J_e, 0., 1.1),
              present.value(J_e, 0.) / 1.1,
              1e-14);
  EXPECT_GT(present.value_if_grown(cell.state.use(key("pressure")), 0., 1.1),
            present.value(cell.state.use(key("pressure")), 0.));
}


TEST(PresentCell, NormalMakesANormalDistributionOfNoise)
{
  SomeCell cell;
  EXPECT_NEAR(cell.value("normal(10, 2)"),
              10. + 2. * cell.value("normal(0, 1)"),
              1e-12);
}


TEST(NearSurface, IsThePlaneOfTheNearestBoundaryPoint)
{
  const std::vector<Point<2>> points = {Point<2>(0., 0.), Point<2>(10., 0.)};
  std::vector<Tensor<1, 2>>   normals(2);
  normals[0][1]   = 1.;
  normals[1][0]   = 1.;
  const auto near = near_surface<2>({Point<2>(1., -4.), Point<2>(9., -1.)},
                                    points,
                                    normals,
                                    MPI_COMM_SELF);
  EXPECT_EQ(near[0].depth, 4.);
  EXPECT_EQ(near[0].normal, normals[0]);
  EXPECT_EQ(near[1].depth, 1.);
  EXPECT_EQ(near[1].normal, normals[1]);
  EXPECT_TRUE(
    std::isinf(near_surface<2>({Point<2>()}, {}, {}, MPI_COMM_SELF)[0].depth));
}
