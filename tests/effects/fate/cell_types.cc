// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/effects/division/divide.h>
#include <morula/scene/scene.h>

#include <deal.II/lac/full_matrix.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "common/complaint.h"
#include "common/temporary_file.h"
#include "effects/small_tissue.h"

using namespace Morula;

namespace
{
  /** A scene of these lines. */
  Scene
  read(const std::vector<std::string> &settings)
  {
    const TemporaryFile file("cell-types.prm", "");
    return Scene::read(file.path, settings);
  }

  const std::vector<std::string> two_types = {
    "Dimension=2",
    "Cell types/Names=stem, leaf",
    "Proliferation/Law=cell cycle",
    "Proliferation/Cell cycle/Duration=0.004",
    "Proliferation/Cell cycle/G0 exit rate=1",
    "Cell types/leaf/Proliferation/Law=none",
    "Cell types/stem/Transitions/To leaf=0.5"};

  /** What became of some founders without mechanics. */
  struct Outcome
  {
    std::array<double, 2>   numbers = {{0., 0.}};
    std::vector<TypeChange> changes;
    std::vector<double>     births;
  };

  Outcome
  run(const Scene       &scene,
      const unsigned int n_founders,
      const double       end,
      const double       step)
  {
    SceneEffects<2>          effects = effects_of<2>(scene);
    const CellDevelopment<2> development(std::move(effects.development),
                                         effects.columns,
                                         effects.state,
                                         TissueMaterial(scene.material),
                                         scene.random_seed);
    std::vector<Point<2>>    positions;
    for (unsigned int i = 0; i < n_founders; ++i)
      positions.emplace_back(20. * i, 0.);
    Tissue<2> tissue(GridParameters(), development.columns(), MPI_COMM_WORLD);
    tissue.place(founders(positions,
                          100.,
                          development,
                          [](const Point<2> &) {
                            return Tensor<2, 2>(unit_symmetric_tensor<2>());
                          }),
                 PointList<2>());
    types::particle_index next_id = n_founders;
    Outcome               outcome;
    const unsigned int    n_steps = std::lround(end / step);
    for (unsigned int n = 0; n < n_steps; ++n)
      {
        const double t0 = n * step, t1 = (n + 1) * step;
        const auto   of_step = development.of_step(tissue, t0, t1);
        development.commit(tissue, of_step, t0, t1);
        outcome.changes.insert(outcome.changes.end(),
                               of_step.changes.begin(),
                               of_step.changes.end());
        const auto due = cells_due(tissue, development, t1);
        if (due.empty())
          continue;
        const auto divisions = divide(tissue, development, due, t1, next_id);
        outcome.changes.insert(outcome.changes.end(),
                               divisions.changes.begin(),
                               divisions.changes.end());
        for (const auto &birth : divisions.births)
          outcome.births.push_back(birth.time);
      }
    for (unsigned int p = 0; p < tissue.cells().size(); ++p)
      ++outcome.numbers[tissue.cells()[p].get(development.state().type)];
    std::sort(outcome.changes.begin(),
              outcome.changes.end(),
              [](const TypeChange &a, const TypeChange &b) {
                return a.time < b.time;
              });
    std::sort(outcome.births.begin(), outcome.births.end());
    return outcome;
  }

  /** What reading or checking a scene with these further settings says. */
  std::string
  complaint(std::vector<std::string> settings)
  {
    settings.insert(settings.begin(), two_types.begin(), two_types.end());
    settings.push_back("Time/Step=0.002");
    return complaint_of([&] {
      const Scene scene = read(settings);
      scene.check();
    });
  }

} // namespace


// Stem cells divide with the rate b and become leaves with the rate k: the mean
// numbers are exp(M t) (1, 0) with M = [[b - k, 0], [k, 0]]. The cycle is
// short, so that the wait is nearly all.
TEST(CellTypes, NumbersAreThoseOfTheMatrixExponential)
{
  constexpr unsigned int n_seeds = 200, n_founders = 8;
  constexpr double       b = 1., k = 0.5, t = 1.;
  const double           stems = n_founders * std::exp((b - k) * t);
  const double leaves = n_founders * k / (b - k) * (std::exp((b - k) * t) - 1.);
  std::array<double, 2> sum = {{0., 0.}}, squares = {{0., 0.}};
  for (unsigned int seed = 1; seed <= n_seeds; ++seed)
    {
      auto settings = two_types;
      settings.push_back("Random seed=" + std::to_string(seed));
      const Outcome outcome = run(read(settings), n_founders, t, 0.002);
      for (unsigned int i = 0; i < 2; ++i)
        {
          sum[i] += outcome.numbers[i];
          squares[i] += outcome.numbers[i] * outcome.numbers[i];
        }
    }
  const std::array<double, 2> expected = {{stems, leaves}};
  for (unsigned int i = 0; i < 2; ++i)
    {
      const double mean  = sum[i] / n_seeds;
      const double sigma = std::sqrt(squares[i] / n_seeds - mean * mean);
      std::cout << "type " << i << ": " << mean << ", expected " << expected[i]
                << ", sigma/sqrt(n) " << sigma / std::sqrt(n_seeds) << '\n';
      EXPECT_NEAR(mean, expected[i], 3. * sigma / std::sqrt(n_seeds)) << i;
    }
}


