// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  const std::vector<Point<2>> positions = {{3., 4.}, {53., 4.}};
  const std::vector<double>   V0        = {100., 110.}; // as founders() says

  /** The friction of the cells in a step from 1 to 1.25 day. */
  struct Found
  {
    std::vector<double> coefficients; // kPa day/µm²
    double              stiffness;    // of all in the step, kPa
  };

  Found
  friction(const std::vector<std::string> &settings)
  {
    const Alone           alone(settings, positions);
    const SceneEffects<2> effects = effects_of<2>(scene_of(settings));
    EXPECT_EQ(effects.forces.size(), 1u);
    const Force<2>     &force  = *effects.forces.at(0).effect;
    const CellReader<2> reader = alone.development.reader(1.);
    std::mt19937        generator(1);
    const auto          term =
      force.term(alone.tissue,
                 reader,
                 random_points_in_cell<2>(generator, positions.size()),
                 1.,
                 1.25);
    // All cells move by 2 µm, and splines sum up to 1.
    LocalField<2> field;
    for (unsigned int a = 0; a < BSpline<2>::n; ++a)
      {
        field.coefficient[0][a] = 2.;
        field.coefficient[1][a] = 0.;
      }
    return {force.friction(alone.tissue, reader, 1.),
            TermOnOneCell<2>(*term, GrowthAt::current).energy(field) / 2.};
  }

  /** V, µm², of one of the cells at the beginning of the step. */
  double
  volume(const unsigned int i)
  {
    return V0[i] * determinant(some_deformation<2>(positions[i]));
  }

  void
  expect(const Found &found,
         const double first,
         const double second,
         const bool   per_current = true)
  {
    ASSERT_EQ(found.coefficients.size(), 2u);
    EXPECT_NEAR(found.coefficients[0], first, 1e-14);
    EXPECT_NEAR(found.coefficients[1], second, 1e-14);
    const double sum = per_current ?
                         (volume(0) * first + volume(1) * second) / 0.25 :
                         (V0[0] * first + V0[1] * second) / 0.25;
    EXPECT_NEAR(found.stiffness, sum, 1e-13 * sum);
  }
} // namespace


TEST(Friction, IsThatOfTheCellsStateAtTheBeginningOfTheStep)
{
  std::vector<std::string> settings = {"Dimension=2",
                                       "Friction/Coefficient=1e-6*t*volume"};
  expect(friction(settings), 1e-6 * volume(0), 1e-6 * volume(1));
  settings.push_back("Friction/Per=initial volume");
  expect(friction(settings), 1e-6 * volume(0), 1e-6 * volume(1), false);
}


TEST(Friction, MayBeThatOfATypeAlone)
{
  std::vector<std::string> settings = {
    "Dimension=2",
    "Cell types/Names=still, driven",
    "Cell types/driven/Where=X > 50",
    "Cell types/driven/Friction/Coefficient=2e-5"};
  expect(friction(settings), 0., 2e-5);
  settings.push_back("Cell types/still/Friction/Coefficient=1e-5");
  expect(friction(settings), 1e-5, 2e-5);
}
