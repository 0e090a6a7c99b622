// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

// Tissue without mechanics: cells stay where they are and grow by the law, so
// that the numbers are those of closed forms.


namespace
{
  using SizeSettings = std::vector<std::string>;

  /** Cells that grow at the rate k (1/day) and divide at this volume, µm². */
  SizeSettings
  growing_to(const std::string &k, const std::string &volume)
  {
    return {"Dimension = 2",
            "Tissue/Surface cells = whole",
            "Growth/Law = rate",
            "Growth/Rate/Rate = " + k,
            "Division by size/Volume = " + volume};
  }

  /** What became of founders with given volumes. */
  struct SizedColony
  {
    std::vector<double>        volumes; // grown, µm²
    std::vector<Birth<2>>      births;
    std::vector<std::uint64_t> keys;
  };

  SizedColony
  grow_colony(const SizeSettings        &settings,
              const std::vector<double> &volumes,
              const double               end,
              const unsigned int         n_steps)
  {
    std::vector<Point<2>> positions;
    for (unsigned int i = 0; i < volumes.size(); ++i)
      positions.emplace_back(20. * (i % 100), 20. * (i / 100));
    const CellDevelopment<2> development = development_of(scene_of(settings));
    Tissue<2> tissue(GridParameters(), development.columns(), MPI_COMM_WORLD);
    tissue.place(founders(positions,
                          100.,
                          development,
                          [](const Point<2> &) {
                            return Tensor<2, 2>(unit_symmetric_tensor<2>());
                          }),
                 PointList<2>());
    const auto &columns = development.columns();
    for (unsigned int p = 0; p < volumes.size(); ++p)
      {
        const auto id = tissue.cells().id(p);
        tissue.cell(p).set(columns.initial_volume, volumes[id]);
        development.initialize(id, tissue.cell(p));
      }
    types::particle_index next_id = volumes.size();
    SizedColony           colony;
    for (unsigned int n = 0; n < n_steps; ++n)
      {
        const double t0 = n * end / n_steps, t1 = (n + 1) * end / n_steps;
        std::vector<CellEvent> events;
        grow(tissue, development, t0, t1);
        while (true)
          {
            const auto due = cells_due(tissue, development, t1);
            if (due.empty())
              break;
            const auto births =
              divide(tissue, development, due, t1, next_id, events);
            colony.births.insert(colony.births.end(),
                                 births.begin(),
                                 births.end());
          }
      }
    for (unsigned int p = 0; p < tissue.cells().size(); ++p)
      {
        const auto cell = tissue.cells()[p];
        colony.volumes.push_back(cell.initial_volume() *
                                 determinant(cell.growth()));
        colony.keys.push_back(cell.get(columns.lineage_key));
      }
    return colony;
  }
} // namespace


TEST(DivisionBySize, ComesWhenTheVolumeIsReached)
{
  // A volume of 100 is 150 at t = ln(1.5)/k, however long the steps are.
  for (const unsigned int n_steps : {1, 3, 10})
    {
      const SizedColony colony =
        grow_colony(growing_to("0.5", "150"), {100.}, 1., n_steps);
      ASSERT_EQ(colony.births.size(), 2u);
      for (const auto &birth : colony.births)
        {
          EXPECT_NEAR(birth.time, std::log(1.5) / 0.5, 1e-6);
          EXPECT_EQ(birth.generation, 1u);
          EXPECT_EQ(birth.parent, 0);
        }
      for (const double V : colony.volumes)
        EXPECT_NEAR(V, 50. * std::exp(0.5), 1e-10);
      EXPECT_NE(colony.keys[0], colony.keys[1]);
    }
}


TEST(DivisionBySize, MayComeTwiceInAStep)
{
  // The founder divides at the volume 150, and its daughters do when they
  // have it, which is at a volume of 300 of both.
  for (const unsigned int n_steps : {1, 8})
    {
      const SizedColony colony =
        grow_colony(growing_to("ln(5)", "150"), {100.}, 1., n_steps);
      std::map<unsigned int, std::vector<double>> times;
      for (const auto &birth : colony.births)
        times[birth.generation].push_back(birth.time);
      ASSERT_EQ(times[1].size(), 2u);
      ASSERT_EQ(times[2].size(), 4u);
      for (const double t : times[1])
        EXPECT_NEAR(t, std::log(1.5) / std::log(5.), 1e-6);
      for (const double t : times[2])
        EXPECT_NEAR(t, std::log(3.) / std::log(5.), 1e-6);
      ASSERT_EQ(colony.volumes.size(), 4u);
      for (const double V : colony.volumes)
        EXPECT_NEAR(V, 125., 1e-9);
    }
}


