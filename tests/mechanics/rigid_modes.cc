// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "mechanics/room.h"

constexpr double h = 50.;

template <int dim>
using Support = typename RigidModes<dim>::Support;

template <int dim>
constexpr unsigned int n_rigid = dim == 2 ? 3 : 6;

/** Particles of different masses, and what is held of them. */
template <int dim>
struct Problem
{
  BodyOnGrid<dim>                             body;
  PointGroups                                 groups;
  std::vector<typename RigidModes<dim>::Mass> masses;

  explicit Problem(const std::vector<Point<dim>> &particles,
                   const std::vector<Point<dim>> &boundary = {})
    : body(particles, std::pow(15., dim), GridParameters(), boundary)
    , groups(body.group(particles))
  {
    for (const unsigned int i : groups.points)
      masses.push_back(
        {body.piece(particles[i]), particles[i], 100. + 50. * (i % 3)});
  }

  /** Supports at those boundary points that stand on this rank. */
  template <typename Projection>
  RigidModes<dim>
  modes(const Projection &projection) const
  {
    std::vector<Support<dim>> supports;
    for (const unsigned int i : body.group(body.boundary).points)
      supports.push_back({body.piece(body.boundary[i]),
                          body.boundary[i],
                          projection(body.boundary[i]),
                          20.});
    return {*body.space, masses, supports, MPI_COMM_WORLD};
  }

  RigidModes<dim>
  free_modes() const
  {
    return {*body.space, masses, {}, MPI_COMM_WORLD};
  }

  std::vector<Tensor<1, dim>>
  displacements(const Equilibrium::Vector &u) const
  {
    std::vector<Tensor<1, dim>> list;
    body.at_points(body.particles,
                   u,
                   [&](const unsigned int, const auto &field, const auto &s) {
                     list.push_back(field.value(s));
                   });
    return list;
  }

  /** Σ V⁰ u and Σ V⁰ (x_i u_j - x_j u_i) of a piece about its centre, over
   *  the sum of their magnitudes. */
  std::vector<double>
  moments(const std::vector<Tensor<1, dim>> &u, const unsigned int piece) const
  {
    std::vector<double> center(dim + 1, 0.);
    for (const auto &mass : masses)
      if (mass.piece == piece)
        {
          for (unsigned int d = 0; d < dim; ++d)
            center[d] += mass.V0 * mass.x[d];
          center[dim] += mass.V0;
        }
    Utilities::MPI::sum(center, MPI_COMM_WORLD, center);
    std::vector<double> sums(n_rigid<dim> + 2, 0.);
    for (std::size_t k = 0; k < masses.size(); ++k)
      if (masses[k].piece == piece)
        {
          Tensor<1, dim> z;
          for (unsigned int d = 0; d < dim; ++d)
            z[d] = masses[k].x[d] - center[d] / center[dim];
          unsigned int row = 0;
          for (unsigned int d = 0; d < dim; ++d)
            sums[row++] += masses[k].V0 * u[k][d];
          for (unsigned int i = 0; i < dim; ++i)
            for (unsigned int j = i + 1; j < dim; ++j)
              sums[row++] += masses[k].V0 * (z[i] * u[k][j] - z[j] * u[k][i]);
          sums[row++] += masses[k].V0 * u[k].norm();
          sums[row++] += masses[k].V0 * u[k].norm() * z.norm();
        }
    Utilities::MPI::sum(sums, MPI_COMM_WORLD, sums);
    for (unsigned int row = 0; row < n_rigid<dim>; ++row)
      sums[row] /= row < dim ? sums[n_rigid<dim>] : sums[n_rigid<dim> + 1];
    sums.resize(n_rigid<dim>);
    return sums;
  }
};

template <int dim>
void
expect_orthonormal(const std::vector<Equilibrium::Vector> &basis)
{
  for (std::size_t i = 0; i < basis.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j)
      EXPECT_NEAR(basis[i] * basis[j], i == j ? 1. : 0., 1e-12);
}

