// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/surface/nitsche_bounded.h>

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "common/finite_differences.h"
#include "common/materials.h"

using namespace Morula;

namespace
{
  /** Fixed and slip points on one grid cell with some traction. */
  template <int dim>
  struct Problem
  {
    GroupedPoints<dim>                            points;
    std::vector<typename Nitsche<dim>::HeldPoint> held_points;
    std::vector<Tensor<1, dim>>                   tractions;

    explicit Problem(std::mt19937 &generator)
      : points(random_points_in_cell<dim>(generator, 4))
    {
      for (unsigned int p = 0; p < 4; ++p)
        {
          Tensor<1, dim> N = random_tensor<1, dim>(generator);
          N /= N.norm();
          typename Nitsche<dim>::HeldPoint held;
          held.projection =
            p % 2 == 0 ? unit_tensor<dim>() : outer_product(N, N);
          held.gap = held.projection * random_tensor<1, dim>(generator);
          held.position_scale = 100.;
          held.normal         = N;
          held.area           = 30. + p;
          held.penalty        = 2. + p;
          held.lame           = lame(1., 0.3);
          held_points.push_back(held);
          tractions.push_back(held.projection *
                              random_tensor<1, dim>(generator));
        }
    }

    BoundedNitsche<dim>
    term() const
    {
      return {points, held_points, tractions};
    }

    /** Σ a_t β, and the least that the energy can be: -Σ a_t |T|²/(2β). */
    double
    lower_bound() const
    {
      double sum = 0.;
      for (unsigned int p = 0; p < 4; ++p)
        sum -= held_points[p].area * tractions[p].norm_square() /
               (2. * held_points[p].penalty);
      return sum;
    }
  };

  /** Gaps from far below to far above the one at which the penalty doubles, a
   *  fifth of h. */
  template <int dim>
  void
  check_derivatives()
  {
    std::mt19937 generator(1);
    for (const double gap : {0., 0.1, 10., 30.})
      {
        Problem<dim> problem(generator);
        const auto   field = random_field<dim>(generator, 0.15);
        for (unsigned int p = 0; p < 4; ++p)
          {
            auto &held = problem.held_points[p];
            held.gap   = held.projection *
                       (gap * held.normal -
                        field.value(SplineValues<dim>(problem.points.xi[p],
                                                      problem.points.h)));
          }
        const auto term = problem.term();
        EXPECT_TRUE(term.is_conservative());
        expect_derivatives(term, field);
      }
  }

  /** Where a point is squeezed to nothing, or inside out, there is an energy,
   *  and not less than the bound; that of the symmetric form falls below. */
  template <int dim>
  void
  check_lower_bound()
  {
    std::mt19937       generator(2);
    const Problem<dim> problem(generator);
    const auto         bounded = problem.term();
    const Nitsche<dim> symmetric(
      NitscheForm::symmetric,
      neo_hookean(),
      PartOfLaw::all,
      problem.points,
      problem.held_points,
      std::vector<ElasticState<dim>>(4, {unit_tensor<dim>(), 1.}),
      {});
    double least_symmetric = 0.;
    for (const double squeeze : {0.9, 1e-2, 1e-4, 1e-6, -0.5})
      for (const double shift : {-100., -10., 0., 10., 100.})
        {
          Tensor<2, dim> gradient;
          gradient[0][0] = squeeze - 1.;
          Tensor<1, dim> motion;
          motion[0]        = shift;
          const auto field = affine_field(motion, gradient, problem.points.h);
          const TermOnOneCell<dim> on_cell(bounded, GrowthAt::current);
          EXPECT_FALSE(
            on_cell.inverted(field, LocalSystem<dim>::energy_and_residual));
          EXPECT_GE(on_cell.energy(field),
                    (1. + 1e-12) * problem.lower_bound());
          if (squeeze > 0.)
            least_symmetric = std::min(
              least_symmetric,
              TermOnOneCell<dim>(symmetric, GrowthAt::current).energy(field));
        }
    EXPECT_LT(least_symmetric, 1e3 * problem.lower_bound());
  }

  /** The curvature is at least that of the penalty: no direction leads down for
   *  ever. */
  template <int dim>
  void
  check_convexity()
  {
    std::mt19937       generator(3);
    const Problem<dim> problem(generator);
    const auto         term  = problem.term();
    const auto         field = random_field<dim>(generator, 1.);
    const auto         way   = random_field<dim>(generator, 1.);
    const auto K = TermOnOneCell<dim>(term, GrowthAt::current).tangent(field);
    constexpr unsigned int n = BSpline<dim>::n, N = LocalSystem<dim>::n_dofs;
    double                 curvature = 0., least = 0.;
    for (unsigned int i = 0; i < N; ++i)
      for (unsigned int j = 0; j < N; ++j)
        curvature += way.coefficient[i / n][i % n] * K[i * N + j] *
                     way.coefficient[j / n][j % n];
    for (unsigned int p = 0; p < 4; ++p)
      {
        const auto &held = problem.held_points[p];
        least +=
          held.area * held.penalty *
          (held.projection *
           way.value(SplineValues<dim>(problem.points.xi[p], problem.points.h)))
            .norm_square();
      }
    EXPECT_GT(least, 0.);
    EXPECT_GE(curvature, (1. - 1e-12) * least);
  }
} // namespace


TEST(BoundedNitsche,
     DerivativesAreExact){MORULA_BOTH_DIMENSIONS(check_derivatives)}


TEST(BoundedNitsche,
     EnergyHasALowerBound){MORULA_BOTH_DIMENSIONS(check_lower_bound)}


TEST(BoundedNitsche, IsConvex)
{
  MORULA_BOTH_DIMENSIONS(check_convexity)
}
