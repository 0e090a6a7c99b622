// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "grid/room.h"

/** u_i(x) = a_i + A_ij x_j + x·C_i x */
template <int dim>
struct Quadratic
{
  Tensor<1, dim>                           a;
  Tensor<2, dim>                           A;
  std::array<SymmetricTensor<2, dim>, dim> C;

  explicit Quadratic(std::mt19937 &generator)
    : a(100. * random_tensor<1, dim>(generator))
    , A(random_tensor<2, dim>(generator))
  {
    for (auto &c : C)
      c = symmetrize(random_tensor<2, dim>(generator)) / 100.;
  }

  Tensor<1, dim>
  value(const Point<dim> &x) const
  {
    Tensor<1, dim> u = a + A * x;
    for (unsigned int i = 0; i < dim; ++i)
      u[i] += x * (C[i] * x);
    return u;
  }

  Tensor<2, dim>
  gradient(const Point<dim> &x) const
  {
    Tensor<2, dim> G = A;
    for (unsigned int i = 0; i < dim; ++i)
      G[i] += 2. * (C[i] * x);
    return G;
  }

  /** Σ c_k² N_k(x) = x² + h²/4 for splines centred at c_k: the coefficients
   *  are the values at the centres less h²/4 for each x². */
  Tensor<1, dim>
  coefficient(const Point<dim> &center) const
  {
    Tensor<1, dim> u = value(center);
    for (unsigned int i = 0; i < dim; ++i)
      u[i] -= 0.25 * h * h * trace(C[i]);
    return u;
  }
};

/** Checks the field with these coefficients at all particles. */
template <int dim, typename Value, typename Gradient>
void
expect_field(const BodyOnGrid<dim>     &body,
             const Equilibrium::Vector &u,
             const Value               &value,
             const Gradient            &gradient)
{
  double largest = 0., largest_gradient = 0.;
  for (const Point<dim> &x : body.particles)
    {
      largest          = std::max(largest, value(x).norm());
      largest_gradient = std::max(largest_gradient, gradient(x).norm());
    }
  unsigned int n_points = 0;
  body.at_points(body.particles,
                 u,
                 [&](const unsigned int       i,
                     const LocalField<dim>   &field,
                     const SplineValues<dim> &splines) {
                   const Point<dim> &x = body.particles[i];
                   EXPECT_LE((field.value(splines) - value(x)).norm(),
                             1e-10 * largest);
                   EXPECT_LE((field.step_deformation(splines) -
                              unit_tensor<dim>() - gradient(x))
                               .norm(),
                             1e-10 * largest_gradient);
                   ++n_points;
                 });
  EXPECT_EQ(sum_over_ranks(n_points), body.particles.size());
}

template <int dim>
void
expect_affine(const BodyOnGrid<dim> &body, std::mt19937 &generator)
{
  const auto a = 100. * random_tensor<1, dim>(generator);
  const auto A = random_tensor<2, dim>(generator);
  expect_field(
    body,
    body.vector_of(body.affine(a, A)),
    [&](const Point<dim> &x) { return a + A * x; },
    [&](const Point<dim> &) { return A; });
}

/** The field with the coefficients wild(Qᵀ c) of the splines centred at c, at
 *  all particles. */
template <int dim>
std::vector<double>
wild_field(const std::vector<Point<dim>> &points, const Tensor<2, dim> &Q)
{
  std::vector<Point<dim>> turned;
  for (const Point<dim> &x : points)
    turned.emplace_back(Q * x);
  const auto          there = body<dim>(turned);
  std::vector<double> values(points.size(), 0.);
  there.at_points(turned,
                  there.interpolate([&](const Point<dim> &center) {
                    const Tensor<1, dim> c = transpose(Q) * center;
                    Tensor<1, dim>       value;
                    value[0] = std::sin(0.7 * c[0] + 1.3 * c[1] + c[dim - 1]);
                    return value;
                  }),
                  [&](const unsigned int       i,
                      const LocalField<dim>   &field,
                      const SplineValues<dim> &splines) {
                    values[i] = field.value(splines)[0];
                  });
  Utilities::MPI::sum(values, MPI_COMM_WORLD, values);
  return values;
}

