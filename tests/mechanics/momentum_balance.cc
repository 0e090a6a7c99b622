// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "mechanics/room.h"

constexpr double h = 50.;

template <int dim>
Equilibrium::Vector
direction(const Ball<dim> &ball, const double phase)
{
  return ball.body.interpolate(
    [&](const Point<dim> &x) { return waves<dim>(x, phase); });
}

/** Numbers that do not depend on the numbering of the unknowns. */
template <int dim>
std::vector<double>
invariants(Ball<dim> &ball)
{
  auto               &balance = *ball.balance;
  Equilibrium::Vector R;
  const auto          evaluation = balance.residual(ball.u, R);
  std::vector<double> values     = {evaluation.energy,
                                    evaluation.energy_magnitude,
                                    R.l2_norm(),
                                    balance.residual_magnitude(ball.u)};
  for (const GrowthAt growth : {GrowthAt::previous, GrowthAt::current})
    {
      const auto &K = balance.tangent(ball.u, growth);
      values.push_back(frobenius_norm(K));
      for (unsigned int k = 0; k < 3; ++k)
        {
          const auto v = direction(ball, 0.1 + k), w = direction(ball, 2. * k);
          values.push_back(R * v);
          Equilibrium::Vector Kv(v);
          K.vmult(Kv, v);
          values.push_back(Kv * w);
          for (const auto &part : balance.rank_ones())
            values.push_back(part.b * v);
        }
    }
  return values;
}


TEST_2D_3D(MomentumBalance, ResidualAndTangentAreDerivatives)
{
  const double eps = 1e-4;
  for (const std::string with : {"", "pressure", "lumen"})
    {
      SCOPED_TRACE("with " + with);
      const bool pressure = with == "pressure";
      Ball<dim>  ball(MPI_COMM_WORLD, pressure, with == "lumen");
      auto      &balance = *ball.balance;
      EXPECT_EQ(balance.linear_problem(1., {}, 0).symmetric, !pressure);
      Equilibrium::Vector R, after, before;
      ASSERT_TRUE(std::isfinite(balance.residual(ball.u, R).energy));
      const auto &K = balance.tangent(ball.u, GrowthAt::current);
      // Smooth directions, and one that jumps from spline to spline.
      for (const double phase : {0.1, 2.5, 1e4})
        {
          auto v = direction(ball, phase);
          if (phase > 100.)
            for (const auto i : v.locally_owned_elements())
              v(i) = std::sin(1e4 * (v(i) + 0.1));
          Equilibrium::Vector upper(ball.u), lower(ball.u), Kv(R);
          upper.add(eps, v);
          lower.add(-eps, v);
          const double rate = (balance.residual(upper, after).energy -
                               balance.residual(lower, before).energy) /
                              (2. * eps);
          if (!pressure)
            {
              EXPECT_NEAR(rate, R * v, 1e-6 * R.l2_norm() * v.l2_norm());
            }
          K.vmult(Kv, v);
          add_rank_ones(Kv, balance.rank_ones(), v);
          after.sadd(0.5 / eps, -0.5 / eps, before);
          after -= Kv;
          EXPECT_LE(after.l2_norm(), 1e-6 * Kv.l2_norm());
        }
      // K is symmetric unless a pressure follows.
      const auto          v = direction(ball, 0.1), w = direction(ball, 2.5);
      Equilibrium::Vector Kv(v), Kw(v);
      K.vmult(Kv, v);
      K.vmult(Kw, w);
      const double size = Kv.l2_norm() * w.l2_norm();
      if (pressure)
        {
          EXPECT_GT(std::abs(Kv * w - Kw * v), 1e-8 * size);
        }
      else
        {
          EXPECT_NEAR(Kv * w, Kw * v, 1e-12 * size);
        }
    }
}


// The tangent at the old growth is that of a residual that has it.
TEST_2D_3D(MomentumBalance, TangentAtTheOldGrowth)
{
  Ball<dim>           ball(MPI_COMM_WORLD, false);
  auto               &balance = *ball.balance;
  const auto          v       = direction(ball, 0.1);
  Equilibrium::Vector old(v), current(v);
  balance.tangent(ball.u, GrowthAt::previous).vmult(old, v);
  balance.tangent(ball.u, GrowthAt::current).vmult(current, v);
  Equilibrium::Vector difference(old);
  difference -= current;
  EXPECT_GT(difference.l2_norm(), 1e-3 * current.l2_norm());
  // Made again, not added up.
  balance.tangent(ball.u, GrowthAt::previous).vmult(current, v);
  current -= old;
  EXPECT_LE(current.l2_norm(), 1e-14 * old.l2_norm());
}


