// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  /** What a tissue of two types is before and after its exchanges. */
  template <int dim>
  struct Exchanged
  {
    using Cells = std::map<types::particle_index,
                           std::pair<Point<dim>, std::vector<double>>>;
    Cells            before, after;
    NamedNumbers     numbers;
    CellColumns<dim> columns;
  };

  /** Cells of a lattice, or jittered, that exchange places for a step. */
  template <int dim>
  Exchanged<dim>
  exchanged(const double                    jitter,
            const std::vector<std::string> &further,
            const MPI_Comm                  comm)
  {
    const std::vector<std::string> settings = {
      "Dimension=" + std::to_string(dim),
      "Material/Volumetric strain=pooled",
      "Material/Energy per=grown volume",
      "Growth/Law=isotropic",
      "Growth/Isotropic/Stretch=1 + 0.1*t*(X > 0)",
      "Cell types/Names=a, b",
      "Cell types/b/Where=sin(91.7*X + 47.3*Y) > 0",
      "Cell types/b/Tension/With a=1",
      "Rearrangement/Diffusion=100",
      "Rearrangement/Fluctuation energy=" +
        std::string(dim == 2 ? "8" : "100")};
    const Scene                scene       = scene_of(with(settings, further));
    const SceneEffects<dim>    effects     = effects_of<dim>(scene);
    const CellDevelopment<dim> development = development_of<dim>(scene);
    GridParameters             grid;
    grid.spacing = 30.;
    Tissue<dim> tissue(grid, development.columns(), comm);

    std::mt19937                           generator(7);
    std::uniform_real_distribution<double> uniform(-jitter, jitter);
    std::vector<Point<dim>>                positions =
      lattice_points<dim>(Point<dim>(),
                          dim == 2 ? 120. : 50.,
                          10.,
                          [](const auto &) { return true; });
    for (Point<dim> &x : positions)
      for (unsigned int d = 0; d < dim; ++d)
        x[d] += uniform(generator);
    tissue.place(only_first_rank(founders(positions,
                                          std::pow(10., dim),
                                          development,
                                          some_deformation<dim>),
                                 comm),
                 PointList<dim>());
    grow(tissue, development, 0., 1.);
    Exchanged<dim> result{all_cells(tissue), {}, {}, development.columns()};
    NamedNumbers   kept;
    effects.step_effects.at(0).effect->rearrange(
      tissue, {1., 0.3, development.reader(1.), kept, result.numbers});
    result.after = all_cells(tissue);
    return result;
  }
} // namespace


TEST_2D_3D(Rearrangement, KeepsTheSpaceOfPlacesAndTheGrowthOfCells)
{
  Exchanged<dim> result = exchanged<dim>(3., {}, MPI_COMM_WORLD);
  const auto     view   = [&](std::vector<double> &row) {
    return CellView<dim, double>(make_array_view(row), result.columns);
  };
  // Each place keeps its volume; each cell its V⁰ and its F_g.
  std::map<std::vector<double>, double> volumes;
  const auto                            key = [](const Point<dim> &x) {
    return std::vector<double>(x.begin_raw(), x.end_raw());
  };
  for (auto &[id, cell] : result.before)
    volumes[key(cell.first)] = view(cell.second).volume();
  ASSERT_EQ(result.before.size(), result.after.size());
  unsigned int n_moved = 0;
  for (auto &[id, cell] : result.after)
    {
      auto &before = result.before.at(id);
      ASSERT_EQ(volumes.count(key(cell.first)), 1u);
      const double V = volumes.at(key(cell.first));
      EXPECT_NEAR(view(cell.second).volume(), V, 1e-12 * V);
      EXPECT_EQ(view(cell.second).initial_volume(),
                view(before.second).initial_volume());
      EXPECT_EQ(view(cell.second).growth(), view(before.second).growth());
      n_moved += cell.first.distance(before.first) > 0.;
    }
  EXPECT_GT(n_moved, result.after.size() / 2);
  EXPECT_GT(result.numbers.at("exchanges"), 0.3 * result.after.size());
  EXPECT_GT(result.numbers.at("adhesion_energy"), 0.);
  EXPECT_GT(result.numbers.at("unlike_share"), 0.1);
  EXPECT_LT(result.numbers.at("unlike_share"), 0.55);
}


TEST(Rearrangement, IsOffForATypeThatDoesNotDiffuse)
{
  auto result = exchanged<2>(3.,
                             {"Cell types/b/Rearrangement/Diffusion=0"},
                             MPI_COMM_WORLD);
  for (auto &[id, cell] : result.after)
    {
      const CellView<2, double> after(make_array_view(cell.second),
                                      result.columns);
      if (after.get(result.columns.find<unsigned int>("type")) == 1)
        {
          EXPECT_EQ(cell.first, result.before.at(id).first);
        }
    }
  EXPECT_GT(result.numbers.at("exchanges"), 0.);
}
