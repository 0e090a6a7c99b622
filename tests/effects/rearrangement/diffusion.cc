// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/rearrangement/places_of_tissue.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "effects/fate/lives.h"

using namespace Morula;

namespace
{
  constexpr double a = 10., D = 100.; // µm, µm²/day: D t = a² in a day

  /** How the places stand. */
  enum class Order
  {
    lattice,
    moved,   // each at random by up to 0.3 a along each axis
    Poisson, // anywhere
    even     // anywhere, then moved to the middles of their Voronoi cells
  };

  /** The points, each moved to the middle of what is nearest to it of the
   *  square whose opposite sides are joined, many times (Lloyd). */
  template <int dim>
  void
  even_out(std::vector<Point<dim>> &points, const unsigned int n)
  {
    constexpr unsigned int n_rounds = 20, per_cell = 6;
    const double           edge = n * a;
    for (unsigned int round = 0; round < n_rounds; ++round)
      {
        // The points by squares of edge a; nearly all samples have their
        // nearest one within two squares.
        std::vector<std::vector<unsigned int>> boxes(n * n);
        for (unsigned int i = 0; i < points.size(); ++i)
          boxes[unsigned(points[i][1] / a) % n * n +
                unsigned(points[i][0] / a) % n]
            .push_back(i);
        std::vector<Tensor<1, dim>> sums(points.size());
        std::vector<unsigned int>   numbers(points.size(), 0);
        for (unsigned int k = 0; k < n * n * per_cell * per_cell; ++k)
          {
            const unsigned int x = k % (n * per_cell), y = k / (n * per_cell);
            std::array<double, 2> at = {
              {(x + 0.5) * a / per_cell, (y + 0.5) * a / per_cell}};
            double         least = edge * edge;
            unsigned int   first = 0;
            Tensor<1, dim> to_sample;
            for (unsigned int other = 0; other < 25; ++other)
              for (const unsigned int i :
                   boxes[(y / per_cell + n + other / 5 - 2) % n * n +
                         (x / per_cell + n + other % 5 - 2) % n])
                {
                  Tensor<1, dim> r;
                  for (unsigned int d = 0; d < 2; ++d)
                    r[d] = std::remainder(at[d] - points[i][d], edge);
                  if (r.norm_square() < least)
                    {
                      least     = r.norm_square();
                      first     = i;
                      to_sample = r;
                    }
                }
            sums[first] += to_sample;
            ++numbers[first];
          }
        for (unsigned int i = 0; i < points.size(); ++i)
          for (unsigned int d = 0; d < 2 && numbers[i] > 0; ++d)
            points[i][d] =
              std::fmod(points[i][d] + edge + sums[i][d] / numbers[i], edge);
      }
  }

  /** Places in a cube of so many cells along an edge, whose opposite sides are
   *  joined. */
  template <int dim>
  std::vector<Point<dim>>
  points_of(const unsigned int n, const Order order, const unsigned int seed)
  {
    std::mt19937                           generator(seed);
    std::uniform_real_distribution<double> uniform(0., 1.);
    std::vector<Point<dim>> points(Utilities::fixed_power<dim>(n));
    for (unsigned int i = 0; i < points.size(); ++i)
      for (unsigned int d = 0, k = i; d < dim; ++d, k /= n)
        {
          const double u = uniform(generator);
          if (order == Order::Poisson || order == Order::even)
            points[i][d] = n * a * u;
          else
            points[i][d] =
              (k % n + 0.5 + (order == Order::moved ? 0.6 * u - 0.3 : 0.)) * a;
        }
    if (order == Order::even)
      even_out(points, n);
    return points;
  }