TEST(CellTypes, EventsDoNotDependOnTheStep)
{
  auto settings = two_types;
  settings.push_back("Proliferation/Cell cycle/Duration=0.4");
  settings.push_back("Cell types/leaf/Transitions/To stem=2");
  settings.push_back("Cell types/stem/Daughter types=stem, leaf");
  const Scene   scene = read(settings);
  const Outcome whole = run(scene, 30, 3.2, 0.2);
  const Outcome half  = run(scene, 30, 3.2, 0.1);
  ASSERT_GT(whole.changes.size(), 100u);
  ASSERT_GT(whole.births.size(), 40u);
  ASSERT_EQ(whole.changes.size(), half.changes.size());
  for (std::size_t i = 0; i < whole.changes.size(); ++i)
    {
      EXPECT_NEAR(whole.changes[i].time, half.changes[i].time, 1e-12);
      EXPECT_EQ(whole.changes[i].to, half.changes[i].to);
    }
  ASSERT_EQ(whole.births.size(), half.births.size());
  for (std::size_t i = 0; i < whole.births.size(); ++i)
    EXPECT_NEAR(whole.births[i], half.births[i], 1e-12);
  EXPECT_EQ(whole.numbers, half.numbers);
}


TEST(CellTypes, HaveValuesOfTheirOwn)
{
  auto settings = two_types;
  settings.push_back("Cell types/leaf/Where=X > 50");
  settings.push_back("Cell types/leaf/Material/Young's modulus=7");
  settings.push_back("Material/Poisson's ratio=if(type == leaf, 0.1, 0.3)");
  const Scene              scene   = read(settings);
  SceneEffects<2>          effects = effects_of<2>(scene);
  const TissueMaterial     material(scene.material);
  const CellDevelopment<2> development(std::move(effects.development),
                                       effects.columns,
                                       effects.state,
                                       material,
                                       1);
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


// A cell under strain becomes stiffer: it keeps its strain, or stands free of
// stress as it is.
TEST(CellTypes, MayForgetTheirStress)
{
  for (const std::string what : {"keep strain", "forget stress"})
    for (const std::string law : {"none", "cell cycle"})
      {
        const Scene              scene   = read({"Dimension=2",
                                                 "Cell types/Names=soft, hard",
                                                 "Proliferation/Law=" + law,
                                                 "Proliferation/Cell cycle/G0 exit rate=0",
                                                 "Cell types/hard/Material/Young's modulus=9",
                                                 "Cell types/soft/Transitions/To hard=1e6",
                                                 "Material/On transition=" + what});
        SceneEffects<2>          effects = effects_of<2>(scene);
        const CellDevelopment<2> development(std::move(effects.development),
                                             effects.columns,
                                             effects.state,
                                             TissueMaterial(scene.material),
                                             scene.random_seed);
        Tissue<2>                tissue(GridParameters(),
                         development.columns(),
                         MPI_COMM_WORLD);
        tissue.place(
          founders({Point<2>(3., 4.)}, 100., development, some_deformation<2>),
          PointList<2>());
        const Tensor<2, 2> F       = tissue.cells()[0].F();
        const auto         of_step = development.of_step(tissue, 0., 0.1);
        ASSERT_EQ(of_step.changes.size(), 1u);
        EXPECT_DOUBLE_EQ(youngs_modulus(of_step.lame[0]), 9.);
        development.commit(tissue, of_step, 0., 0.1);
        for (const double t : {0.1, 0.2})
          {
            const Tensor<2, 2> F_e = tissue.cells()[0].elastic_deformation();
            const Tensor<2, 2> expected =
              what == "forget stress" ?
                Tensor<2, 2>(unit_symmetric_tensor<2>()) :
                F;
            EXPECT_NEAR((F_e - expected).norm(), 0., 1e-14) << what << law;
            development.commit(tissue,
                               development.of_step(tissue, t, t + 0.1),
                               t,
                               t + 0.1);
          }
      }
}


TEST(CellTypes, RefuseWhatCannotBe)
{
  EXPECT_EQ(complaint({}), "");
  expect_parts(complaint({"Cell types/Names=stem, age"}),
               {"Cell types/Names", "stem, age", "'age'", "variable"});
  expect_parts(complaint({"Cell types/Names=stem, hill"}), {"'hill'"});
  expect_parts(complaint({"Cell types/Names=stem, stem"}), {"twice"});
  expect_parts(complaint({"Cell types/Names=stem, 2b"}), {"letter"});
  expect_parts(complaint({"Cell types/stem/Transitions/To stem=1"}),
               {"Cell types/stem/Transitions/To stem"});
  expect_parts(complaint({"Cell types/stem/Transitions/To root=1"}),
               {"Cell types/stem/Transitions/To root"});
  expect_parts(complaint({"Cell types/stem/Transitions/To leaf=-1"}),
               {"Cell types/stem/Transitions/To leaf", "'-1'", ">= 0"});
  expect_parts(complaint({"Cell types/stem/Transitions/To leaf=root > 1"}),
               {"Cell types/stem/Transitions/To leaf", "root", "leaf"});
  expect_parts(complaint({"Cell types/stem/Daughter types=stem, root"}),
               {"Cell types/stem/Daughter types", "no type 'root'"});
  expect_parts(complaint({"Cell types/stem/Daughter types=stem"}),
               {"Cell types/stem/Daughter types", "both"});
  expect_parts(complaint({"Cell types/stem/Material/Young's modulus=0"}),
               {"Cell types/stem/Material/Young's modulus", "'0'", "> 0"});
  expect_parts(complaint({"Cell types/stem/Cell types/leaf/Where=1"}),
               {"Cell types/stem/Cell types"});
}
