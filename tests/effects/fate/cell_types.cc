// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  const std::vector<std::string> two_types = {
    "Dimension=2",
    "Cell types/Names=stem, leaf",
    "Proliferation/Law=cell cycle",
    "Proliferation/Cell cycle/Duration=0.004",
    "Proliferation/Cell cycle/G0 exit rate=1",
    "Cell types/leaf/Proliferation/Law=none",
    "Cell types/stem/Transitions/To leaf=0.5"};
} // namespace


// Stem cells divide with the rate b, become leaves with the rate k and die with
// the rate d_1, leaves with d_2: the mean numbers are exp(M t) (1, 0) with M =
// [[b - k - d_1, 0], [k, -d_2]]. The cycle is short, so that the wait is nearly
// all.
TEST(CellTypes, NumbersAreThoseOfTheMatrixExponential)
{
  constexpr unsigned int n_seeds = 200, n_founders = 8;
  constexpr double       b = 1., k = 0.5, t = 1.;
  for (const auto &[d_1, d_2] : {std::pair(0., 0.), std::pair(0.3, 1.2)})
    {
      const double stem     = b - k - d_1;
      const double n_stems  = n_founders * std::exp(stem * t);
      const double n_leaves = n_founders * k / (stem + d_2) *
                              (std::exp(stem * t) - std::exp(-d_2 * t));
      std::array<double, 2> sum = {{0., 0.}}, squares = {{0., 0.}};
      for (unsigned int seed = 1; seed <= n_seeds; ++seed)
        {
          auto settings =
            with(two_types, {"Random seed=" + std::to_string(seed)});
          if (d_1 > 0.)
            settings = with(settings,
                            {"Death/Shrinking time=0",
                             "Death/Rate=0.3",
                             "Cell types/leaf/Death/Rate=1.2"});
          const Lives lives = lead(scene_of(settings), n_founders, t, 0.002);
          for (unsigned int i = 0; i < 2; ++i)
            {
              sum[i] += lives.numbers[i];
              squares[i] += lives.numbers[i] * lives.numbers[i];
            }
        }
      const std::array<double, 2> expected = {{n_stems, n_leaves}};
      for (unsigned int i = 0; i < 2; ++i)
        {
          const double mean  = sum[i] / n_seeds;
          const double sigma = std::sqrt(squares[i] / n_seeds - mean * mean);
          std::cout << "type " << i << ": " << mean << ", expected "
                    << expected[i] << ", sigma/sqrt(n) "
                    << sigma / std::sqrt(n_seeds) << '\n';
          EXPECT_NEAR(mean, expected[i], 3. * sigma / std::sqrt(n_seeds)) << i;
        }
    }
}


TEST(CellTypes, EventsDoNotDependOnTheStep)
{
  const Scene scene =
    scene_of(with(two_types,
                  {"Proliferation/Cell cycle/Duration=0.4",
                   "Cell types/leaf/Transitions/To stem=2",
                   "Cell types/stem/Daughter types=stem, leaf"}));
  const Lives whole = lead(scene, 30, 3.2, 0.2);
  const Lives half  = lead(scene, 30, 3.2, 0.1);
  ASSERT_GT(whole.events.size(), 100u);
  ASSERT_GT(whole.births.size(), 40u);
  expect_same(whole, half);
}


TEST(CellTypes, HaveValuesOfTheirOwn)
{
  const CellDevelopment<2> development = development_of(
    scene_of(with(two_types,
                  {"Cell types/leaf/Where=X > 50",
                   "Cell types/leaf/Material/Young's modulus=7",
                   "Material/Poisson's ratio=if(type == leaf, 0.1, 0.3)"})));
  for (const double X : {0., 100.})
    {
      std::vector<double> row =
        development.columns().founder(Point<2>(X, 0.), 1.);
      const CellView<2, double> cell(make_array_view(row),
                                     development.columns());
      development.initialize(3, cell);
      const CellReader<2>  reader = development.reader(0.);
      const PresentCell<2> present(cell, 3, Point<2>(X, 0.), reader);
      EXPECT_EQ(present.type(), X > 50. ? 1u : 0u);
      const Lame expected = lame(X > 50. ? 7. : 1., X > 50. ? 0.1 : 0.3);
      EXPECT_DOUBLE_EQ(present.lame().mu, expected.mu);
      EXPECT_DOUBLE_EQ(present.lame().lambda, expected.lambda);
    }
}


// Axes of leaves are given, also after a change of type; those of stem cells
// are drawn.
TEST(CellTypes, HaveAxesOfTheirOwn)
{
  const Scene scene = scene_of(
    with(two_types,
         {"Proliferation/Cell cycle/Start=together",
          "Proliferation/Cell cycle/Fixed axis=X; -Y; 0",
          "Cell types/leaf/Where=X > 50",
          "Cell types/leaf/Proliferation/Law=cell cycle",
          "Cell types/leaf/Proliferation/Cell cycle/Division axis=fixed",
          "Time/Step=0.002"}));
  EXPECT_NO_THROW(scene.check());
  const SceneEffects<2> effects = effects_of<2>(scene);
  EXPECT_EQ(effects.development.proliferation->axes->rule(0), nullptr);
  EXPECT_NE(effects.development.proliferation->axes->rule(1), nullptr);
  const CellDevelopment<2> development = development_of(scene);
  for (const double X : {0., 80.})
    {
      std::vector<double> row =
        development.columns().founder(Point<2>(X, 60.), 1.);
      const CellView<2, double> cell(make_array_view(row),
                                     development.columns());
      development.initialize(3, cell);
      const Tensor<1, 2> expected =
        X > 50. ?
          Tensor<1, 2>({0.8, -0.6}) :
          Random::direction<2>(scene.random_seed,
                               Random::founder_key(scene.random_seed, 3));
      EXPECT_LT((development.clock(cell).axis - expected).norm(), 1e-15);
    }
}


// A cell under strain becomes stiffer: it keeps its strain, or stands free of
// stress as it is.
TEST(CellTypes, MayForgetTheirStress)
{
  for (const std::string what : {"keep strain", "keep stress", "forget stress"})
    for (const std::string law : {"none", "cell cycle"})
      {
        Alone              alone({"Dimension=2",
                                  "Cell types/Names=soft, hard",
                                  "Proliferation/Law=" + law,
                                  "Proliferation/Cell cycle/G0 exit rate=0",
                                  "Cell types/hard/Material/Young's modulus=9",
                                  "Cell types/soft/Transitions/To hard=1e6",
                                  "Material/On transition=" + what});
        const Tensor<2, 2> F       = alone.cell().F();
        const auto         of_step = alone.live(0., 0.1);
        ASSERT_EQ(of_step.events.size(), 1u);
        EXPECT_DOUBLE_EQ(youngs_modulus(of_step.lame[0]), 9.);
        for (const double t : {0.1, 0.2})
          {
            const Tensor<2, 2> F_e = alone.cell().elastic_deformation();
            const Tensor<2, 2> expected =
              what == "forget stress" ?
                Tensor<2, 2>(unit_symmetric_tensor<2>()) :
              what == "keep strain" ?
                F :
                F * invert(Tensor<2, 2>(given_up_by_stiffening<2>(
                      F,
                      lame(1., 0.4),
                      lame(9., 0.4),
                      alone.development.reader(0.).material.material(),
                      true)));
            EXPECT_NEAR((F_e - expected).norm(), 0., 1e-14) << what << law;
            alone.live(t, t + 0.1);
          }
      }
}