// Tangents of pooled tissue know the linearisation at the last one; the
// first one of a step, at the growth at t, is exact.
TEST_2D_3D(MomentumBalance, TheFirstTangentStartsAnew)
{
  Ball<dim>  ball(MPI_COMM_WORLD, false, false, VolumetricStrain::pooled);
  auto      &balance = *ball.balance;
  const auto v = direction(ball, 0.1), elsewhere = direction(ball, 1.9);
  const auto product = [&](const GrowthAt             growth,
                           const Equilibrium::Vector &last) {
    balance.tangent(last, GrowthAt::current);
    Equilibrium::Vector Kv(v);
    balance.tangent(ball.u, growth).vmult(Kv, v);
    return Kv;
  };
  const auto difference = [&](const GrowthAt growth) {
    const auto exact = product(growth, ball.u);
    auto       found = product(growth, elsewhere);
    found -= exact;
    return found.l2_norm() / exact.l2_norm();
  };
  EXPECT_EQ(difference(GrowthAt::previous), 0.);
  EXPECT_GT(difference(GrowthAt::current), 1e-6);
}


TEST_2D_3D(MomentumBalance, IsTheSameForAnyNumberOfRanks)
{
  Ball<dim> shared(MPI_COMM_WORLD, true, true),
    alone(MPI_COMM_SELF, true, true);
  const auto found = invariants(shared), expected = invariants(alone);
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(found[i],
                expected[i],
                1e-10 * (std::abs(expected[i]) + std::abs(expected[0])))
      << "number " << i;
}


TEST_2D_3D(MomentumBalance, InversionIsInfiniteEnergyOnAllRanks)
{
  Ball<dim>           ball(MPI_COMM_WORLD, false);
  Equilibrium::Vector R;
  // Inside out along x on one side only.
  const auto u = ball.body.interpolate([](const Point<dim> &x) {
    Tensor<1, dim> value;
    value[0] = x[0] > 60. ? -3. * (x[0] - 60.) : 0.;
    return value;
  });
  EXPECT_EQ(ball.balance->residual(u, R).energy,
            std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isfinite(ball.balance->residual(ball.u, R).energy));
  const double magnitude = ball.balance->residual_magnitude(ball.u);
  EXPECT_GE(magnitude, R.l2_norm());
  EXPECT_LT(magnitude, 1e4 * R.l2_norm());
  Equilibrium::Vector same(R);
  double              again = 0.;
  EXPECT_DOUBLE_EQ(
    ball.balance->residual_and_magnitude(ball.u, same, again).energy,
    ball.balance->residual(ball.u, R).energy);
  EXPECT_DOUBLE_EQ(again, magnitude);
  same -= R;
  EXPECT_LE(same.linfty_norm(), 1e-14 * R.linfty_norm());
  // Where there is no energy there is no magnitude.
  ball.balance->residual_and_magnitude(u, same, again);
  EXPECT_EQ(again, 0.);
}


// The extremes are those of the state asked for, whatever was asked before.
TEST_2D_3D(MomentumBalance, ExtremesAreThoseOfTheState)
{
  Ball<dim>           ball(MPI_COMM_WORLD, false);
  Equilibrium::Vector R, unused;
  const auto          found = ball.balance->residual(ball.u, R);
  Equilibrium::Vector moved(ball.u);
  moved *= 1.5;
  const auto other = ball.balance->residual(moved, unused);
  const auto again = ball.balance->residual(ball.u, unused);
  EXPECT_EQ(found.smallest_J.value, again.smallest_J.value);
  EXPECT_EQ(found.largest_gap.value, again.largest_gap.value);

  double smallest = std::numeric_limits<double>::infinity();
  ball.body.at_points(
    ball.body.particles,
    ball.u,
    [&](const unsigned int i, const auto &field, const auto &splines) {
      const Tensor<2, dim> F_e = field.step_deformation(splines) *
                                 state_at(ball.body.particles[i], 0.3, 1.).A;
      smallest = std::min(smallest, determinant(F_e));
    });
  const double smallest_J = ball.balance->smallest_J(found).value;
  // Also boundary points count.
  EXPECT_LE(smallest_J, Utilities::MPI::min(smallest, MPI_COMM_WORLD) + 1e-12);
  EXPECT_GT(smallest_J, 0.);
  EXPECT_NEAR(ball.balance->largest_gap(found).value, 0., 1e-12);
  EXPECT_GT(ball.balance->largest_gap(other).value, 0.1);
  EXPECT_NE(ball.balance->describe(moved).find("The smallest J_e is"),
            std::string::npos);
}


