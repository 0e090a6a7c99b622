// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  template <int dim>
  using Local = typename FieldEquation<dim>::Local;

  /** A grid cell with some cells and boundary points, which may have fluxes. */
  template <int dim>
  FieldEquation<dim>
  some_equation(const double rate)
  {
    FieldEquation<dim> equation;
    equation.cell_places.h = equation.surface_places.h = 20.;
    for (unsigned int p = 0; p < 5; ++p)
      {
        Point<dim>     xi;
        Tensor<1, dim> flux;
        for (unsigned int d = 0; d < dim; ++d)
          {
            xi[d]   = 0.5 + 0.4 * std::sin(3. * p + d);
            flux[d] = std::cos(2. * p - d);
          }
        equation.cell_places.xi.push_back(xi);
        equation.cells.push_back({10. + p, 300. * (1. + p), rate, 0.3 * p});
        if (p > 2)
          continue;
        equation.surface_places.xi.push_back(xi);
        equation.surface.push_back({flux, 7. + p, 90. * p, 2., 3. - p});
      }
    equation.cell_places.offsets    = {0, 5};
    equation.surface_places.offsets = {0, 3};
    equation.steepness              = {0.3};
    return equation;
  }

  /** Of its cells, weighted by volume, µm²/day. */
  double
  mean_diffusion()
  {
    double volume = 0., sum = 0.;
    for (unsigned int p = 0; p < 5; ++p)
      {
        volume += 10. + p;
        sum += (10. + p) * 300. * (1. + p);
      }
    return sum / volume;
  }

  template <int dim>
  LocalField<dim, 1>
  some_field()
  {
    LocalField<dim, 1> field;
    for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
      field.coefficient[0][a] = std::sin(1. + a);
    return field;
  }

  template <int dim>
  std::vector<double>
  matrix(const FieldEquation<dim> &equation)
  {
    Local<dim> local(Local<dim>::tangent);
    equation(0, some_field<dim>(), local);
    return local.matrix;
  }

  /** Row a of the matrix times the field. */
  template <int dim>
  double
  row_times(const std::vector<double> &matrix,
            const unsigned int         a,
            const LocalField<dim, 1>  &field)
  {
    double sum = 0.;
    for (unsigned int b = 0; b < BSpline<dim>::n; ++b)
      sum += matrix[a * BSpline<dim>::n + b] * field.coefficient[0][b];
    return sum;
  }
} // namespace


TEST_2D_3D(FieldEquation, IsSymmetric)
{
  constexpr unsigned int n = BSpline<dim>::n;
  const auto             A = matrix(some_equation<dim>(0.7));
  for (unsigned int a = 0; a < n; ++a)
    for (unsigned int b = 0; b < a; ++b)
      EXPECT_NEAR(A[a * n + b], A[b * n + a], 1e-12);
}


/** Without a rate the load is that of the known field 0, less the matrix
 *  times the known field. */
TEST_2D_3D(FieldEquation, TakesWhatTheKnownFieldGives)
{
  const FieldEquation<dim> equation = some_equation<dim>(0.);
  const auto               A        = matrix(equation);
  const auto               field    = some_field<dim>();
  Local<dim>               load(Local<dim>::energy_and_residual);
  Local<dim>               of_zero(Local<dim>::energy_and_residual);
  equation(0, field, load);
  LocalField<dim, 1> zero = {};
  equation(0, zero, of_zero);
  double largest = 0.;
  for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
    {
      largest = std::max(largest, std::abs(load.residual[a]));
      EXPECT_NEAR(load.residual[a],
                  of_zero.residual[a] - row_times(A, a, field),
                  1e-9);
    }
  EXPECT_GT(largest, 1.);
}


// Of a point with a D = 100 um^3/day, in units of that: 20/h = 1 per um, and
// what falls off within 1/k um. Rows add up to the penalty, as the sum of all
// splines is 1.
TEST(FieldEquation, HoldsMoreFirmlyWhatFallsOffWithinAGridCell)
{
  const auto penalty = [](const std::vector<double> &steepness) {
    FieldEquation<3> equation = some_equation<3>(0.);
    equation.surface          = {{{}, 0., 100., 1., 0.}};
    equation.surface_places.xi.resize(1);
    equation.surface_places.offsets = {0, 1};
    equation.steepness              = steepness;
    double sum                      = 0.;
    for (const double entry : matrix(equation))
      sum += entry;
    return sum;
  };
  EXPECT_NEAR(penalty({}), 100., 1e-9);
  EXPECT_NEAR(penalty({0.}), 100., 1e-9);
  EXPECT_NEAR(penalty({0.75}), 125., 1e-9);
}


TEST(FieldEquation, KnowsWithinWhatAFixedValueFallsOff)
{
  FieldEquation<2> equation = some_equation<2>(3.8);
  find_steepness(equation);
  EXPECT_NEAR(equation.steepness[0], std::sqrt(3.8 / mean_diffusion()), 1e-12);
  for (FieldAtCell &cell : equation.cells)
    cell.diffusion = 0.;
  find_steepness(equation);
  EXPECT_EQ(equation.steepness[0], 0.);
}


/** Lumped terms stand on the diagonal and have the same row sums. */
TEST_2D_3D(FieldEquation, LumpsWithTheSameSums)
{
  constexpr unsigned int n          = BSpline<dim>::n;
  FieldEquation<dim>     equation   = some_equation<dim>(0.7);
  const auto             consistent = matrix(equation);
  const auto             without    = matrix(some_equation<dim>(0.));
  equation.lumped                   = {true};
  const auto lumped                 = matrix(equation);
  for (unsigned int a = 0; a < n; ++a)
    {
      double sum = 0.;
      for (unsigned int b = 0; b < n; ++b)
        {
          sum += lumped[a * n + b] - consistent[a * n + b];
          if (a != b)
            {
              EXPECT_NEAR(lumped[a * n + b], without[a * n + b], 1e-12);
            }
        }
      EXPECT_NEAR(sum, 0., 1e-11);
    }
}


TEST(FieldEquation, MarksWhereTheFieldEnds)
{
  const auto marked = [](const double rate, const bool fixed) {
    FieldEquation<2> equation = some_equation<2>(rate);
    for (FieldAtSurface<2> &point : equation.surface)
      point.fixed = fixed ? 1. : 0.;
    equation.lumped = {false};
    find_steepness(equation);
    mark_lumped(equation);
    return bool(equation.lumped[0]);
  };
  const double limit = 6. * mean_diffusion() / (20. * 20.);
  EXPECT_FALSE(marked(0.99 * limit, false));
  EXPECT_TRUE(marked(1.01 * limit, false));
  EXPECT_FALSE(marked(1.01 * limit, true));
}