/** Two blocks of full grid cells with @p gap empty layers between them. */
BodyOnGrid<2>
blocks_with_gap(const int gap, const bool joined = false)
{
  const auto points =
    lattice_points<2>(Point<2>(), 12. * h, h / 4., [&](const Point<2> &x) {
      const bool between = x[0] > -3. * h && x[0] < (gap + 3) * h;
      return (x[1] > 0. && x[1] < 3. * h &&
              ((x[0] > -3. * h && x[0] < 0.) ||
               (x[0] > gap * h && x[0] < (gap + 3) * h))) ||
             (joined && between && x[1] > -3. * h && x[1] < 0.);
    });
  return BodyOnGrid<2>(points, h * h / 16.);
}


TEST_2D_3D(SplineSpace, ReproducesQuadraticsForAnyCut)
{
  for (unsigned int seed = 1; seed <= 6; ++seed)
    {
      SCOPED_TRACE("seed " + std::to_string(seed));
      const auto   cut   = body<dim>(random_body<dim>(seed));
      const auto  &space = *cut.space;
      std::mt19937 generator(100 + seed);
      ASSERT_EQ(space.n_pieces(), 1u);
      ASSERT_EQ(space.n_unknowns(), space.n_inner_splines());
      ASSERT_GT(space.n_outer_splines(), 0u);
      const Quadratic<dim> field(generator);
      expect_field(
        cut,
        cut.interpolate(
          [&](const Point<dim> &c) { return field.coefficient(c); }),
        [&](const Point<dim> &x) { return field.value(x); },
        [&](const Point<dim> &x) { return field.gradient(x); });
      expect_affine(cut, generator);
    }
}


// The weights of each spline in all active grid cells sum up to one.
TEST_2D_3D(SplineSpace, PartitionOfUnity)
{
  ONE_RANK_IS_ENOUGH();
  for (unsigned int seed = 1; seed <= 6; ++seed)
    {
      SCOPED_TRACE("seed " + std::to_string(seed));
      const auto cut = body<dim>(random_body<dim>(seed));
      for (const auto &grid_cell : cut.space->grid_cells())
        {
          const unsigned int m = grid_cell.unknowns.size();
          for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
            {
              double sum = grid_cell.weights.empty() ? 1. : 0.;
              if (!grid_cell.weights.empty())
                for (unsigned int s = 0; s < m; ++s)
                  sum += grid_cell.weights[a * m + s];
              EXPECT_NEAR(sum, 1., 1e-11);
            }
          const std::set<unsigned int> different(grid_cell.unknowns.begin(),
                                                 grid_cell.unknowns.end());
          EXPECT_EQ(different.size(), m);
          // Work for such weights would be in vain.
          const std::size_t n_zeros =
            std::count(grid_cell.weights.begin(), grid_cell.weights.end(), 0.);
          EXPECT_FALSE(m == BSpline<dim>::n &&
                       grid_cell.weights.size() - n_zeros == m);
        }
    }
}


// A few particles each, far from each other: no inner grid cell.
TEST_2D_3D(SplineSpace, FragmentsReproduceAffineFields)
{
  std::mt19937            generator(7);
  std::vector<Point<dim>> points;
  for (unsigned int piece = 0; piece < 3; ++piece)
    for (unsigned int i = 0; i <= piece; ++i)
      {
        Point<dim> x(30. * random_tensor<1, dim>(generator));
        x[0] += piece * 8. * h;
        points.push_back(x);
      }
  const auto  fragments = body<dim>(points);
  const auto &space     = *fragments.space;
  EXPECT_EQ(space.n_pieces(), 3u);
  EXPECT_EQ(space.n_inner_splines(), 0u);
  EXPECT_EQ(space.n_unknowns() % (dim + 1), 0u);
  EXPECT_GE(space.n_unknowns(), 3u * (dim + 1));
  expect_affine(fragments, generator);
}


// One body with inner grid cells, one fragment: each moves alone.
TEST_2D_3D(SplineSpace, PiecesMoveIndependently)
{
  std::vector<Point<dim>> points = random_body<dim>(1);
  Point<dim>              far    = points.front();
  for (const Point<dim> &x : points)
    far[0] = std::max(far[0], x[0]);
  far[0] += 4. * h;
  points.push_back(far);
  const auto  both  = body<dim>(points);
  const auto &space = *both.space;
  ASSERT_EQ(space.n_pieces(), 2u);
  std::mt19937 generator(3);
  expect_affine(both, generator);

  std::set<unsigned int> found;
  for (const auto &grid_cell : space.grid_cells())
    found.insert(space.piece(grid_cell.number));
  for (const unsigned int piece : found)
    EXPECT_LT(piece, 2u);
  EXPECT_EQ(space.pieces_of_unknowns().size(), space.owned().n_elements());

  const auto  a   = random_tensor<1, dim>(generator);
  const auto  A   = random_tensor<2, dim>(generator);
  const auto &box = space.box();
  for (unsigned int piece = 0; piece < 2; ++piece)
    both.at_points(points,
                   both.vector_of(affine_displacement(space, piece, a, A)),
                   [&](const unsigned int       i,
                       const LocalField<dim>   &field,
                       const SplineValues<dim> &splines) {
                     const Tensor<1, dim> expected =
                       space.piece(box.number(box.locate(points[i]))) == piece ?
                         a + A * points[i] :
                         Tensor<1, dim>();
                     EXPECT_LE((field.value(splines) - expected).norm(),
                               1e-10 * (1. + points[i].norm()));
                   });
}


