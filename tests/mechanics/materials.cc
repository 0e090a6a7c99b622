// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "mechanics/room.h"

template <int dim>
Tensor<2, dim>
random_deformation(std::mt19937 &generator)
{
  return unit_tensor<dim>() + 0.3 * random_tensor<2, dim>(generator);
}

/** Calls @p check with each material. */
template <typename Check>
void
for_each_material(const Check &check)
{
  for (const std::string &name : all_materials().names())
    {
      SCOPED_TRACE(name);
      check(material_of_test(name));
    }
}

template <int dim>
void
check_stress(const Material &material)
{
  const double eps = 1e-5;
  std::mt19937 generator(1);
  for (unsigned int trial = 0; trial < 50; ++trial)
    {
      const Lame           constants = lame(2.5, 0.05 * (trial % 10));
      const Tensor<2, dim> F         = random_deformation<dim>(generator);
      const auto           energy    = [&](const Tensor<2, dim> &F) {
        return ElasticPoint<dim>(F, constants, material).energy();
      };
      // First Piola-Kirchhoff stress dΨ/dF = τ F⁻ᵀ.
      const Tensor<2, dim> P =
        Tensor<2, dim>(
          ElasticPoint<dim>(F, constants, material).kirchhoff_stress()) *
        transpose(invert(F));
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          {
            Tensor<2, dim> before = F, after = F;
            before[i][j] -= eps;
            after[i][j] += eps;
            EXPECT_NEAR((energy(after) - energy(before)) / (2. * eps),
                        P[i][j],
                        1e-7 * (1. + P.norm()));
          }
    }
}

/** The derivative of n·τn by a stretch along n is what (4.6) says. */
template <int dim>
void
check_stiffness(const Material &material)
{
  const double eps = 1e-5;
  std::mt19937 generator(3);
  for (unsigned int trial = 0; trial < 20; ++trial)
    {
      const Lame           constants = lame(2.5, 0.3);
      const Tensor<2, dim> F         = random_deformation<dim>(generator);
      Tensor<1, dim>       n         = random_tensor<1, dim>(generator);
      n /= n.norm();
      // Of the nominal traction n·τ f⁻ᵀ n at f = I + ε n⊗n.
      const auto traction = [&](const double stretch) {
        const Tensor<2, dim> f =
          unit_tensor<dim>() + stretch * outer_product(n, n);
        const ElasticPoint<dim> at(f * F, constants, material);
        return n * (Tensor<2, dim>(at.kirchhoff_stress()) * (n * invert(f)));
      };
      const double expected = (traction(eps) - traction(-eps)) / (2. * eps);
      EXPECT_NEAR(ElasticPoint<dim>(F, constants, material).stiffness(n),
                  expected,
                  1e-7 * std::abs(expected));
    }
}

template <int dim>
void
check_rest(const Material &material)
{
  const Lame constants = lame(3., 0.4);
  for (const double angle : {0., 0.7, 3.})
    {
      const ElasticPoint<dim> turned(rotation<dim>(angle), constants, material);
      EXPECT_NEAR(turned.energy(), 0., 2e-15);
      EXPECT_NEAR(turned.kirchhoff_stress().norm(), 0., 1e-14);
      EXPECT_NEAR(turned.strain().J, 1., 1e-15);
      EXPECT_GT(turned.energy_magnitude(), 1.);
    }
}

/** At rest every law is that of Hooke. */
template <int dim>
void
check_hooke(const Material &material)
{
  const Lame              constants = lame(3., 0.4);
  const ElasticPoint<dim> at_rest(unit_tensor<dim>(), constants, material);
  const auto             &r = at_rest.response();
  EXPECT_NEAR(r.total_A() + 2. * r.B + r.C, constants.lambda, 1e-14);
  EXPECT_NEAR(r.alpha, constants.mu, 1e-15);
  EXPECT_NEAR(r.alpha - r.total_gamma(), constants.mu, 1e-15);
  Tensor<1, dim> n;
  n[dim - 1] = 1.;
  EXPECT_NEAR(at_rest.stiffness(n),
              constants.lambda + 2. * constants.mu,
              1e-14);
  const auto U = material.volumetric(0.);
  EXPECT_EQ(U.energy, 0.);
  EXPECT_EQ(U.slope, 0.);
  EXPECT_EQ(U.curvature, 1.);
}