/** A box of particles with points on its lower sides. */
template <int dim>
Problem<dim>
block(const unsigned int n_sides)
{
  const auto inside = [](const Point<dim> &x) {
    for (unsigned int d = 0; d < dim; ++d)
      if (x[d] < 0. || x[d] > 120.)
        return false;
    return true;
  };
  Point<dim> corner;
  const auto particles = lattice_points<dim>(corner, 135., 15., inside);
  std::vector<Point<dim>> boundary;
  for (unsigned int d = 0; d < n_sides; ++d)
    for (Point<dim> x : particles)
      if (x[d] < 10.)
        {
          x[d] = 0.;
          boundary.push_back(x);
        }
  return Problem<dim>(particles, boundary);
}

/** Onto the normal of the side that the point is on. */
template <int dim>
Tensor<2, dim>
slip(const Point<dim> &x)
{
  Tensor<2, dim> M;
  for (unsigned int d = 0; d < dim; ++d)
    if (x[d] == 0.)
      M[d][d] = 1.;
  return M;
}

template <int dim>
Tensor<2, dim>
turn(const double angle)
{
  Tensor<2, dim> Q = rotation<dim>(angle);
  if (dim == 3)
    {
      Tensor<2, dim> tilt = unit_tensor<dim>();
      tilt[1][1] = tilt[dim - 1][dim - 1] = std::cos(0.5 * angle);
      tilt[1][dim - 1] = -(tilt[dim - 1][1] = std::sin(0.5 * angle));
      Q                = tilt * Q;
    }
  return Q;
}

/** A deformation with a rigid motion after it. */
template <int dim>
Equilibrium::Vector
deformed(const Problem<dim> &problem, const double angle)
{
  const auto Q = turn<dim>(angle);
  return problem.body.interpolate([&](const Point<dim> &x) {
    Point<dim> y = x;
    for (unsigned int d = 0; d < dim; ++d)
      y[d] += 0.1 * x[d] + 3. * std::sin(x[(d + 1) % dim] / 60.);
    Tensor<1, dim> shift;
    shift[0] = 40. * angle;
    return Q * (y - Point<dim>()) + shift - (x - Point<dim>());
  });
}

/** What an increment must not contain: the increment without it. */
template <int dim>
void
remove(const Problem<dim>    &problem,
       const RigidModes<dim> &modes,
       Equilibrium::Vector   &u)
{
  for (const auto &force : modes.inertia(problem.masses))
    u.add(-(u * force), force);
}

/** A row of cells, less than 1e-4 um off its line: the rotation about the
 *  line has no inertia, but steps must not be free to contain it. */
void
check_row()
{
  std::vector<Point<3>> particles;
  for (int i = 0; i < 14; ++i)
    particles.push_back({15. * i, 1e-6 * i * (i - 13), 1e-6 * i * (i - 7)});
  const Problem<3> problem(particles);
  const auto       modes = problem.free_modes();
  ASSERT_EQ(modes.inertia(problem.masses).size(), 6u);
  Tensor<2, 3> about_the_line;
  about_the_line[1][2] = -(about_the_line[2][1] = 0.01);
  auto u = problem.body.vector_of(problem.body.affine({}, about_the_line));
  const double before = u.l2_norm();
  remove(problem, modes, u);
  EXPECT_LT(u.l2_norm(), 0.9 * before);
}


TEST_2D_3D(RigidModes, AreCountedByWhatIsHeld)
{
  const auto body = block<dim>(dim);
  const auto free = body.free_modes();
  EXPECT_TRUE(free.any());
  EXPECT_EQ(free.null_space().size(), n_rigid<dim>);
  expect_orthonormal<dim>(free.null_space());

  // On one slip plane, in a corner of slip planes, and held.
  const auto on_plane   = block<dim>(1);
  const auto plane_free = on_plane.modes(slip<dim>);
  EXPECT_EQ(plane_free.null_space().size(), dim == 2 ? 1u : 3u);
  expect_orthonormal<dim>(plane_free.null_space());
  EXPECT_EQ(block<dim>(2).modes(slip<dim>).null_space().size(),
            dim == 2 ? 0u : 1u);
  EXPECT_FALSE(body.modes(slip<dim>).any());
  EXPECT_TRUE(body.modes(slip<dim>).null_space().empty());
  EXPECT_FALSE(
    on_plane.modes([](const auto &) { return unit_tensor<dim>(); }).any());
}


