// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "mechanics/room.h"

constexpr double h = 50.;

template <int dim>
using Map = std::function<Point<dim>(const Point<dim> &)>;

/** A turn by @p angle about (1, 2, 2)/3 through (30, -10, 0), in 2-D about
 *  that point, and a shift of 20 h. */
template <int dim>
Map<dim>
rigid_motion(const double angle)
{
  Tensor<2, dim> W; // of the axis
  if (dim == 2)
    {
      W[0][1] = -1.;
      W[1][0] = 1.;
    }
  else
    {
      const double axis[3] = {1. / 3., 2. / 3., 2. / 3.};
      for (unsigned int i = 0; i < dim; ++i)
        {
          const unsigned int j = (i + 1) % dim, k = (i + 2) % dim;
          W[i][j] = -axis[k % 3];
          W[j][i] = axis[k % 3];
        }
    }
  const Tensor<2, dim> Q =
    unit_tensor<dim>() + std::sin(angle) * W + (1. - std::cos(angle)) * W * W;
  Point<dim>     pole;
  Tensor<1, dim> shift;
  pole[0]  = 30.;
  pole[1]  = -10.;
  shift[0] = 20. * h;
  shift[1] = -3. * h;
  return [=](const Point<dim> &x) { return pole + Q * (x - pole) + shift; };
}

/** A ball, held at its surface where its points are, and a free ball beside
 *  it. */
template <int dim>
struct Problem
{
  std::vector<Point<dim>> held;
  BodyOnGrid<dim>         body;

  static std::vector<Point<dim>>
  balls()
  {
    Point<dim> other;
    other[0]                       = 350.;
    std::vector<Point<dim>> points = ball_points(Point<dim>(), 100., 15.);
    const auto              more   = ball_points(other, 60., 15.);
    points.insert(points.end(), more.begin(), more.end());
    return points;
  }

  explicit Problem(const std::vector<Point<dim>> &held)
    : held(held)
    , body(balls(), std::pow(15., dim), GridParameters(), held)
  {}

  /** Where the held points, of which the directions @p M are held, go. */
  std::optional<Equilibrium::Vector>
  start(const Map<dim>                                          &to,
        const std::function<Tensor<2, dim>(const Point<dim> &)> &M) const
  {
    std::vector<typename RigidModes<dim>::Mass> masses;
    for (const unsigned int i : body.group(body.particles).points)
      masses.push_back(
        {body.piece(body.particles[i]), body.particles[i], 100.});
    std::vector<typename RigidModes<dim>::Support> supports;
    std::vector<HeldPoint<dim>>                    points;
    for (const unsigned int i : body.group(held).points)
      {
        const Point<dim> x = held[i];
        // Areas are not alike.
        supports.push_back({body.piece(x), x, M(x), 10. + i});
        points.push_back({x, x, to(x), M(x), 10. + i});
      }
    const RigidModes<dim> modes(*body.space, masses, supports, MPI_COMM_WORLD);
    return rigid_start(*body.space, modes, points, MPI_COMM_WORLD);
  }

  std::optional<Equilibrium::Vector>
  start(const Map<dim> &to) const
  {
    return start(to, [](const auto &) { return unit_tensor<dim>(); });
  }

  /** The held ball goes along, the free one rests. */
  void
  expect_motion(const std::optional<Equilibrium::Vector> &u,
                const Map<dim>                           &to) const
  {
    ASSERT_TRUE(u.has_value());
    body.at_points(body.particles,
                   *u,
                   [&](const unsigned int i, const auto &field, const auto &s) {
                     const Point<dim>     x = body.particles[i];
                     const Tensor<1, dim> expected =
                       x[0] < 200. ? to(x) - x : Tensor<1, dim>();
                     EXPECT_LE((field.value(s) - expected).norm(), 1e-9);
                   });
  }
};

/** Points all around, on the lower half, and the fewest that hold the ball:
 *  two, and in 3-D three. */
template <int dim>
std::vector<std::vector<Point<dim>>>
clamps()
{
  std::vector<Point<dim>> around, half, few;
  for (unsigned int i = 0; i < 40; ++i)
    {
      Tensor<1, dim> e;
      e[0] = std::cos(2.4 * i);
      e[1] = std::sin(2.4 * i);
      if (dim == 3)
        {
          const double z = (i + 0.5) / 20. - 1.;
          e *= std::sqrt(1. - z * z);
          e[dim - 1] = z;
        }
      const Point<dim> x(95. * e);
      around.push_back(x);
      if (x[1] < 0.)
        half.push_back(x);
      if (few.size() < dim)
        few.push_back(x);
    }
  return {around, half, few};
}


TEST_2D_3D(HeldMotion, TissueGoesAlongRigidly)
{
  for (const auto &held : clamps<dim>())
    {
      const Problem<dim> problem(held);
      for (const double angle : {0., 1e-3, 0.5, -2., 3.})
        {
          SCOPED_TRACE(std::to_string(held.size()) + " points turned by " +
                       std::to_string(angle));
          const Map<dim> to = rigid_motion<dim>(angle);
          problem.expect_motion(problem.start(to), to);
        }
    }
}


TEST_2D_3D(HeldMotion, ElseItStartsAtRest)
{
  const Problem<dim> problem(clamps<dim>()[0]);
  EXPECT_FALSE(problem.start([](const auto &x) { return x; }));
  // Stretched, sheared, half of it moved: nothing is gained by going along.
  EXPECT_FALSE(
    problem.start([](const auto &x) { return Point<dim>(1.3 * x); }));
  EXPECT_FALSE(problem.start([](const Point<dim> &x) {
    Point<dim> y = x;
    y[0] += 0.1 * x[1];
    return y;
  }));
  EXPECT_FALSE(problem.start([](const Point<dim> &x) {
    Point<dim> y = x;
    y[0] += x[1] > 0. ? 3. * h : 0.;
    return y;
  }));
  // ... but where a large motion comes with a small change of shape.
  EXPECT_TRUE(problem.start([](const Point<dim> &x) {
    return rigid_motion<dim>(0.5)(Point<dim>(1.01 * x));
  }));
  // Held at one point the ball may still turn.
  const Problem<dim> hinge({clamps<dim>()[0][0]});
  EXPECT_FALSE(hinge.start(rigid_motion<dim>(0.5)));
}


// Slip points hold against motion along their normal only.
TEST_2D_3D(HeldMotion, SlipPointsHoldAlongTheirNormal)
{
  const Problem<dim> problem(clamps<dim>()[0]);
  const auto         M = [](const Point<dim> &x) -> Tensor<2, dim> {
    Tensor<2, dim> result;
    if (x[1] > 0.)
      return unit_tensor<dim>();
    result[1][1] = 1.;
    return result;
  };
  const auto moved = [](const unsigned int direction) {
    return [=](const Point<dim> &x) {
      Point<dim> y = x;
      if (x[1] > 0.)
        y[direction] += 20. * h;
      return y;
    };
  };
  problem.expect_motion(problem.start(moved(0), M), [](const auto &x) {
    Point<dim> y = x;
    y[0] += 20. * h;
    return y;
  });
  EXPECT_FALSE(problem.start(moved(1), M));
}
