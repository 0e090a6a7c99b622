// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "grid/room.h"

using Classes = std::vector<GridCellClass>;
using Blocks  = std::vector<unsigned int>;

template <int dim>
GridBox<dim>
cube(const int n)
{
  GridIndex<dim> first, size;
  first.fill(-3);
  size.fill(n);
  return GridBox<dim>(first, size, 50., Point<dim>());
}

/** Σ|e| in each direction by distance from the block's nearest spline. */
template <int dim>
double
sum_of_magnitudes(const GridIndex<dim> &spline, const GridIndex<dim> &grid_cell)
{
  double product = 1.;
  for (unsigned int d = 0; d < dim; ++d)
    {
      const double k = std::max(0, std::abs(spline[d] - grid_cell[d]) - 1);
      product *= (2. * k * k + 4. * k + 1.); // 1, 7, 17, 31, ...
    }
  return product;
}

/** All active grid cells of a spline's support. */
template <int dim>
Blocks
whole(const GridBox<dim>   &box,
      const Classes        &classes,
      const GridIndex<dim> &spline)
{
  Blocks support;
  for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
    {
      GridIndex<dim> grid_cell = spline;
      for (unsigned int d = 0; d < dim; ++d)
        grid_cell[d] += BSpline<dim>::offset(a, d);
      if (box.contains(grid_cell) && is_active(classes[box.number(grid_cell)]))
        support.push_back(box.number(grid_cell));
    }
  return support;
}

/** A ball of active grid cells, the inner ones at random in its middle. */
template <int dim>
Classes
ball(const GridBox<dim> &box, std::mt19937 &generator)
{
  Classes classes(box.size(), GridCellClass::empty);
  for (unsigned int number = 0; number < box.size(); ++number)
    {
      double r = 0.;
      for (const int i : box.index(number))
        r += (i - 2.6) * (i - 2.6);
      if (std::sqrt(r) < 4.)
        classes[number] = std::sqrt(r) < 2.8 && generator() % 2 == 0 ?
                            GridCellClass::inner :
                            GridCellClass::cut;
    }
  return classes;
}

/** Each grid cell as full as @p fill says. */
template <int dim, typename Fill>
Occupancy<dim>
occupied(const GridBox<dim> &box, const Fill &fill)
{
  Occupancy<dim> occupancy(box);
  for (unsigned int number = 0; number < box.size(); ++number)
    occupancy.add_particle(
      ParticleDomain<dim>(box.center(box.index(number)),
                          fill(number) * std::pow(box.spacing(), dim)));
  return occupancy;
}


/** What an outer spline is expressed by: splines and weights. */
template <int dim>
std::map<GridIndex<dim>, double>
expression(const GridIndex<dim> &spline, const GridIndex<dim> &block)
{
  std::map<GridIndex<dim>, double> terms;
  const auto                       weights = extension_weights(spline, block);
  for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
    if (weights[a] != 0.)
      {
        GridIndex<dim> inner = block;
        for (unsigned int d = 0; d < dim; ++d)
          inner[d] += BSpline<dim>::offset(a, d);
        terms[inner] = weights[a];
      }
  return terms;
}

/** Of all inner grid cells those with the smallest sum, of them those that
 *  give the expression that the most tissue gives. */
template <int dim>
Blocks
best_blocks(const Occupancy<dim> &occupancy,
            const Classes        &classes,
            const GridIndex<dim> &spline)
{
  const GridBox<dim> &box = occupancy.window().whole();
  Blocks              candidates;
  double              best_sum = std::numeric_limits<double>::max();
  for (unsigned int grid_cell = 0; grid_cell < box.size(); ++grid_cell)
    if (classes[grid_cell] == GridCellClass::inner)
      {
        const double sum = sum_of_magnitudes<dim>(spline, box.index(grid_cell));
        if (sum < best_sum)
          candidates.clear();
        if (sum <= best_sum)
          candidates.push_back(grid_cell);
        best_sum = std::min(best_sum, sum);
      }
  std::map<std::map<GridIndex<dim>, double>, double> fills;
  double                                             most = 0.;
  for (const unsigned int grid_cell : candidates)
    {
      double &fill = fills[expression<dim>(spline, box.index(grid_cell))];
      fill += occupancy.fill(grid_cell);
      most = std::max(most, fill);
    }
  Blocks best;
  for (const unsigned int grid_cell : candidates)
    if (fills[expression<dim>(spline, box.index(grid_cell))] == most)
      best.push_back(grid_cell);
  return best;
}