TEST(DivisionBySize, HasTheNoiseThatIsAsked)
{
  constexpr unsigned int N0 = 4000;
  const SizedColony      colony =
    grow_colony(with(growing_to("1", "100"), {"Division by size/Noise = 0.1"}),
                std::vector<double>(N0, 60.),
                0.9,
                9);
  std::map<int, double> of_founder;
  for (const auto &birth : colony.births)
    if (birth.generation == 1)
      of_founder[birth.parent] = 60. * std::exp(birth.time);
  ASSERT_EQ(of_founder.size(), N0); // 60 exp(0.9) is 4 deviations beyond
  double sum = 0., squares = 0., logs = 0.;
  for (const auto &[id, V] : of_founder)
    {
      sum += V;
      squares += V * V;
      logs += std::log(V);
    }
  const double mean = sum / N0;
  EXPECT_NEAR(mean, 100., 3. * 10. / std::sqrt(N0));
  EXPECT_NEAR(std::sqrt(squares / N0 - mean * mean) / mean, 0.1, 0.004);
  EXPECT_NEAR(logs / N0,
              std::log(100.) - 0.5 * std::log1p(0.01),
              3. * 0.1 / std::sqrt(N0));
}


TEST(DivisionBySize, HasExactTimesBesideOtherFates)
{
  // Steps of other lengths change neither the order of a death, a change of
  // type and a division in a step, nor their times.
  const Scene scene =
    scene_of(with(growing_to("0.9", "150"),
                  {"Division by size/Noise = 0.2",
                   "Cell types/Names = first, second",
                   "Cell types/first/Transitions/To second = 0.4",
                   "Cell types/second/Division by size/Volume = 120",
                   "Death/Rate = 0.3",
                   "Death/Shrinking time = 0.2",
                   "Material/Energy per = grown volume"}));
  const Lives fine   = lead(scene, 60, 2., 0.05),
              coarse = lead(scene, 60, 2., 1.);
  ASSERT_GT(fine.births.size(), 150u);
  ASSERT_GT(fine.events.size(), 80u);
  // Times of divisions are rounded to a millionth of a step.
  expect_same(fine, coarse, 1e-5);
}


TEST(DivisionBySize, LeavesTypesOfZeroVolumeAlone)
{
  const Lives lives =
    lead(scene_of(with(growing_to("1", "120"),
                       {"Cell types/Names = first, second",
                        "Cell types/second/Where = X > 1000",
                        "Cell types/second/Division by size/Volume = 0"})),
         100,
         1.,
         0.25);
  EXPECT_EQ(lives.numbers[1], 49.);      // founders at 1020 ... 1980
  EXPECT_EQ(lives.numbers[0], 4. * 51.); // a volume of 272 to 326
}


TEST(DivisionBySize, CutsTheLongAxis)
{
  // A cell of twice the length divides across it; then it is as long as wide,
  // and the next axis is that by chance. With four times, the axis is the
  // same again.
  for (const double stretch : {2., 4.})
    {
      Alone        alone(growing_to("1", "120"));
      const auto  &development = alone.development;
      Tensor<2, 2> F;
      F[0][0] = stretch * 0.6;
      F[1][0] = stretch * 0.8;
      F[0][1] = -0.8;
      F[1][1] = 0.6;
      const Tensor<1, 2> along({0.6, 0.8});
      alone.tissue.cell(0).set(development.columns().deformation, F);
      alone.live(0., 0.5);
      const auto axis = development.placement_axis(alone.cell());
      EXPECT_NEAR(std::abs(axis * along), 1., 1e-12);
      types::particle_index  next_id = 1;
      std::vector<CellEvent> events;
      divide(alone.tissue,
             development,
             cells_due(alone.tissue, development, 0.5),
             0.5,
             next_id,
             events);
      ASSERT_EQ(alone.tissue.cells().size(), 2u);
      alone.live(0.5, 1.5);
      for (unsigned int p = 0; p < 2; ++p)
        {
          const double cosine = std::abs(
            development.placement_axis(alone.tissue.cells()[p]) * along);
          if (stretch == 4.)
            EXPECT_NEAR(cosine, 1., 1e-12);
          else
            EXPECT_LT(cosine, 0.9999);
        }
    }
}


