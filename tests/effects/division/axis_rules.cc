// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  constexpr std::uint64_t seed = 42;

  /** A cell cycle with a rule, and a single cell. */
  template <int dim>
  class OneCell
  {
  public:
    explicit OneCell(const std::string              &rule,
                     const std::vector<std::string> &keys = {})
      : development(development_of<dim>(scene_of(settings(rule, keys))))
      , row(development.columns().founder(X(), 100.))
    {
      view().set(development.columns().deformation, F());
      if (development.state().surface_normal.exists())
        view().set(development.state().surface_normal, normal());
    }

    static Point<dim>
    X()
    {
      Point<dim> X;
      X[0] = 3.;
      X[1] = 4.;
      return X;
    }

    /** Stretched, turned and sheared. */
    static Tensor<2, dim>
    F()
    {
      Tensor<2, dim> F = unit_tensor<dim>();
      F[0][0]          = 1.2;
      F[0][1]          = 0.3;
      F[1][0]          = -0.1;
      F[dim - 1][dim - 1] += 0.05;
      return F;
    }

    static Tensor<1, dim>
    normal()
    {
      Tensor<1, dim> N;
      N[0] = 0.6;
      N[1] = 0.8;
      return N;
    }

    /** The cell enters S at t = 0. Number @p id makes the random numbers. */
    CycleState<dim>
    onset(const unsigned int id = 5)
    {
      development.initialize(id, view());
      return development.clock(view());
    }

    /** What the rule chose, as a direction in the present configuration. */
    Tensor<1, dim>
    carried(const CycleState<dim> &state) const
    {
      const Tensor<1, dim> direction = F() * state.axis;
      return direction / direction.norm();
    }

    CellView<dim, double>
    view()
    {
      return CellView<dim, double>(make_array_view(row), development.columns());
    }

    CellDevelopment<dim> development;

  private:
    static std::vector<std::string>
    settings(const std::string &rule, const std::vector<std::string> &keys)
    {
      const std::string        cycle = "Proliferation/Cell cycle/";
      std::vector<std::string> list  = {"Dimension=" + std::to_string(dim),
                                        "Random seed=" + std::to_string(seed),
                                        "Proliferation/Law=cell cycle",
                                        cycle + "Start=together",
                                        cycle + "Division axis=" + rule};
      for (const std::string &key : keys)
        list.push_back(cycle + key);
      return list;
    }

    std::vector<double> row;
  };

  template <int dim>
  Tensor<1, dim>
  random_direction(const CycleState<dim> &state)
  {
    return Random::direction<dim>(seed, state.key);
  }

  /** The rule's direction is where the deformation carries n_s, and where the
   *  daughters go. */
  template <int dim>
  void
  expect_along(const Tensor<1, dim>           &expected,
               const std::string              &rule,
               const std::vector<std::string> &keys = {})
  {
    OneCell<dim> cell(rule, keys);
    const auto   state = cell.onset();
    EXPECT_NEAR(state.axis.norm(), 1., 1e-15);
    EXPECT_LT((cell.carried(state) - expected).norm(), 1e-14);
    EXPECT_LT((cell.development.placement_axis(cell.view()) - expected).norm(),
              1e-14);
  }
} // namespace


TEST_2D_3D(AxisRules, AlongAnExpression)
{
  OneCell<dim>   cell("fixed", {"Fixed axis=X; -Y; 0"});
  Tensor<1, dim> expected;
  expected[0]      = 0.6;
  expected[1]      = -0.8;
  const auto state = cell.onset();
  EXPECT_LT((state.axis - expected).norm(), 1e-15);
  // Placed along n_s itself.
  EXPECT_EQ(cell.development.placement_axis(cell.view()), state.axis);
}

TEST(AxisRules, PlainNumbersMayBeSeparatedByCommas)
{
  for (const std::string text : {"1, 2, 2", "1; 2; 2", " 1,2 ,2.0", "1;2; 1+1"})
    {
      OneCell<3> cell("fixed", {"Fixed axis=" + text});
      EXPECT_EQ(cell.onset().axis, (Tensor<1, 3>({1., 2., 2.}) / 3.)) << text;
    }
  EXPECT_EQ(FixedAxisParameters().axis.text(), "0, 0, 1");
}


TEST_2D_3D(AxisRules, AlongPresentDirections)
{
  using Some = OneCell<dim>;
  const auto random =
    Random::direction<dim>(seed, Random::founder_key(seed, 5));
  const auto stretch = Directions::of_largest_stretch(Some::F(), 1.02, random);
  ASSERT_TRUE(stretch.has_value());
  expect_along<dim>(*stretch, "stretch");
  // The material is isotropic.
  expect_along<dim>(*stretch, "stress");

  Tensor<1, dim> away = Some::X();
  away[0] += 1.;
  away[1] -= 1.;
  expect_along<dim>(away / away.norm(), "radial", {"Radial center=-1; 1; 0"});

  const auto normal = Directions::carried_normal(Some::F(), Some::normal());
  expect_along<dim>(normal, "surface normal");
  expect_along<dim>(Directions::across(normal, random), "tangential");
}

TEST_2D_3D(AxisRules, AtRandomWhereThereIsNoDirection)
{
  const std::string least = "Least anisotropy=2 + 0*volume";
  OneCell<dim>      stretched("stretch", {least});
  const auto        state = stretched.onset();
  EXPECT_LT((stretched.carried(state) - random_direction(state)).norm(), 1e-14);
  OneCell<dim> stressed("stress", {least});
  EXPECT_LT(
    (stressed.carried(stressed.onset()) - random_direction(state)).norm(),
    1e-14);

  OneCell<dim> central("radial", {"Radial center=3; 4; 0"});
  EXPECT_LT((central.carried(central.onset()) - random_direction(state)).norm(),
            1e-14);
}

/** The spread is around what the rule says, where the rule says it. */
TEST_2D_3D(AxisRules, SpreadInThePresentConfiguration)
{
  OneCell<dim> cell("surface normal", {"Axis spread=4 + 0*noise"});
  const auto   normal = Directions::carried_normal(cell.F(), cell.normal());
  for (unsigned int id = 0; id < 100; ++id)
    {
      const auto state = cell.onset(id);
      EXPECT_LT((cell.carried(state) -
                 Random::direction_around(normal, 4., seed, state.key))
                  .norm(),
                1e-13);
    }
}
