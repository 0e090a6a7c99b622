// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/rearrangement/places_of_tissue.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <unordered_map>

#include "effects/fate/lives.h"

using namespace Morula;

namespace
{
  constexpr double a = 10., D = 100.; // µm, µm²/day: D t = a² in a day

  /** Cells of a lattice of so many along an edge, each moved at random by up to
   *  0.3 a, so that all that touch are within Neighbours/Reach; as the program
   *  knows them. */
  template <int dim>
  PlacesOfTissue
  irregular_places(const unsigned int n, const unsigned int seed)
  {
    const Scene       scene   = scene_of({"Dimension=" + std::to_string(dim)});
    SceneEffects<dim> effects = effects_of<dim>(scene);
    const CellDevelopment<dim> development(std::move(effects.development),
                                           effects.columns,
                                           effects.state,
                                           TissueMaterial(scene.material),
                                           scene.random_seed);
    GridParameters             grid;
    grid.spacing = 30.;
    Tissue<dim> tissue(grid, development.columns(), MPI_COMM_SELF);

    std::mt19937                           generator(seed);
    std::uniform_real_distribution<double> uniform(-0.3 * a, 0.3 * a);
    std::vector<Point<dim>> positions(Utilities::fixed_power<dim>(n));
    for (unsigned int i = 0; i < positions.size(); ++i)
      for (unsigned int d = 0, k = i; d < dim; ++d, k /= n)
        positions[i][d] = (k % n + 0.5) * a + uniform(generator);
    // The founders have 1, 1.1 and 1.2 times this volume.
    tissue.place(founders(positions,
                          std::pow(a, dim) / 1.1,
                          development,
                          [](const auto &) {
                            return Tensor<2, dim>(unit_symmetric_tensor<dim>());
                          }),
                 PointList<dim>());
    std::vector<Occupant> cells;
    for (unsigned int p = 0; p < tissue.cells().size(); ++p)
      cells.push_back({p + 1, 0, D, {{0., 0., 0.}}, 0, p});
    return places_of(tissue, cells);
  }

  /** The mean square displacement over 2 d D t of the cells that start in the
   *  inner part of the box, after each time. */
  template <int dim>
  std::vector<double>
  spread(const unsigned int         n,
         const double               inner,
         const unsigned int         n_runs,
         const std::vector<double> &times)
  {
    PlacesOfTissue                     around = irregular_places<dim>(n, 3);
    const std::vector<Occupant>        start  = around.occupants;
    const AdhesionEnergy               energy(TypeTensions(), 1.);
    const auto                        &x = around.places.positions;
    std::vector<std::array<double, 3>> from(start.size() + 1);
    std::vector<bool>                  counts(start.size() + 1);
    for (unsigned int p = 0; p < start.size(); ++p)
      {
        from[start[p].key]   = x[p];
        counts[start[p].key] = true;
        for (unsigned int d = 0; d < dim; ++d)
          counts[start[p].key] =
            counts[start[p].key] && std::abs(x[p][d] - 0.5 * n * a) < inner * a;
      }
    std::vector<double> result(times.size());
    for (unsigned int run = 0; run < n_runs; ++run)
      {
        std::vector<Occupant> occupants = start;
        double                t         = 0.;
        for (std::size_t k = 0; k < times.size(); ++k)
          {
            // The clocks of a step follow the cells that are there.
            for (unsigned int p = 0; p < occupants.size(); ++p)
              around.places.keys[p] = occupants[p].key;
            around.places.sort_edges();
            ExchangeRounds rounds(
              around.places,
              occupants,
              attempts(around.places, occupants, 50 + run, t, times[k] - t),
              energy);
            rounds.run_in_order();
            occupants         = rounds.occupants();
            t                 = times[k];
            double       sum  = 0.;
            unsigned int size = 0;
            for (unsigned int p = 0; p < occupants.size(); ++p)
              if (counts[occupants[p].key])
                {
                  for (unsigned int d = 0; d < dim; ++d)
                    sum += std::pow(x[p][d] - from[occupants[p].key][d], 2);
                  ++size;
                }
            result[k] += sum / size / (2. * dim * D * t) / n_runs;
          }
      }
    return result;
  }
} // namespace


// Rates that go as S/l give any arrangement of places the same D, at all times:
// the path of a cell among equal ones is a martingale, doc/theory.md, section
// 12.3.
TEST(Diffusion, IsThatOfTheKeyAmongIrregularPlaces)
{
  for (const double ratio : spread<2>(110, 30., 6, {1., 8., 40.}))
    EXPECT_NEAR(ratio, 1., 0.02);
}


// The times are short: no cell that counts meets the wall of the box.
TEST(Diffusion, IsThatOfTheKeyInThreeDimensions)
{
  for (const double ratio : spread<3>(22, 6., 8, {0.5, 1.}))
    EXPECT_NEAR(ratio, 1., 0.02);
}