TEST_2D_3D(MomentumBalance, LocalFieldsFollowTheWeights)
{
  Ball<dim>                    ball(MPI_COMM_WORLD, false);
  const auto                   fields = ball.body.fields(ball.u);
  const DisplacementField<dim> displacement(*ball.body.space,
                                            ball.u,
                                            MPI_COMM_WORLD);
  for (unsigned int c = 0; c < fields.size(); ++c)
    {
      const auto field = displacement.on_grid_cell(c);
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
          EXPECT_NEAR(field.coefficient[i][a],
                      fields[c].coefficient[i][a],
                      1e-11);
    }
}


// A free body at rest: rigid motions cost nothing.
TEST_2D_3D(MomentumBalance, RigidMotionsCostNothing)
{
  const BodyOnGrid<dim> body(ball_points(Point<dim>(), 90., 18.),
                             std::pow(18., dim));
  const auto            groups = body.group(body.particles);
  MaterialPoints<dim>   points;
  static_cast<GroupedPoints<dim> &>(points) =
    body.grouped(body.particles, groups);
  points.material = &neo_hookean();
  points.lame     = {lame(1., 0.4)};
  points.current =
    std::vector<ElasticState<dim>>(groups.points.size(),
                                   {unit_tensor<dim>(), std::pow(18., dim)});
  typename MomentumBalance<dim>::TermList terms;
  terms.push_back(std::make_unique<InternalForce<dim>>(points));
  std::vector<typename RigidModes<dim>::Mass> masses;
  for (const unsigned int i : groups.points)
    masses.push_back({0, body.particles[i], 1.});
  QuietTimer           timer;
  MomentumBalance<dim> balance(*body.space, terms, timer, MPI_COMM_WORLD);
  const LinearProblem  linear = balance.linear_problem(
    1.,
    RigidModes<dim>(*body.space, masses, {}, MPI_COMM_WORLD).null_space(),
    points.xi.size());
  Equilibrium::Vector R;
  const auto         &K = balance.tangent(balance.rest(), GrowthAt::current);
  ASSERT_EQ(linear.null_space.size(), dim == 2 ? 3u : 6u);
  for (const auto &mode : linear.null_space)
    {
      Equilibrium::Vector Km(mode);
      K.vmult(Km, mode);
      EXPECT_LE(Km.l2_norm(), 1e-12 * frobenius_norm(K));
    }

  // Large rotations.
  const auto     Q = rotation<dim>(2.);
  Tensor<1, dim> a;
  a[0]              = 500.;
  const auto turned = body.vector_of(body.affine(a, Q - unit_tensor<dim>()));
  EXPECT_LE(balance.residual(turned, R).energy,
            1e-13 * body.particles.size() * points.current[0].W);
  EXPECT_LE(R.l2_norm(), 1e-9 * frobenius_norm(K));
  EXPECT_NEAR(balance.scales(1.).small_force,
              1e-6 * std::pow(h, dim - 1),
              1e-15);
  EXPECT_EQ(balance.scales(1.).length, h);
  EXPECT_NEAR(linear.typical_entry, std::pow(h, dim - 2), 1e-15);

  // Those of many points, on all ranks together.
  const unsigned int least    = (dim == 2 ? 20 : 2) * body.space->n_unknowns();
  const bool         on_first = this_rank() == 0;
  for (const unsigned int n : {least - 1, least})
    EXPECT_EQ(balance.linear_problem(1., {}, on_first ? n : 0).costly,
              n == least);
}
