// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  constexpr double a = 10., D = 100.; // µm, µm²/day: D t = a² in a day

  /** How the places stand. */
  enum class Order
  {
    lattice,
    moved,  // each at random by up to 0.3 a along each axis
    Poisson // anywhere
  };

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
          if (order == Order::Poisson)
            points[i][d] = n * a * u;
          else
            points[i][d] =
              (k % n + 0.5 + (order == Order::moved ? 0.6 * u - 0.3 : 0.)) * a;
        }
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

    const CellDevelopment<dim> development =
      development_of<dim>(scene_of({"Dimension=" + std::to_string(dim)}));
    GridParameters grid;
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
      cells.push_back({tissue.cells().id(p) + 1, 0, D, {}, 0, p});
    const Places all = places_of(tissue, cells);

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
  way(const Point<3> &x, const Point<3> &y, const double edge)
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
} // namespace


// Rates that go as S/l give any arrangement of places the same D, at all times:
// the path of a cell among equal ones is a martingale, doc/theory.md, section
// 12.3.
TEST_2D_3D(Diffusion, IsThatOfTheKey)
{
  constexpr unsigned int n = dim == 2 ? 80 : 16;
  for (const Order order : {Order::Poisson, Order::lattice, Order::moved})
    EXPECT_NEAR(first_spread<dim>(closed_places<dim>(n, order, 3), n),
                1.,
                0.01);
}
