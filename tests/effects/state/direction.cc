// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  CellDirectionKey
  key(const std::string &text)
  {
    CellDirectionKey key("Growth/Rate/Direction", "", "");
    key = text;
    return key;
  }
} // namespace


TEST_2D_3D(DirectionOfCell, KnowsWordsAndVectors)
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


TEST_2D_3D(DirectionOfCell, HasSomeDirectionInTheCenter)
{
  LoneCell<dim>              scene;
  const DirectionOfCell<dim> radial(key("radial"), scene.setting());
  scene.place(Point<dim>());
  // Some direction, as all are alike in the centre.
  EXPECT_NEAR(radial.of(scene.present(), 0.).norm(), 1., 1e-15);
}
