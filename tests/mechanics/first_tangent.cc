// ranks: 1 2
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/internal_force.h>
#include <morula/mechanics/momentum_balance.h>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "common/body_on_grid.h"
#include "common/linear_problem.h"
#include "common/materials.h"

using namespace Morula;

namespace
{
  /** A smooth displacement of some µm. */
  template <int dim>
  Tensor<1, dim>
  wave(const Point<dim> &x, const double phase)
  {
    Tensor<1, dim> value;
    for (unsigned int i = 0; i < dim; ++i)
      value[i] = 3. * std::sin(x[(i + 1) % dim] / (90. + 20. * i) + phase + i);
    return value;
  }

  /** Tangents of projected tissue: later ones know the linearisation at the
   *  last one, the first one of a step, at the growth at t, is exact. */
  template <int dim>
  void
  check_first_tangent()
  {
    constexpr double      spacing = 18.;
    const BodyOnGrid<dim> body(ball_points(Point<dim>(), 90., spacing),
                               std::pow(spacing, dim));
    const auto            groups = body.group(body.particles);
    MaterialPoints<dim>   points;
    static_cast<GroupedPoints<dim> &>(points) =
      body.grouped(body.particles, groups);
    points.material = &neo_hookean();
    points.lame     = {lame(1., 0.45)};
    for (const unsigned int i : groups.points)
      {
        const Tensor<1, dim> w = wave(body.particles[i], 0.2);
        Tensor<2, dim>       A = unit_tensor<dim>();
        for (unsigned int d = 0; d < dim; ++d)
          A[d] += 0.03 * w;
        points.current.push_back({A, std::pow(spacing, dim)});
      }
    typename MomentumBalance<dim>::TermList terms;
    terms.push_back(
      std::make_unique<InternalForce<dim>>(points,
                                           VolumetricStrain::projected));
    QuietTimer           timer;
    MomentumBalance<dim> balance(*body.space, terms, timer, MPI_COMM_WORLD);

    const auto field = [&](const double phase) {
      return body.interpolate(
        [&](const Point<dim> &x) { return wave(x, phase); });
    };
    const auto u = field(0.4), w = field(1.9);
    const auto product = [&](const GrowthAt growth) {
      Equilibrium::Vector Kw(w);
      balance.tangent(u, growth).vmult(Kw, w);
      return Kw;
    };
    const auto difference = [](const Equilibrium::Vector &a,
                               const Equilibrium::Vector &b) {
      Equilibrium::Vector result(a);
      result -= b;
      return result.l2_norm() / a.l2_norm();
    };
    const auto exact = product(GrowthAt::previous);
    balance.tangent(w, GrowthAt::current);
    EXPECT_GT(difference(exact, product(GrowthAt::current)), 1e-6);
    balance.tangent(w, GrowthAt::current);
    EXPECT_EQ(difference(exact, product(GrowthAt::previous)), 0.);
  }
} // namespace


TEST(FirstTangent, StartsAnew)
{
  MORULA_BOTH_DIMENSIONS(check_first_tangent)
}