  /** The places as the program finds them among copies of the cube around,
   *  which are then taken for the places of which they are copies. */
  template <int dim>
  Places
  closed_places(const unsigned int n,
                const Order        order,
                const unsigned int seed)
  {
    constexpr double          margin    = 4. * a;
    std::vector<Point<dim>>   positions = points_of<dim>(n, order, seed);
    const unsigned int        n_places  = positions.size();
    std::vector<unsigned int> copy_of(n_places);
    std::iota(copy_of.begin(), copy_of.end(), 0u);
    for (unsigned int image = 0; image < Utilities::fixed_power<dim>(3u);
         ++image)
      for (unsigned int i = 0; i < n_places; ++i)
        {
          Point<dim> x       = positions[i];
          bool       is_near = true, is_copy = false;
          for (unsigned int d = 0, k = image; d < dim; ++d, k /= 3)
            {
              x[d] += (int(k % 3) - 1) * (n * a);
              is_near = is_near && x[d] > -margin && x[d] < n * a + margin;
              is_copy = is_copy || k % 3 != 1;
            }
          if (is_near && is_copy)
            {
              positions.push_back(x);
              copy_of.push_back(i);
            }
        }

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
      cells.push_back({tissue.cells().id(p) + 1, 0, D, {{0., 0., 0.}}, 0, p});
    const Places all = places_of(tissue, cells).places;

    std::vector<unsigned int> found(positions.size());
    for (unsigned int p = 0; p < all.size(); ++p)
      found[all.keys[p] - 1] = p;
    Places places;
    places.offsets.push_back(0);
    for (unsigned int i = 0; i < n_places; ++i)
      {
        const unsigned int p = found[i];
        places.keys.push_back(i + 1);
        places.positions.push_back(all.positions[p]);
        places.free.push_back(0.);
        places.own.push_back(true);
        for (unsigned int e = all.offsets[p]; e < all.offsets[p + 1]; ++e)
          {
            Places::Edge edge = all.edges[e];
            edge.other        = copy_of[all.keys[edge.other] - 1];
            places.edges.push_back(edge);
          }
        places.offsets.push_back(places.edges.size());
      }
    places.sort_edges();
    return places;
  }

  /** The way from one place to the other, in the cube whose sides are joined.
   */
  template <int dim>
  Tensor<1, dim>
  way(const std::array<double, 3> &x,
      const std::array<double, 3> &y,
      const double                 edge)
  {
    Tensor<1, dim> found;
    for (unsigned int d = 0; d < dim; ++d)
      found[d] = std::remainder(y[d] - x[d], edge);
    return found;
  }

  /** Σ ν l² over 2 d D of all places: what the mean square displacement over
   *  2 d D t begins with. */
  template <int dim>
  double
  first_spread(const Places &places, const unsigned int n)
  {
    double sum = 0.;
    for (unsigned int p = 0; p < places.size(); ++p)
      for (unsigned int e = places.offsets[p]; e < places.offsets[p + 1]; ++e)
        sum += places.edges[e].rate *
               way<dim>(places.positions[p],
                        places.positions[places.edges[e].other],
                        n * a)
                 .norm_square();
    return sum / (2. * dim * places.size());
  }

  /** The mean square displacement over 2 d D t after each time. */
  template <int dim>
  std::vector<double>
  spread(Places                     places,
         const unsigned int         n,
         const std::vector<double> &times,
         const std::uint64_t        seed)
  {
    const AdhesionEnergy  energy(TypeTensions(), 1.);
    const auto           &x = places.positions;
    std::vector<Occupant> occupants;
    for (unsigned int p = 0; p < places.size(); ++p)
      occupants.push_back({p + 1, 0, D, {{0., 0., 0.}}, 0, p});
    std::vector<Tensor<1, dim>> ways(places.size());
    std::vector<double>         result;
    constexpr double            step = 1.;
    double                      t    = 0.;
    for (const double end : times)
      {
        for (; t < end - 0.5 * step; t += step)
          {
            // The clocks of a step follow the cells that are there. A cell does
            // not come half around the cube in a step.
            std::vector<unsigned int> before(places.size());
            for (unsigned int p = 0; p < places.size(); ++p)
              {
                places.keys[p]              = occupants[p].key;
                before[occupants[p].number] = p;
              }
            places.sort_edges();
            ExchangeRounds rounds(places,
                                  occupants,
                                  attempts(places, occupants, seed, t, step),
                                  energy);
            rounds.run_in_order();
            occupants = rounds.occupants();
            for (unsigned int p = 0; p < places.size(); ++p)
              ways[occupants[p].number] +=
                way<dim>(x[before[occupants[p].number]], x[p], n * a);
          }
        double sum = 0.;
        for (const Tensor<1, dim> &r : ways)
          sum += r.norm_square();
        result.push_back(sum / ways.size() / (2. * dim * D * t));
      }
    return result;
  }