/** What a law sees at tr b_e - 3 and ln J_e. */
Strain<double>
strain_at(const double trace, const double log_J)
{
  const Lame constants = lame(2., 0.35);
  return {trace,
          trace + 6.,
          std::exp(log_J),
          log_J,
          log_J,
          constants.lambda,
          constants.mu};
}


TEST_2D_3D(Materials, StressIsTheEnergysDerivativeAndRestIsHookes)
{
  for_each_material(check_stress<dim>);
  for_each_material(check_stiffness<dim>);
  for_each_material(check_rest<dim>);
  for_each_material(check_hooke<dim>);
}


// Of all coefficients, up to the third derivatives, which Nitsche's term takes.
TEST(Materials, CoefficientsAreDerivativesOfTheEnergy)
{
  const double eps = 1e-5;
  for_each_material([&](const Material &material) {
    for (const double trace : {-0.3, 0.2, 1.5})
      for (const double log_J : {-0.4, 0.1, 0.3})
        {
          using Value           = double (*)(const CoupledResponse<double> &);
          const auto difference = [&](const Value  value,
                                      const double by_trace,
                                      const double by_log_J) {
            const auto at = [&](const double step) {
              return value(material.response(
                strain_at(trace + step * by_trace, log_J + step * by_log_J)));
            };
            return (at(eps) - at(-eps)) / (2. * eps);
          };
          const auto near = [](const double found, const double expected) {
            EXPECT_NEAR(found, expected, 1e-8 * (1. + std::abs(expected)));
          };
          const auto  strain = strain_at(trace, log_J);
          const auto  r      = material.response(strain);
          const Value energy = [](const CoupledResponse<double> &r) {
            return r.energy + r.volumetric.modulus * r.volumetric.energy;
          };
          const Value slope = [](const CoupledResponse<double> &r) {
            return r.total_gamma() - r.alpha; // ∂Ψ/∂ϑ
          };
          const Value alpha = [](const auto &r) { return r.alpha; };
          const Value A     = [](const auto &r) { return r.total_A(); };
          const Value A_d   = [](const auto &r) { return r.A; };
          const Value B     = [](const auto &r) { return r.B; };
          const Value C     = [](const auto &r) { return r.C; };
          near(r.alpha, 2. * difference(energy, 1., 0.));
          near(slope(r), difference(energy, 0., 1.));
          near(r.total_A(), difference(slope, 0., 1.));
          near(r.B, difference(alpha, 0., 1.));
          near(r.B, 2. * difference(slope, 1., 0.));
          near(r.C, 2. * difference(alpha, 1., 0.));

          const auto all = material.third_derivatives(strain, PartOfLaw::all);
          near(all.D1, difference(A, 0., 1.));
          near(all.D2, difference(B, 0., 1.));
          near(all.D3, difference(C, 0., 1.));
          near(all.D4, 2. * difference(C, 1., 0.));
          near(material.third_derivatives(strain, PartOfLaw::distortion).D1,
               difference(A_d, 0., 1.));
          EXPECT_EQ(material.coupled(), r.B != 0. || r.C != 0.);
        }
  });
}


