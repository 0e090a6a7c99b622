// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/scene/scene.h>

#include <deal.II/base/symmetric_tensor.h>

#include <gtest/gtest.h>

#include <stdexcept>

#include "common/temporary_file.h"

using namespace Morula;

namespace
{
  struct GivenFactor : public EffectKeys
  {
    Key<double> factor{"Factor", 2., "Not zero."};

    GivenFactor()
    {
      factor.require([](const double f) { return f != 0.; }, "not zero", "");
    }

    using Keys::list;
    KeyList
    list() override
    {
      return {&factor};
    }
  };

  template <int dim>
  class Law : public GrowthLaw<dim>
  {
  public:
    using Parameters = GivenFactor;

    explicit Law(const Parameters &parameters)
      : factor(parameters.factor)
    {}

    Tensor<2, dim>
    growth(const GrowingCell<dim> &cell,
           const double,
           const double) const override
    {
      return factor * cell.growth;
    }

  private:
    const double factor;
  };

  template <int dim>
  class Rule : public DivisionRule<dim>
  {
  public:
    using Parameters = GivenFactor;

    explicit Rule(const Parameters &) {}

    Tensor<1, dim>
    axis(const CellAtOnset<dim> &cell) const override
    {
      return cell.random;
    }
  };

  Catalogue
  catalogue()
  {
    Catalogue result;
    result.add_growth_law<Law>("by factor");
    result.add_division_rule<Rule>("some axis");
    return result;
  }

  Scene
  read(const std::vector<std::string> &overrides)
  {
    const TemporaryFile empty(".prm", "");
    return Scene::read(empty.path, overrides, catalogue());
  }

  /** The stretch that the scene's growth law gives to a cell in the first day.
   */
  template <int dim>
  double
  stretch(const Scene &scene)
  {
    return effects_of<dim>(scene).development.law->growth(
      {{}, Tensor<2, dim>(unit_symmetric_tensor<dim>()), {}}, 0., 1.)[0][0];
  }
} // namespace


TEST(Catalogue, GivesTheSceneKeysAndEffects)
{
  const Scene scene =
    read({"Growth/Law=by factor",
          "Growth/By factor/Factor=3",
          "Proliferation/Law=cell cycle",
          "Proliferation/Cell cycle/Division axis=some axis"});
  EXPECT_NO_THROW(scene.check());
  EXPECT_EQ(stretch<2>(scene), 3.);
  EXPECT_EQ(stretch<3>(scene), 3.);
  EXPECT_NE(effects_of<3>(scene).development.proliferation->rule(0), nullptr);

  // Values belong to one scene.
  EXPECT_EQ(catalogue().growth_laws.back().keys().list()[0]->text(), "2");
  EXPECT_EQ(scene.catalogue.growth_laws.back().keys().list()[0]->text(), "3");
  EXPECT_EQ(scene.catalogue.growth_laws.back().keys().list()[0]->path(),
            "Growth/By factor/Factor");
}


TEST(Catalogue, GivesDefaults)
{
  const Scene scene = read({"Growth/By factor/Factor=3"}).with_defaults();
  EXPECT_EQ(scene.catalogue.growth_laws.back().keys().list()[0]->text(), "2");
}


TEST(Catalogue, ValuesStandInTheParameters)
{
  const std::string text =
    read({"Growth/Law=by factor", "Growth/By factor/Factor=0.1234567891"})
      .parameters();
  EXPECT_NE(text.find("subsection By factor"), std::string::npos) << text;
  EXPECT_NE(text.find("0.1234567891"), std::string::npos) << text;
}


TEST(Catalogue, LeavesTheLibrarysOwnEffectsAlone)
{
  const Scene scene = read({"Growth/Law=isotropic",
                            "Growth/Isotropic/Stretch=1.1",
                            "Proliferation/Law=cell cycle"});
  EXPECT_NO_THROW(scene.check());
  EXPECT_NEAR(stretch<2>(scene), 1.1, 1e-12);
  EXPECT_EQ(effects_of<2>(scene).development.proliferation->rule(0), nullptr);
  EXPECT_EQ(effects_of<2>(read({})).development.law, nullptr);
}


TEST(Catalogue, RefusesInTheScene)
{
  // by the effect itself, a value that nothing uses, an unknown key
  EXPECT_THROW(
    read({"Growth/Law=by factor", "Growth/By factor/Factor=0"}).check(),
    InputError);
  EXPECT_THROW(read({"Growth/By factor/Factor=1"}).check(), InputError);
  EXPECT_THROW(read({"Proliferation/Cell cycle/Some axis/Factor=1"}).check(),
               InputError);
  EXPECT_THROW(read({"Growth/By factor/Other=1"}), InputError);
  EXPECT_THROW(read({"Growth/Law=other"}), InputError);
}


TEST(Catalogue, RefusesNames)
{
  for (const std::string name : {"",
                                 "none",
                                 "isotropic",
                                 "random",
                                 "By",
                                 "a|b",
                                 " a",
                                 "a ",
                                 "by factor",
                                 "some axis"})
    {
      Catalogue full = catalogue();
      EXPECT_THROW(full.add_growth_law<Law>(name), std::invalid_argument);
      EXPECT_THROW(full.add_division_rule<Rule>(name), std::invalid_argument);
    }
}
