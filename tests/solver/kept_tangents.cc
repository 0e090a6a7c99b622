// ranks: 1 2
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/internal_force.h>
#include <morula/mechanics/momentum_balance.h>
#include <morula/solver/newton.h>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "common/body_on_grid.h"
#include "common/linear_problem.h"
#include "common/materials.h"

using namespace Morula;

namespace
{
  /** Counts the tangents of a problem. */
  class Counted : public Equilibrium
  {
  public:
    explicit Counted(Equilibrium &problem)
      : problem(problem)
    {}

    Evaluation
    residual(const Vector &u, Vector &R) const override
    {
      return problem.residual(u, R);
    }

    double
    residual_magnitude(const Vector &u) const override
    {
      return problem.residual_magnitude(u);
    }

    const Matrix &
    tangent(const Vector &u, const GrowthAt growth) override
    {
      ++n_tangents;
      return problem.tangent(u, growth);
    }

    unsigned int n_tangents = 0;

  private:
    Equilibrium &problem;
  };

  /** A free ball that grows by up to 4 % in a step, here more than there:
   *  the displacements with kept tangents are those without. */
  template <int dim>
  void
  check_growth(const VolumetricStrain form, const std::string &linear_solver)
  {
    SCOPED_TRACE(linear_solver +
                 (form == VolumetricStrain::projected ? ", projected" : ""));
    constexpr double      spacing = 15.;
    const BodyOnGrid<dim> body(ball_points(Point<dim>(), 90., spacing),
                               std::pow(spacing, dim));
    const auto            groups = body.group(body.particles);
    const double          W      = std::pow(spacing, dim);
    MaterialPoints<dim>   points;
    static_cast<GroupedPoints<dim> &>(points) =
      body.grouped(body.particles, groups);
    points.material = &neo_hookean();
    points.lame     = {lame(1., 0.4)};
    for (const unsigned int i : groups.points)
      {
        const double growth = 1.1 + 0.1 * std::sin(body.particles[i][0] / 40.);
        points.previous.push_back({unit_tensor<dim>(), W});
        points.current.push_back(
          {1. / growth * unit_tensor<dim>(), W * std::pow(growth, dim)});
      }
    std::vector<typename RigidModes<dim>::Mass> masses;
    for (const unsigned int i : groups.points)
      masses.push_back({0, body.particles[i], 1.});
    typename MomentumBalance<dim>::TermList terms;
    terms.push_back(std::make_unique<InternalForce<dim>>(points, form));
    QuietTimer           timer;
    MomentumBalance<dim> balance(*body.space, terms, timer, MPI_COMM_WORLD);
    LinearProblem        linear = balance.linear_problem(
      1.,
      RigidModes<dim>(*body.space, masses, {}, MPI_COMM_WORLD).null_space(),
      points.xi.size());

    const auto solved = [&](const bool costly, unsigned int &n_tangents) {
      linear.costly = costly;
      SolverParameters parameters;
      parameters.linear_solver    = linear_solver;
      parameters.newton_tolerance = 1e-10;
      Counted             counted(balance);
      NewtonReport        report;
      Equilibrium::Vector u = balance.rest();
      Morula::solve(
        counted, linear, balance.scales(1.), parameters, timer, u, report);
      n_tangents = counted.n_tangents;
      EXPECT_EQ(n_tangents == report.newton_iterations, !costly);
      return u;
    };
    unsigned int n_all, n_kept;
    const auto   all = solved(false, n_all);
    auto         u   = solved(true, n_kept);
    EXPECT_LT(n_kept, n_all);
    u -= all;
    EXPECT_GT(all.linfty_norm(), 1.);
    EXPECT_LE(u.linfty_norm(), 1e-8 * all.linfty_norm());
  }

  template <int dim>
  void
  check_all()
  {
    for (const auto form :
         {VolumetricStrain::pointwise, VolumetricStrain::projected})
      for (const std::string linear_solver : {"automatic", "direct"})
        check_growth<dim>(form, linear_solver);
  }
} // namespace


TEST(KeptTangents, FindTheSameEquilibriumWithFewerTangents)
{
  MORULA_BOTH_DIMENSIONS(check_all)
}
