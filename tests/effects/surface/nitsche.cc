// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  /** Fixed and slip points on one grid cell. */
  template <int dim>
  struct Problem
  {
    GroupedPoints<dim>                            points;
    std::vector<typename Nitsche<dim>::HeldPoint> held_points;
    std::vector<ElasticState<dim>>                current, previous;
    std::vector<Tensor<1, dim>> tractions; // of the bounded form

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
          held.gap = held.projection * random_tensor<1, dim>(generator);
          held_points.push_back(held);
          tractions.push_back(held.projection *
                              random_tensor<1, dim>(generator));
        }
    }

    std::unique_ptr<Term<dim>>
    bounded() const
    {
      return bounded_nitsche<dim>(points, held_points, tractions);
    }

    /** The least that the energy of bounded() can be: -Σ a_t |T|²/(2β). */
    double
    lower_bound() const
    {
      double sum = 0.;
      for (unsigned int p = 0; p < 4; ++p)
        sum -= held_points[p].area * tractions[p].norm_square() /
               (2. * held_points[p].penalty);
      return sum;
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
} // namespace


TEST_2D_3D(Nitsche, DerivativesAreExact)
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

          const auto unsymmetric =
            problem.term(field, gap, NitscheForm::unsymmetric, material, part);
          EXPECT_FALSE(unsymmetric.is_conservative());
          expect_derivatives(unsymmetric, field);
        }
}


/** Without gap, the traction's part of the unsymmetric tangent is skew: the
 *  symmetric part is the penalty's alone, for any traction. */
TEST_2D_3D(Nitsche, UnsymmetricFormHasTheSymmetricPartOfThePenaltyAlone)
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
TEST_2D_3D(Nitsche, IsConsistentWithTheTraction)
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
      const auto state = neo_hookean_point(f * problem.current[p].A, held.lame);
      expected -=
        held.area * problem.current[p].W *
        (Tensor<2, dim>(state.kirchhoff_stress()) * (held.normal * invert(f)));
    }
  for (unsigned int i = 0; i < dim; ++i)
    for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
      total[i] += residual[i * BSpline<dim>::n + a];
  EXPECT_LE((total - expected).norm(), 1e-12 * expected.norm());
}


TEST_2D_3D(Nitsche, RoundingCountsThePositions)
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


TEST_2D_3D(Nitsche, NoticesInversion)
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


/** Where a point is squeezed to nothing, or inside out, there is an energy,
 *  and not less than the bound; that of the symmetric form falls below. */
TEST_2D_3D(BoundedNitsche, EnergyHasALowerBound)
{
  std::mt19937       generator(2);
  const Problem<dim> problem(generator);
  const auto         bounded = problem.bounded();
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
        const TermOnOneCell<dim> on_cell(*bounded, GrowthAt::current);
        EXPECT_FALSE(
          on_cell.inverted(field, LocalSystem<dim>::energy_and_residual));
        EXPECT_GE(on_cell.energy(field), (1. + 1e-12) * problem.lower_bound());
        if (squeeze > 0.)
          least_symmetric = std::min(
            least_symmetric,
            TermOnOneCell<dim>(symmetric, GrowthAt::current).energy(field));
      }
  EXPECT_LT(least_symmetric, 1e3 * problem.lower_bound());
}


/** Small gaps, gaps at which the penalty rises, and far ones where its force
 *  is linear. */
TEST_2D_3D(BoundedNitsche, DerivativesAreExact)
{
  std::mt19937       generator(7);
  const Problem<dim> problem(generator);
  const auto         term = problem.bounded();
  for (const double motion : {0., 0.01, 1., 30.})
    expect_derivatives(*term, random_field<dim>(generator, motion));
}


/** The curvature is at least that of the penalty: no direction leads down for
 *  ever. */
TEST_2D_3D(BoundedNitsche, IsConvex)
{
  std::mt19937       generator(3);
  const Problem<dim> problem(generator);
  const auto         whole = problem.bounded();
  const Term<dim>   &term  = *whole;
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