TEST(DivisionBySize, RefusesWhatDoesNothing)
{
  const auto        growing = growing_to("1", "120");
  const std::string cycle   = "Proliferation/Cell cycle/";
  for (const auto &[settings, key] :
       {std::pair<SizeSettings, std::string>(
          with(growing, {"Proliferation/Law = cell cycle"}),
          "Division by size/Volume"),
        {{"Dimension = 2", "Division by size/Volume = 120"},
         "Division by size/Volume"},
        {{"Dimension = 2", "Division by size/Noise = 0.1"},
         "Division by size/Noise"},
        {growing_to("1", "-3"), "Division by size/Volume"},
        {with(growing, {"Division by size/Noise = 0.7"}),
         "Division by size/Noise"},
        {with(growing, {cycle + "Duration = 2"}), cycle + "Duration"},
        {with(growing, {cycle + "Fixed axis = 1, 0, 0"}),
         cycle + "Fixed axis"}})
    expect_parts(complaint_of([&] { scene_of(settings).check(); }), {key});
  scene_of(
    with(growing,
         {cycle + "Fixed axis = 1, 0, 0", cycle + "Division axis = fixed"}))
    .check();
}


TEST(DivisionBySize, RefusesFoundersOfMoreThanTwiceTheVolume)
{
  const Scene               scene       = scene_of(growing_to("1", "40"));
  const CellDevelopment<2>  development = development_of(scene);
  std::vector<double>       row = development.columns().founder({}, 100.);
  const CellView<2, double> cell(make_array_view(row), development.columns());
  EXPECT_THROW(development.initialize(0, cell, 0.1), InputError);
  cell.set(development.columns().initial_volume, 79.);
  development.initialize(0, cell, 0.1);
}


// A cell that grows along x in a frame which lets it only widen along y has the
// shape that F gives it, however its growth is stressed; where the stress has
// relaxed, it has that of its growth.
TEST(DivisionBySize, FollowsTheShapeOfCells)
{
  const auto length_over_width = [](const SizeSettings &more) {
    Alone alone(
      with(with(growing_to("1", "1000"), more),
           {"Growth/Rate/Share along = 1", "Growth/Rate/Direction = 1; 0"}));
    Tensor<2, 2> F;
    F[0][0] = 1.;
    F[1][1] = 1.3;
    alone.tissue.cell(0).set(alone.development.columns().deformation, F);
    for (unsigned int n = 0; n < 100; ++n)
      alone.live(0.01 * n, 0.01 * (n + 1));
    const Tensor<2, 2> shape = alone.cell().shape();
    const auto squares = eigenvalues(symmetrize(shape * transpose(shape)));
    return std::sqrt(squares[0] / squares[1]);
  };
  EXPECT_NEAR(length_over_width({}), 1.3, 1e-9);
  // F_e is diag(1, 1.3) diag(e, 1)^-1 where nothing relaxes. With a relaxation
  // that is far faster than growth F_e has no shear, and e remains.
  EXPECT_NEAR(length_over_width({"Material/Relaxation time = 0.001",
                                 "Material/Energy per = grown volume"}),
              std::exp(1.),
              0.05);
}


// A founder of which the surface has left a third divides at a third of the
// volume.
TEST(DivisionBySize, CountsPartsOfCellsAsParts)
{
  const SizedColony colony =
    grow_colony(with(growing_to("1", "150"),
                     {"Tissue/Cell spacing = 10",
                      "Tissue/Surface cells = trimmed"}),
                {100., 100. / 3.},
                0.5,
                2);
  ASSERT_EQ(colony.births.size(), 4u);
  for (const auto &birth : colony.births)
    EXPECT_NEAR(birth.time, std::log(1.5), 1e-6);
}


TEST(DivisionBySize, RefusesAVolumeThatBecomesTiny)
{
  Alone alone(growing_to("1", "1000 - 999.9*(t > 0.5)"));
  alone.live(0., 0.5);
  EXPECT_THROW(alone.live(0.75, 1.), InputError);
}