TEST(Materials, PlaneStrainIsThreeDimensionalWithoutStretchInZ)
{
  for_each_material([](const Material &material) {
    std::mt19937 generator(2);
    for (unsigned int trial = 0; trial < 20; ++trial)
      {
        const Tensor<2, 2> F = random_deformation<2>(generator);
        Tensor<2, 3>       F_3d;
        F_3d[2][2] = 1.;
        for (unsigned int i = 0; i < 2; ++i)
          for (unsigned int j = 0; j < 2; ++j)
            F_3d[i][j] = F[i][j];
        const Lame            constants = lame(1.7, 0.3);
        const ElasticPoint<2> plane(F, constants, material);
        const ElasticPoint<3> solid(F_3d, constants, material);
        EXPECT_NEAR(plane.energy(), solid.energy(), 1e-14);
        EXPECT_NEAR(plane.strain().J, solid.strain().J, 1e-14);
        for (unsigned int i = 0; i < 2; ++i)
          for (unsigned int j = 0; j < 2; ++j)
            EXPECT_NEAR(plane.kirchhoff_stress()[i][j],
                        solid.kirchhoff_stress()[i][j],
                        1e-14);
        EXPECT_NEAR(plane.kirchhoff_stress_zz(),
                    solid.kirchhoff_stress_zz(),
                    1e-14);
        EXPECT_NEAR(plane.response().total_A(),
                    solid.response().total_A(),
                    1e-14);
      }
  });
}


TEST(Materials, LameConstants)
{
  const Lame rubber = lame(1., 0.4);
  EXPECT_NEAR(rubber.lambda, 10. / 7., 1e-15);
  EXPECT_NEAR(rubber.mu, 5. / 14., 1e-15);
  EXPECT_EQ(lame(2., 0.).lambda, 0.);
  EXPECT_EQ(lame(2., 0.).mu, 1.);
  // The bulk modulus diverges for incompressible material.
  EXPECT_NEAR(lame(3., 0.4999).lambda, 3. * 0.4999 / (1.4999 * 0.0002), 1e-6);
}


// Growth θ in a rigid box, per grown volume.
TEST(Materials, PressureInARigidBox)
{
  const std::pair<double, double> pressures[] = {{1.1, 626.18}, {1.4, 4436.91}};
  for (const auto &[theta, pascal] : pressures)
    {
      const auto grown =
        neo_hookean_point<3>(unit_tensor<3>() / theta, lame(1., 0.4));
      EXPECT_NEAR(-1e3 * trace(grown.kirchhoff_stress()) / 3. * theta * theta *
                    theta,
                  pascal,
                  0.005);
    }
}


// Its closed forms: a change of volume has a pressure κ/2 (J² - 1) and no more,
// a simple shear the stress μ γ and no pressure, at any shear.
TEST(Materials, IsochoricNeoHookeanPartsVolumeFromShear)
{
  const Material &material  = material_of_test("isochoric neo-Hookean");
  const Lame      constants = lame(1., 0.4);
  const double    kappa     = 1. / (3. * (1. - 2. * 0.4)); // E / 3(1 - 2ν)
  for (const double s : {0.7, 1.3})
    {
      const ElasticPoint<3> swollen(s * unit_tensor<3>(), constants, material);
      const double          J = s * s * s;
      const auto            expected =
        0.5 * kappa * (J * J - 1.) * unit_symmetric_tensor<3>();
      EXPECT_NEAR((swollen.kirchhoff_stress() - expected).norm(), 0., 1e-14);
      EXPECT_NEAR(swollen.energy(),
                  0.5 * kappa * (0.5 * J * J - 0.5 - std::log(J)),
                  1e-15);
    }
  Tensor<2, 3> F = unit_tensor<3>();
  F[0][1]        = 0.8;
  const ElasticPoint<3> sheared(F, constants, material);
  const auto            tau = sheared.kirchhoff_stress();
  EXPECT_NEAR(tau[0][1], constants.mu * 0.8, 1e-15);
  EXPECT_NEAR(trace(tau), 0., 1e-15);
  EXPECT_NEAR(sheared.energy(), 0.5 * constants.mu * 0.64, 1e-15);
}


TEST(Materials, AreListedByName)
{
  const Materials own;
  EXPECT_EQ(own.names(),
            (std::vector<std::string>{"neo-Hookean", "isochoric neo-Hookean"}));
  EXPECT_EQ(own.find("stiffening"), nullptr);
  Materials materials = all_materials();
  EXPECT_NE(materials.find("stiffening"), nullptr);
  EXPECT_THROW(materials.add("neo-Hookean", own_material(StiffeningLaw())),
               std::invalid_argument);
}