// Hinged at one point.
TEST_2D_3D(RigidModes, AHingeLeavesTheRotations)
{
  const auto particles = ball_points(Point<dim>(), 90., 15.);
  Point<dim> top;
  top[0] = 90.;
  const Problem<dim> ball(particles, {top});
  EXPECT_EQ(ball.modes([](const auto &) { return unit_tensor<dim>(); })
              .null_space()
              .size(),
            n_rigid<dim> - dim);
}


// Increments that forces of inertia do no work on have no moments, and forces
// of inertia are what V⁰ times a rigid motion amounts to.
TEST_2D_3D(RigidModes, InertiaLeavesNoMoments)
{
  const auto body    = block<dim>(1);
  const auto inertia = body.free_modes().inertia(body.masses);
  ASSERT_EQ(inertia.size(), n_rigid<dim>);
  expect_orthonormal<dim>(inertia);
  Equilibrium::Vector u = deformed(body, 0.4);
  remove(body, body.free_modes(), u);
  for (const double moment : body.moments(body.displacements(u), 0))
    EXPECT_NEAR(moment, 0., 1e-12);

  // On a plane only the motions along it are left, also of the forces.
  const auto modes = body.modes(slip<dim>);
  EXPECT_EQ(modes.inertia(body.masses).size(), modes.null_space().size());
}


TEST_2D_3D(RigidModes, EveryPieceHasItsOwn)
{
  auto       particles = ball_points(Point<dim>(), 90., 15.);
  Point<dim> far;
  far[0]           = 500.;
  const auto other = ball_points(far, 80., 15.);
  particles.insert(particles.end(), other.begin(), other.end());
  const Problem<dim> problem(particles);
  ASSERT_EQ(problem.body.space->n_pieces(), 2u);
  const auto modes = problem.free_modes();
  EXPECT_EQ(modes.null_space().size(), 2 * n_rigid<dim>);
  expect_orthonormal<dim>(modes.null_space());
  auto u = problem.body.interpolate([&](const Point<dim> &x) {
    const Tensor<1, dim> z = x - (x[0] < 250. ? Point<dim>() : far);
    return 1.1 * (turn<dim>(x[0] < 250. ? 0.4 : -0.9) * z) - z;
  });
  remove(problem, modes, u);
  for (unsigned int piece = 0; piece < 2; ++piece)
    for (const double moment : problem.moments(problem.displacements(u), piece))
      EXPECT_NEAR(moment, 0., 1e-12);
}


// Particles that no rotation moves: one, and two on a line.
TEST_2D_3D(RigidModes, SingleCellsKeepTheirPlace)
{
  for (const unsigned int n : {1u, 2u})
    {
      std::vector<Point<dim>> particles(n);
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int d = 0; d < dim; ++d)
          particles[i][d] = 12. + 9. * i;
      const Problem<dim> problem(particles);
      const auto         modes = problem.free_modes();
      Tensor<1, dim>     a;
      a[0]   = 3.;
      auto u = problem.body.vector_of(
        problem.body.affine(a, 1.2 * turn<dim>(0.3) - unit_tensor<dim>()));
      remove(problem, modes, u);
      EXPECT_TRUE(std::isfinite(u.l2_norm()));
      const auto     after = problem.displacements(u);
      Tensor<1, dim> sum;
      for (std::size_t k = 0; k < after.size(); ++k)
        sum += problem.masses[k].V0 * after[k];
      for (unsigned int d = 0; d < dim; ++d)
        EXPECT_NEAR(sum_over_ranks(sum[d]), 0., 1e-9);
    }
}


TEST(RigidModes, ARowDoesNotTurnAboutItsLine)
{
  check_row();
}