TEST(Extension, WeightsByDistance)
{
  using Weights = std::array<double, 3>;
  EXPECT_EQ(extension_weights(3), (Weights{{1., -3., 3.}}));
  EXPECT_EQ(extension_weights(4), (Weights{{3., -8., 6.}}));
  EXPECT_EQ(extension_weights(5), (Weights{{6., -15., 10.}}));
  EXPECT_EQ(extension_weights(-1), (Weights{{3., -3., 1.}}));
  EXPECT_EQ(extension_weights(-2), (Weights{{6., -8., 3.}}));
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i)
      EXPECT_EQ(extension_weights(j)[i], i == j ? 1. : 0.);
}


TEST_2D_3D(Extension, ContinuesQuadraticCoefficients)
{
  std::mt19937 generator(1);
  for (unsigned int trial = 0; trial < 100; ++trial)
    {
      const auto           a = random_tensor<1, dim>(generator);
      const auto           A = random_tensor<2, dim>(generator);
      const GridIndex<dim> block{};
      GridIndex<dim>       spline;
      for (int &i : spline)
        i = std::uniform_int_distribution<int>(-4, 4)(generator);
      const auto polynomial = [&](const GridIndex<dim> &index) {
        Tensor<1, dim> x;
        for (unsigned int d = 0; d < dim; ++d)
          x[d] = index[d];
        return 0.3 + a * x + x * (A * x);
      };
      const auto weights = extension_weights(spline, block);
      double     sum     = 0.;
      for (unsigned int k = 0; k < BSpline<dim>::n; ++k)
        {
          GridIndex<dim> inner;
          for (unsigned int d = 0; d < dim; ++d)
            inner[d] = BSpline<dim>::offset(k, d);
          sum += weights[k] * polynomial(inner);
        }
      EXPECT_NEAR(sum, polynomial(spline), 1e-11);
    }
}


TEST_2D_3D(Extension, TakesTheFullestBlocksWithTheSmallestSum)
{
  const GridBox<dim> box       = cube<dim>(12);
  unsigned int       n_several = 0, n_one = 0;
  for (unsigned int seed = 1; seed <= 5; ++seed)
    {
      SCOPED_TRACE("seed " + std::to_string(seed));
      std::mt19937  generator(seed);
      const Classes classes = ball(box, generator);
      // A few sums of these are equal, most are not.
      const auto           occupancy = occupied(box, [&](const unsigned int) {
        return 0.75 + 0.0625 * (generator() % 5);
      });
      ExtensionSearch<dim> search(occupancy, classes);
      for (unsigned int spline = 0; spline < box.size(); ++spline)
        {
          const Blocks support = whole(box, classes, box.index(spline));
          if (support.empty())
            continue;
          const Blocks best =
            best_blocks<dim>(occupancy, classes, box.index(spline));
          EXPECT_EQ(search.blocks(box.index(spline), support), best)
            << "spline " << spline;
          (best.size() > 1 ? n_several : n_one) += 1;
        }
    }
  EXPECT_GT(n_several, 0u);
  EXPECT_GT(n_one, 0u);
}


// The fullest may be preferred, but not one by its number: which one that is
// would depend on the frame.
TEST(Extension, TakesAllBlocksThatTieInFillAsWell)
{
  const GridBox<2> box = cube<2>(12);
  Classes          classes(box.size(), GridCellClass::cut);
  const Blocks     ring = {box.number({{{2, 0}}}),
                           box.number({{{0, 2}}}),
                           box.number({{{4, 2}}}),
                           box.number({{{2, 4}}})};
  for (const unsigned int grid_cell : ring)
    classes[grid_cell] = GridCellClass::inner;
  classes[box.number({{{0, 0}}})] = GridCellClass::inner; // 49 against 7
  const auto blocks               = [&](const std::array<double, 4> &fills) {
    const auto occupancy = occupied(box, [&](const unsigned int number) {
      const auto found = std::find(ring.begin(), ring.end(), number);
      return found == ring.end() ? 1. : fills[found - ring.begin()];
    });
    ExtensionSearch<2> search(occupancy, classes);
    return search.blocks({{{2, 2}}}, whole<2>(box, classes, {{{2, 2}}}));
  };
  EXPECT_EQ(blocks({{0.9, 0.9, 0.9, 0.9}}), ring);
  // what a solver leaves between a body and its mirror image
  EXPECT_EQ(blocks({{0.9, 0.9 + 1e-8, 0.9 - 1e-8, 0.9}}), ring);
  EXPECT_EQ(blocks({{0.9, 0.9, 0.91, 0.9}}), Blocks{ring[2]});
  EXPECT_EQ(blocks({{0.9, 0.91, 0.9, 0.91}}), (Blocks{ring[1], ring[3]}));
}
