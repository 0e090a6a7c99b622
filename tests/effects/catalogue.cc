// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"
#include "own_effects/own_effects.h"

namespace
{
  Catalogue
  catalogue()
  {
    Catalogue result;
    Own::add_effects(result);
    return result;
  }

  Scene
  read(const std::vector<std::string> &overrides)
  {
    const TemporaryFile empty(".prm", "");
    return Scene::read(empty.path, overrides, catalogue());
  }

  std::string
  uptake_of(const Scene &scene)
  {
    return scene.keys<Own::DoseKeys>().uptake.text();
  }
} // namespace


TEST(Catalogue, GivesTheSceneKeysAndEffects)
{
  const Scene scene = read({"Growth/Law=dose", "Growth/Dose/Uptake=3"});
  const auto  law   = effects_of<3>(scene).development.law;
  const GrowingCell<3> cell{{}, Tensor<2, 3>(unit_symmetric_tensor<3>()), {}};
  EXPECT_DOUBLE_EQ(law->growth(cell, 0., 1.)[0][0], 4.);
  EXPECT_EQ(scene.keys<Own::DoseKeys>().uptake.path(), "Growth/Dose/Uptake");
  EXPECT_EQ(effects_of<2>(read({})).development.law, nullptr);

  // Values belong to one scene.
  EXPECT_EQ(uptake_of(scene), "3");
  EXPECT_EQ(uptake_of(scene.with_defaults()), "0");
  EXPECT_EQ(catalogue().keys<Own::DoseKeys>().uptake.text(), "0");
}


TEST(Catalogue, RefusesInTheScene)
{
  // a value that nothing uses, an unknown key, an unknown name
  EXPECT_THROW(read({"Growth/Dose/Uptake=1"}).check(), InputError);
  EXPECT_THROW(read({"Growth/Dose/Other=1"}), InputError);
  EXPECT_THROW(read({"Growth/Law=other"}), InputError);
}


TEST(Catalogue, RefusesNames)
{
  for (const std::string name :
       {"", "none", "isotropic", "random", "By", "a|b", " a", "a ", "dose"})
    {
      Catalogue full = catalogue();
      EXPECT_THROW(full.add<Own::DoseLaw>(name), std::invalid_argument);
      EXPECT_THROW(full.add<Own::AlongRule>(name), std::invalid_argument);
    }
}