// A body that is turned or mirrored has the same splines, turned or mirrored.
TEST_2D_3D(SplineSpace, IsTheSameInAnyFrame)
{
  ONE_RANK_IS_ENOUGH();
  for (unsigned int seed = 1; seed <= 4; ++seed)
    {
      const auto points = random_body<dim>(seed);
      const auto here   = wild_field<dim>(points, unit_tensor<dim>());
      for (unsigned int first = 0; first < dim; ++first)
        for (const double sign : {1., -1.})
          {
            SCOPED_TRACE("seed " + std::to_string(seed) + ", axis " +
                         std::to_string(first) + ", " + std::to_string(sign));
            Tensor<2, dim> Q; // sends the axes to each other
            for (unsigned int d = 0; d < dim; ++d)
              Q[(first + d) % dim][d] = d == 0 ? sign : -1.;
            const auto there = wild_field<dim>(points, Q);
            for (std::size_t i = 0; i < points.size(); ++i)
              ASSERT_NEAR(here[i], there[i], 1e-10);
          }
    }
}


TEST_2D_3D(SplineSpace, WithoutExtensionEverySplineIsAnUnknown)
{
  GridParameters parameters;
  parameters.extension = false;
  const BodyOnGrid<dim> raw(random_body<dim>(2),
                            std::pow(cell_spacing<dim>(), dim),
                            parameters);
  const auto           &space = *raw.space;
  EXPECT_EQ(space.n_unknowns(),
            space.n_inner_splines() + space.n_outer_splines());
  for (const auto &grid_cell : space.grid_cells())
    {
      EXPECT_EQ(grid_cell.unknowns.size(), BSpline<dim>::n);
      for (const double weight : grid_cell.weights)
        EXPECT_TRUE(weight == 0. || weight == 1.);
    }
  std::mt19937         generator(5);
  const Quadratic<dim> field(generator);
  expect_field(
    raw,
    raw.interpolate([&](const Point<dim> &c) { return field.coefficient(c); }),
    [&](const Point<dim> &x) { return field.value(x); },
    [&](const Point<dim> &x) { return field.gradient(x); });
}


// One empty layer of grid cells, which both blocks' splines reach over, is
// enough.
TEST(SplineSpace, BodiesAcrossAnEmptyLayerDoNotShareSplines)
{
  EXPECT_EQ(blocks_with_gap(0).space->n_pieces(), 1u);
  const unsigned int apart = blocks_with_gap(8).space->n_unknowns();
  for (const int gap : {1, 2, 3})
    {
      SCOPED_TRACE("gap of " + std::to_string(gap));
      const auto blocks = blocks_with_gap(gap);
      EXPECT_EQ(blocks.space->n_pieces(), 2u);
      EXPECT_EQ(blocks.space->n_unknowns(), apart);
    }
}


// Two arms of one body: no part of one moves with a part of the other.
TEST(SplineSpace, ArmsAcrossAnEmptyLayerDoNotShareSplines)
{
  const auto  body  = blocks_with_gap(1, true);
  const auto &space = *body.space;
  EXPECT_EQ(space.n_pieces(), 1u);
  const auto sides_of = [&](const SplineSpace<2>::GridCell &grid_cell) {
    return space.box().index(grid_cell.number)[0] < 0 ? 1 : 2;
  };
  std::vector<unsigned int> sides(space.relevant().n_elements(), 0);
  for (const auto &grid_cell : space.grid_cells())
    if (space.box().index(grid_cell.number)[1] >= 2)
      for (const unsigned int unknown : grid_cell.unknowns)
        sides[unknown] |= sides_of(grid_cell);
  for (const unsigned int both : sides)
    EXPECT_LT(both, 3u);
  EXPECT_EQ(blocks_with_gap(8, true).space->n_pieces(), 1u);
}