  /** The share of unlike neighbours, by facets. */
  double
  unlike_share(const Places &places, const std::vector<Occupant> &occupants)
  {
    double all = 0., unlike = 0.;
    for (unsigned int p = 0; p < places.size(); ++p)
      for (unsigned int e = places.offsets[p]; e < places.offsets[p + 1]; ++e)
        {
          const Places::Edge &edge = places.edges[e];
          all += edge.area;
          unlike +=
            occupants[p].type == occupants[edge.other].type ? 0. : edge.area;
        }
    return unlike / all;
  }

  /** Two types, half of the cells each at random, with γ a^(d-1) = 1: the share
   * of unlike neighbours after each time. */
  template <int dim>
  std::vector<double>
  sorted(Places                     places,
         const double               T,
         const double               part,
         const std::vector<double> &times)
  {
    const double          gamma = 1. / Utilities::fixed_power<dim - 1>(a);
    const AdhesionEnergy  energy({{{0., gamma}, {gamma, 0.}}, {0., 0.}}, T);
    std::mt19937          generator(5);
    std::vector<Occupant> occupants;
    for (unsigned int p = 0; p < places.size(); ++p)
      occupants.push_back(
        {p + 1, p < part * places.size(), D, {{0., 0., 0.}}, 0, p});
    std::shuffle(occupants.begin(), occupants.end(), generator);
    std::vector<double> shares;
    double              t = 0.;
    for (const double end : times)
      {
        // Steps may be as long as one likes: the clocks are exact.
        while (t < end)
          {
            const double step = std::min(1., end - t);
            for (unsigned int p = 0; p < places.size(); ++p)
              places.keys[p] = occupants[p].key;
            places.sort_edges();
            ExchangeRounds rounds(places,
                                  occupants,
                                  attempts(places, occupants, 9, t, step),
                                  energy);
            rounds.run_in_order();
            occupants = rounds.occupants();
            t += step;
          }
        shares.push_back(unlike_share(places, occupants));
      }
    return shares;
  }

  template <int dim>
  void
  check_spread(const unsigned int         n,
               const Order                order,
               const std::vector<double> &times)
  {
    const Places places = closed_places<dim>(n, order, 3);
    EXPECT_NEAR(first_spread<dim>(places, n), 1., 0.01);
    // r² of one cell is as uncertain as it is large.
    constexpr unsigned int n_runs = 8;
    std::vector<double>    mean(times.size(), 0.);
    for (unsigned int run = 0; run < n_runs; ++run)
      {
        const auto ratios = spread<dim>(places, n, times, 50 + run);
        for (std::size_t k = 0; k < times.size(); ++k)
          mean[k] += ratios[k] / n_runs;
      }
    for (const double ratio : mean)
      EXPECT_NEAR(ratio, 1., 0.02) << dim << "-D";
  }
} // namespace


// Rates that go as S/l give any arrangement of places the same D, at all times:
// the path of a cell among equal ones is a martingale, doc/theory.md, section
// 12.3.
TEST(Diffusion, IsThatOfTheKeyAmongPoissonPoints)
{
  check_spread<2>(80, Order::Poisson, {1., 10.});
  check_spread<3>(16, Order::Poisson, {1., 10.});
}

TEST(Diffusion, IsThatOfTheKeyOnLattices)
{
  for (const Order order : {Order::lattice, Order::moved})
    {
      check_spread<2>(80, order, {1., 3.});
      check_spread<3>(16, order, {1., 3.});
    }
}

// Two types that avoid each other. The shares were found independently, with
// rates that go as S: those that go as S/l sort alike.
template <int dim>
static void
check_sorting(const Places              &places,
              const double               T,
              const double               part,
              const std::vector<double> &times,
              const std::vector<double> &expected)
{
  const auto shares = sorted<dim>(places, T, part, times);
  for (unsigned int k = 0; k < times.size(); ++k)
    EXPECT_NEAR(shares[k], expected[k], 0.015) << dim << "-D, t = " << times[k];
}

TEST(Diffusion, SortsTwoTypes)
{
  const Places even = closed_places<2>(64, Order::even, 3);
  check_sorting<2>(
    even, 0.8, 0.5, {0., 4.6, 18., 74.}, {0.508, 0.303, 0.255, 0.208});
  check_sorting<2>(even, 0.8, 0.3, {0., 4.6, 18.}, {0.423, 0.256, 0.218});
  check_sorting<3>(closed_places<3>(16, Order::Poisson, 3),
                   1.6,
                   0.5,
                   {0., 3.3, 13.},
                   {0.502, 0.353, 0.306});
}
