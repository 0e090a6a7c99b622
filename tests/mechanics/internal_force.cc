// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/internal_force.h>
#include <morula/mechanics/neo_hookean.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "../finite_differences.h"

using namespace Morula;

namespace
{
  template <int dim>
  MaterialPoints<dim>
  random_material_points(std::mt19937      &generator,
                         const unsigned int n,
                         const bool         growing,
                         const bool         uniform)
  {
    MaterialPoints<dim> points;
    static_cast<GroupedPoints<dim> &>(points) =
      random_points_in_cell<dim>(generator, n);
    for (unsigned int p = 0; p < (uniform ? 1 : n); ++p)
      points.lame.push_back(lame(1. + p, 0.3 + 0.1 * (p % 2)));
    points.current = random_states<dim>(generator, n);
    if (growing)
      points.previous = random_states<dim>(generator, n);
    return points;
  }

  template <int dim>
  void
  check_derivatives()
  {
    std::mt19937 generator(1);
    for (const bool growing : {true, false})
      for (const bool uniform : {true, false})
        {
          const auto points =
            random_material_points<dim>(generator, 4, growing, uniform);
          const InternalForce<dim> term(points);
          EXPECT_TRUE(term.is_conservative());
          expect_derivatives(term, random_field<dim>(generator, 0.15));
        }
  }

  /** Energy and stress of a homogeneous deformation. */
  template <int dim>
  void
  check_energy()
  {
    std::mt19937 generator(2);
    auto         points = random_material_points<dim>(generator, 3, true, true);
    const InternalForce<dim> term(points);
    const Tensor<2, dim>     A = 0.2 * random_tensor<2, dim>(generator);
    const auto               field =
      affine_field(random_tensor<1, dim>(generator), A, points.h);
    for (const GrowthAt growth : {GrowthAt::previous, GrowthAt::current})
      {
        double expected = 0.;
        for (const auto &state : points.states(growth))
          expected +=
            state.W *
            NeoHookean<dim>((unit_tensor<dim>() + A) * state.A, points.lame[0])
              .energy();
        EXPECT_NEAR(TermOnOneCell<dim>(term, growth).energy(field),
                    expected,
                    1e-12 * expected);
      }
  }

  /** |contributions| bound the residual, and it does not change with them. */
  template <int dim>
  void
  check_magnitudes()
  {
    std::mt19937 generator(3);
    const auto points = random_material_points<dim>(generator, 5, false, true);
    const InternalForce<dim> term(points);
    const auto               field = random_field<dim>(generator, 0.1);
    const auto system              = TermOnOneCell<dim>(term, GrowthAt::current)
                          .added(field, LocalSystem<dim>::rounding);
    expect_near({system.residual.begin(), system.residual.end()},
                TermOnOneCell<dim>(term, GrowthAt::current).residual(field),
                0.);
    for (unsigned int dof = 0; dof < system.residual.size(); ++dof)
      EXPECT_GE(system.magnitude[dof],
                std::abs(system.residual[dof]) * (1. - 1e-12));
    EXPECT_GE(system.energy_magnitude, system.energy);
  }

  template <int dim>
  void
  check_inversion()
  {
    std::mt19937 generator(4);
    auto points = random_material_points<dim>(generator, 2, false, true);
    const InternalForce<dim> term(points);
    const TermOnOneCell<dim> at(term, GrowthAt::current);
    Tensor<2, dim>           mirror;
    const auto field    = affine_field(Tensor<1, dim>(), mirror, points.h);
    mirror[0][0]        = -2.5; // f_xx = -1.5
    const auto inverted = affine_field(Tensor<1, dim>(), mirror, points.h);
    for (const auto wanted : {LocalSystem<dim>::energy_and_residual,
                              LocalSystem<dim>::rounding,
                              LocalSystem<dim>::tangent})
      {
        EXPECT_FALSE(at.inverted(field, wanted));
        EXPECT_TRUE(at.inverted(inverted, wanted));
      }
    // The step is well, the elastic part is not; and both mirrored.
    points.current[1].A[0] *= -1.;
    EXPECT_TRUE(at.inverted(field, LocalSystem<dim>::energy_and_residual));
    points.current[0].A[0] *= -1.;
    EXPECT_TRUE(at.inverted(inverted, LocalSystem<dim>::energy_and_residual));
  }
} // namespace


TEST(InternalForce, ResidualAndTangentAreDerivatives){
  MORULA_BOTH_DIMENSIONS(check_derivatives)}


TEST(InternalForce,
     EnergyOfAHomogeneousDeformation){MORULA_BOTH_DIMENSIONS(check_energy)}


TEST(InternalForce,
     MagnitudesBoundTheSums){MORULA_BOTH_DIMENSIONS(check_magnitudes)}


TEST(InternalForce, NoticesInversion)
{
  MORULA_BOTH_DIMENSIONS(check_inversion)
}
