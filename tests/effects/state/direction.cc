// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/effects/state/direction.h>

#include <gtest/gtest.h>

#include "common/body_on_grid.h"
#include "effects/lone_cell.h"

using namespace Morula;

namespace
{
  CellDirectionKey
  key(const std::string &text)
  {
    CellDirectionKey key("Growth/Rate/Direction", "", "");
    key = text;
    return key;
  }

  template <int dim>
  void
  check_words()
  {
    LoneCell<dim>              scene;
    const DirectionOfCell<dim> radial(key("radial"), scene.setting());
    const DirectionOfCell<dim> along(key("0; 3; 0"), scene.setting());
    const DirectionOfCell<dim> normal(key("surface normal"), scene.setting());
    Point<dim>                 X;
    for (unsigned int d = 0; d < dim; ++d)
      X[d] = 3. + d;
    scene.place(X);
    Tensor<1, dim> N;
    N[0] = -1.;
    scene.cell().set(scene.state.surface_normal, N);

    EXPECT_LE((radial.of(scene.present(), 0.) - X / X.norm()).norm(), 1e-15);
    Tensor<1, dim> y;
    y[1] = 1.;
    EXPECT_EQ(along.of(scene.present(), 0.), y);
    EXPECT_EQ(normal.of(scene.present(), 0.), N);
  }

  template <int dim>
  void
  check_zero()
  {
    LoneCell<dim>              scene;
    const DirectionOfCell<dim> radial(key("radial"), scene.setting());
    const DirectionOfCell<dim> vector(key("X; Y; 0"), scene.setting());
    scene.place(Point<dim>());
    // Some direction, as all are alike in the centre.
    EXPECT_NEAR(radial.of(scene.present(), 0.).norm(), 1., 1e-15);
    try
      {
        vector.of(scene.present(), 0.25);
        ADD_FAILURE();
      }
    catch (const InputError &error)
      {
        const std::string message = error.what();
        for (const char *part :
             {"Growth/Rate/Direction", "not zero", "t = 0.25"})
          EXPECT_NE(message.find(part), std::string::npos) << message;
      }
  }
} // namespace


TEST(DirectionOfCell, KnowsWordsAndVectors){MORULA_BOTH_DIMENSIONS(check_words)}


TEST(DirectionOfCell, RefusesAZeroVector){MORULA_BOTH_DIMENSIONS(check_zero)}


TEST(DirectionOfCell, RefusesOtherWords)
{
  EXPECT_THROW(key("surfce normal").check(3), InputError);
  EXPECT_THROW(key("1; 0").check(3), InputError);
  EXPECT_THROW(key("0; 0; 0").check(3), InputError);
  EXPECT_NO_THROW(key("1; 0").check(2));
  EXPECT_NO_THROW(key("radial").check(2));
  EXPECT_NO_THROW(key("surface normal").check(3));
  EXPECT_NO_THROW(key("").check(3));
}
