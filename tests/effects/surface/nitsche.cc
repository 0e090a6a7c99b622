// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/surface/nitsche.h>

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "common/finite_differences.h"
#include "common/materials.h"
#include "common/own_law.h"

using namespace Morula;

namespace
{
  /** Fixed and slip points on one grid cell. */
  template <int dim>
  struct Problem
  {
    GroupedPoints<dim>                            points;
    std::vector<typename Nitsche<dim>::HeldPoint> held_points;
    std::vector<ElasticState<dim>>                current, previous;

    explicit Problem(std::mt19937 &generator)
      : points(random_points_in_cell<dim>(generator, 4))
      , current(random_states<dim>(generator, 4))
      , previous(random_states<dim>(generator, 4))
    {
      for (unsigned int p = 0; p < 4; ++p)
        {
          // W / V_t is about 1.
          current[p].W /= 1000.;
          previous[p].W /= 1000.;
          typename Nitsche<dim>::HeldPoint held;
          held.normal = random_tensor<1, dim>(generator);
          held.normal /= held.normal.norm();
          Tensor<1, dim> N = random_tensor<1, dim>(generator);
          N /= N.norm();
          held.projection =
            p % 2 == 0 ? unit_tensor<dim>() : outer_product(N, N);
          held.position_scale = 100.;
          held.area           = 30. + p;
          held.penalty        = 2. + p;
          held.lame           = lame(1., 0.3);
          held_points.push_back(held);
        }
    }

    /** With gap @p scale M d_p at the displacement @p field. */
    Nitsche<dim>
    term(const LocalField<dim> &field,
         const double           scale,
         const NitscheForm      form     = NitscheForm::symmetric,
         const Material        &material = neo_hookean(),
         const PartOfLaw        part     = PartOfLaw::all)
    {
      std::mt19937 generator(99);
      for (unsigned int p = 0; p < 4; ++p)
        {
          const Tensor<1, dim> d = random_tensor<1, dim>(generator);
          held_points[p].gap =
            held_points[p].projection *
            (scale * d -
             field.value(SplineValues<dim>(points.xi[p], points.h)));
        }
      return {form, material, part, points, held_points, current, previous};
    }
  };

  template <int dim>
  void
  check_derivatives()
  {
    std::mt19937 generator(1);
    Problem<dim> problem(generator);
    const auto   field = random_field<dim>(generator, 0.15);
    for (const std::string &name : all_materials().names())
      for (const PartOfLaw part : {PartOfLaw::all, PartOfLaw::distortion})
        for (const double gap : {0., 3.})
          {
            SCOPED_TRACE(name);
            const Material &material = material_of_test(name);
            const auto      symmetric =
              problem.term(field, gap, NitscheForm::symmetric, material, part);
            EXPECT_TRUE(symmetric.is_conservative());
            expect_derivatives(symmetric, field);

            const auto unsymmetric = problem.term(
              field, gap, NitscheForm::unsymmetric, material, part);
            EXPECT_FALSE(unsymmetric.is_conservative());
            expect_derivatives(unsymmetric, field);
          }
  }

  /** Without gap, the traction's part of the unsymmetric tangent is skew: the
   *  symmetric part is the penalty's alone, for any traction. */
  template <int dim>
  void
  check_unsymmetric_form()
  {
    constexpr unsigned int N = LocalSystem<dim>::n_dofs;
    std::mt19937           generator(3);
    Problem<dim>           problem(generator);
    const auto             field = random_field<dim>(generator, 0.1);
    const auto             sum_with_transposed = [&](const double stiffness) {
      for (auto &held : problem.held_points)
        held.lame = lame(stiffness, 0.3);
      const auto term = problem.term(field, 0., NitscheForm::unsymmetric);
      const auto tangent =
        TermOnOneCell<dim>(term, GrowthAt::current).tangent(field);
      auto sum = tangent;
      for (unsigned int i = 0; i < N; ++i)
        for (unsigned int j = 0; j < N; ++j)
          sum[i * N + j] += tangent[j * N + i];
      return sum;
    };
    expect_near(sum_with_transposed(1.), sum_with_transposed(1e-9), 1e-9);
  }

  /** A point of a body under the homogeneous stress that its own traction
   *  balances: the forces are those on the surface, T a. */
  template <int dim>
  void
  check_consistency()
  {
    std::mt19937 generator(4);
    Problem<dim> problem(generator);
    const auto   field = affine_field(Tensor<1, dim>(),
                                    0.1 * random_tensor<2, dim>(generator),
                                    problem.points.h);
    for (auto &held : problem.held_points)
      held.projection = unit_tensor<dim>();
    const auto term = problem.term(field, 0.);
    const auto residual =
      TermOnOneCell<dim>(term, GrowthAt::current).residual(field);
    const auto f = field.step_deformation(
      SplineValues<dim>(problem.points.xi[0], problem.points.h));
    Tensor<1, dim> expected, total;
    for (unsigned int p = 0; p < 4; ++p)
      {
        const auto &held = problem.held_points[p];
        const auto  state =
          neo_hookean_point(f * problem.current[p].A, held.lame);
        expected -= held.area * problem.current[p].W *
                    (Tensor<2, dim>(state.kirchhoff_stress()) *
                     (held.normal * invert(f)));
      }
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
        total[i] += residual[i * BSpline<dim>::n + a];
    EXPECT_LE((total - expected).norm(), 1e-12 * expected.norm());
  }

  template <int dim>
  void
  check_rounding()
  {
    std::mt19937 generator(5);
    Problem<dim> problem(generator);
    const auto   field  = random_field<dim>(generator, 0.1);
    const auto   term   = problem.term(field, 1e-3);
    const auto   system = TermOnOneCell<dim>(term, GrowthAt::current)
                          .added(field, LocalSystem<dim>::rounding);
    double least = 0., sum = 0.;
    for (const auto &held : problem.held_points)
      least += dim * held.area * held.penalty * held.position_scale;
    for (const double magnitude : system.magnitude)
      sum += magnitude;
    EXPECT_GE(sum, least);
  }

  template <int dim>
  void
  check_inversion()
  {
    std::mt19937   generator(6);
    Problem<dim>   problem(generator);
    Tensor<2, dim> mirror;
    mirror[1][1]     = -2.5;
    const auto field = affine_field(Tensor<1, dim>(), mirror, problem.points.h);
    const auto term  = problem.term(field, 0.);
    for (const auto wanted :
         {LocalSystem<dim>::energy_and_residual, LocalSystem<dim>::tangent})
      EXPECT_TRUE(
        TermOnOneCell<dim>(term, GrowthAt::current).inverted(field, wanted));
  }
} // namespace


TEST(Nitsche, DerivativesAreExact){MORULA_BOTH_DIMENSIONS(check_derivatives)}


TEST(Nitsche, UnsymmetricFormHasTheSymmetricPartOfThePenaltyAlone){
  MORULA_BOTH_DIMENSIONS(check_unsymmetric_form)}


TEST(Nitsche,
     IsConsistentWithTheTraction){MORULA_BOTH_DIMENSIONS(check_consistency)}


TEST(Nitsche,
     RoundingCountsThePositions){MORULA_BOTH_DIMENSIONS(check_rounding)}


TEST(Nitsche, NoticesInversion)
{
  MORULA_BOTH_DIMENSIONS(check_inversion)
}
