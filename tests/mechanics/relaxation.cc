// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "mechanics/room.h"

const Lame constants = lame(1., 0.4);

/** F_e after relaxation. */
template <int dim>
Tensor<2, dim>
relax(const Tensor<2, dim> &F_e,
      const FlowLaw        &flow,
      const double          dt,
      const std::string    &law = "neo-Hookean")
{
  return F_e *
         invert(Tensor<2, dim>(
           flow_of_step<dim>(F_e, constants, material_of_test(law), flow, dt)));
}

template <int dim>
SymmetricTensor<2, dim>
left_strain(const Tensor<2, dim> &F_e)
{
  return symmetrize(F_e * transpose(F_e));
}

template <int dim>
Tensor<2, dim>
some_strain(std::mt19937 &generator)
{
  return unit_tensor<dim>() + 0.3 * random_tensor<2, dim>(generator);
}

/** A rotation. */
template <int dim>
Tensor<2, dim>
some_rotation(std::mt19937 &generator)
{
  const Tensor<2, dim> F     = some_strain<dim>(generator);
  const auto           pairs = eigenvectors(left_strain(F));
  Tensor<2, dim>       R;
  for (unsigned int i = 0; i < dim; ++i)
    for (unsigned int j = 0; j < dim; ++j)
      R[i][j] = pairs[i].second[j];
  return determinant(R) > 0. ? R : -1. * R;
}

template <int dim>
double
stress_of(const Tensor<2, dim> &F_e, const std::string &law = "neo-Hookean")
{
  return von_mises_stress(F_e, constants, material_of_test(law));
}


// The limits are those of scipy's solve_ivp for db/dt = -(b - tr b / 3) b.
TEST(Relaxation, OfAHeldStretchInOneStep)
{
  const Tensor<2, 3> F_e =
    diagonal<3>({1.5, 1. / std::sqrt(1.5), 1. / std::sqrt(1.5)});
  const auto b = [&](const FlowLaw &flow, const unsigned int n_steps = 1) {
    Tensor<2, 3> F = F_e;
    for (unsigned int n = 0; n < n_steps; ++n)
      F = relax(F, flow, 0.7 / n_steps);
    return left_strain(F);
  };
  // Exact, in steps of any length.
  EXPECT_NEAR(b({0.7})[0][0], 1.29161856, 2e-5);
  EXPECT_NEAR(b({0.7})[1][1], 0.87989907, 2e-5);
  EXPECT_NEAR(b({0.7}, 16)[0][0], 1.29161856, 1e-8);
  // Backward Euler, b / (1 + b / N) scaled to det b = 1, where something
  // yields: of order one.
  const double nothing = 1e-300;
  EXPECT_NEAR(b({0.7, nothing, 1})[0][0], 1.44153805, 1e-8);
  EXPECT_NEAR(b({0.7, nothing, 1})[1][1], 0.83288865, 1e-8);
  EXPECT_NEAR(b({0.7, nothing, 4})[0][0], 1.33598027, 1e-8);
  EXPECT_NEAR(b({0.7, nothing, 16})[1][1], 0.87595856, 1e-8);
  EXPECT_NEAR(b({0.7, nothing, 2048})[0][0], 1.29161856, 1e-4);
}


TEST(Relaxation, PassesAreShorterSteps)
{
  std::mt19937       generator(1);
  const Tensor<2, 3> F_e = some_strain<3>(generator);
  Tensor<2, 3>       one_by_one(F_e);
  for (unsigned int i = 0; i < 5; ++i)
    one_by_one = relax(one_by_one, {0.3, 0.01}, 0.02);
  EXPECT_LE((relax(F_e, {0.3, 0.01, 5}, 0.1) - one_by_one).norm(), 1e-13);
  // Where nothing yields a step is exact by itself.
  EXPECT_EQ((relax(F_e, {0.3, 0., 5}, 0.1) - relax(F_e, {0.3}, 0.1)).norm(),
            0.);
}


// Small strains: a step sees (1 - w) of the strain at its beginning and w of
// that at its end, and loses 1 - e^-gamma of it. Steady creep under a load
// keeps the elastic strain, held shear loses it exactly.
TEST(Relaxation, WeightOfTheEndMakesSteadyCreepExact)
{
  for (const double gamma : {1e-9, 0.9e-3, 1.1e-3, 0.1, 1., 2., 50.})
    {
      const double w = weight_of_end(gamma), lost = -std::expm1(-gamma);
      EXPECT_GE(w, 0.5);
      EXPECT_LT(w, 1.);
      // The strain before the flow is 1 at the beginning, 1 + gamma at the end.
      EXPECT_NEAR(lost * ((1. - w) + w * (1. + gamma)) / gamma, 1., 1e-7);
    }
  EXPECT_NEAR(weight_of_end(1.), 0.5819767068693265, 1e-14);
}


TEST(Relaxation, OfTheStrainInThePlane)
{
  // solve_ivp of db/dt = -(b - tr b / 2) b from (2.25, 1 / 2.25).
  const Tensor<2, 2> F_e = diagonal<2>({1.5, 1. / 1.5});
  Tensor<2, 2>       F   = F_e;
  for (unsigned int n = 0; n < 4096; ++n)
    F = relax(F, {1.}, 1. / 4096);
  const auto b = left_strain(F);
  EXPECT_NEAR(b[0][0], 1.32962327, 1e-4);
  EXPECT_NEAR(b[1][1], 0.75209273, 1e-4);
}


TEST(Relaxation, OfSmallStrainsIsExponential)
{
  const auto check = [](const auto &F_e) {
    constexpr int dim    = std::decay_t<decltype(F_e)>::dimension;
    const auto    before = deviator(left_strain<dim>(F_e));
    // In a single step.
    const auto after = deviator(left_strain<dim>(relax<dim>(F_e, {0.4}, 0.6)));
    EXPECT_LE((after - std::exp(-1.5) * before).norm(), 1e-3 * before.norm());
  };
  std::mt19937 generator(2);
  check(unit_tensor<2>() + 1e-4 * random_tensor<2, 2>(generator));
  check(unit_tensor<3>() + 1e-4 * random_tensor<2, 3>(generator));
}


TEST_2D_3D(Relaxation, KeepsVolumeDirectionsAndFrames)
{
  std::mt19937 generator(3);
  for (unsigned int trial = 0; trial < 50; ++trial)
    for (const double yield_stress : {0., 0.05})
      {
        const Tensor<2, dim> F_e = some_strain<dim>(generator);
        const Tensor<2, dim> Q   = some_rotation<dim>(generator);
        const Tensor<2, dim> R   = some_rotation<dim>(generator);
        const FlowLaw        flow{0.3, yield_stress};
        const auto           D = [&](const Tensor<2, dim> &F_e) {
          return flow_of_step<dim>(F_e, constants, neo_hookean(), flow, 0.1);
        };
        EXPECT_NEAR(determinant(D(F_e)), 1., 1e-14);
        // Nothing changes where somebody looks at it from another side, and
        // the tensor turns with the configuration that it belongs to.
        EXPECT_LE((D(Q * F_e) - D(F_e)).norm(), 1e-13);
        const Tensor<2, dim> turned(D(F_e * R));
        EXPECT_LE((R * turned * transpose(R) - Tensor<2, dim>(D(F_e))).norm(),
                  1e-13);
        // b_e keeps its directions, and J_e.
        const auto after = relax(F_e, flow, 0.1);
        EXPECT_NEAR(determinant(after), determinant(F_e), 1e-14);
        const Tensor<2, dim> b(left_strain(F_e)), new_b(left_strain(after));
        EXPECT_LE((b * new_b - new_b * b).norm(), 1e-13);
        EXPECT_LE(stress_of(after), stress_of(F_e));
      }
}


TEST(Relaxation, AddsAMultipleOfTheIdentityToTheInverse)
{
  // The inverse of b̄ grows by a multiple of it, but for its scale: by dt / τ_r
  // with backward Euler, as where there is a yield stress.
  std::mt19937       generator(4);
  const Tensor<2, 3> F_e   = some_strain<3>(generator);
  const Tensor<2, 3> after = relax(F_e, {0.3, 1e-300}, 0.12);
  const double       J     = determinant(F_e);
  const Tensor<2, 3> old_b =
    Tensor<2, 3>(left_strain(F_e)) / std::pow(J, 2. / 3.);
  const Tensor<2, 3> new_b =
    Tensor<2, 3>(left_strain(after)) / std::pow(J, 2. / 3.);
  const Tensor<2, 3> inverse = invert(old_b) + 0.4 * unit_tensor<3>();
  EXPECT_LE((invert(inverse) * std::cbrt(determinant(inverse)) - new_b).norm(),
            1e-13);
}


TEST(Relaxation, IsSmoothWhereStretchesAreEqual)
{
  const FlowLaw flow{0.3};
  std::mt19937  generator(5);
  for (const double stretch : {1., 1.3})
    {
      const Tensor<2, 3> F_e = diagonal<3>({1.1, stretch, stretch});
      const auto         D   = [&](const Tensor<2, 3> &F_e) {
        return flow_of_step<3>(F_e, constants, neo_hookean(), flow, 0.1);
      };
      const Tensor<2, 3> change = random_tensor<2, 3>(generator);
      for (const double size : {1e-16, 1e-12, 1e-8, 1e-4})
        EXPECT_LE((D(F_e + size * change) - D(F_e)).norm(), size + 1e-14);
      // The change is linear in the strain.
      const double size = 1e-5;
      EXPECT_LE(
        (D(F_e + size * change) + D(F_e - size * change) - 2. * D(F_e)).norm(),
        10. * size * size);
    }
  EXPECT_LE((flow_of_step<3>(
               1.4 * unit_tensor<3>(), constants, neo_hookean(), flow, 0.1) -
             unit_symmetric_tensor<3>())
              .norm(),
            1e-15);
}


TEST(Relaxation, OfAnyStepIsStable)
{
  std::mt19937                generator(6);
  const Tensor<2, 3>          F_e    = some_strain<3>(generator);
  const double                size   = std::cbrt(determinant(F_e));
  constexpr double            tiny   = std::numeric_limits<double>::min();
  const SymmetricTensor<2, 3> sphere = size * size * unit_symmetric_tensor<3>();
  for (const double tau : {1e-6, 1e-30, tiny})
    {
      const auto b = left_strain(relax(F_e, {tau}, 1.));
      EXPECT_LE((b - sphere).norm(), 10. * tau + 1e-14);
    }
  // As much as is squeezed in a failing run.
  const Tensor<2, 3> squeezed = diagonal<3>({3., 0.1, 0.01});
  double             last     = stress_of(squeezed);
  for (const double tau : {1e6, 10., 1., 0.1, 0.04})
    {
      const auto after = relax(squeezed, {tau}, 1.);
      EXPECT_LT(stress_of(after), last);
      EXPECT_NEAR(determinant(after), 3e-3, 1e-16);
      last = stress_of(after);
    }
}


TEST_2D_3D(Relaxation, StopsAtTheYieldStress)
{
  std::mt19937 generator(7);
  for (unsigned int trial = 0; trial < 20; ++trial)
    for (const std::string law :
         {"neo-Hookean", "isochoric neo-Hookean", "stiffening"})
      {
        SCOPED_TRACE(law);
        const Tensor<2, dim> F_e    = some_strain<dim>(generator);
        const double         stress = stress_of(F_e, law);
        // Nothing flows below it.
        EXPECT_EQ(relax(F_e, {1e-3, 1.001 * stress}, 1., law), F_e);
        // The stress decays to it above: in a long step at once, never
        // farther.
        const double yield = 0.4 * stress;
        EXPECT_NEAR(stress_of(relax(F_e, {1e-12, yield}, 1., law), law),
                    yield,
                    1e-10 * yield);
        EXPECT_NEAR(stress_of(relax(F_e, {0.01, yield, 1}, 1., law), law),
                    yield,
                    0.05 * yield);
        double         last    = stress;
        Tensor<2, dim> current = F_e;
        for (unsigned int i = 0; i < 5; ++i)
          {
            current          = relax(current, {0.3, yield}, 0.1, law);
            const double now = stress_of(current, law);
            EXPECT_LT(now, last);
            EXPECT_GT(now, yield);
            last = now;
          }
      }
}


TEST(Relaxation, OfSmallShearAboveTheYieldStressIsExponential)
{
  const Tensor<2, 3> F_e    = diagonal<3>({1.0002, 0.9999, 0.9999});
  const double       stress = stress_of(F_e), yield = 0.25 * stress;
  EXPECT_NEAR(stress_of(relax(F_e, {0.4, yield, 5000}, 0.4)),
              yield + (stress - yield) * std::exp(-1.),
              1e-3 * stress);
}


TEST(Relaxation, KnowsTheVonMisesStress)
{
  std::mt19937 generator(8);
  for (const std::string law :
       {"neo-Hookean", "isochoric neo-Hookean", "stiffening"})
    {
      const Tensor<2, 3>    F_e = some_strain<3>(generator);
      const ElasticPoint<3> point(F_e, constants, material_of_test(law));
      EXPECT_NEAR(stress_of(F_e, law),
                  std::sqrt(1.5) * deviator(point.kirchhoff_stress()).norm(),
                  1e-13);
      const Tensor<2, 2>    plane = some_strain<2>(generator);
      const ElasticPoint<2> in_plane(plane, constants, material_of_test(law));
      EXPECT_NEAR(stress_of(plane, law),
                  std::sqrt(1.5) * deviator(in_plane.kirchhoff_stress()).norm(),
                  1e-13);
    }
}


/** Cauchy stress over the stiffness' unit, kPa. */
template <int dim>
SymmetricTensor<2, dim>
true_stress(const Tensor<2, dim> &F_e,
            const Lame           &lame,
            const std::string    &law,
            const bool            per_grown_volume)
{
  return ElasticPoint<dim>(F_e, lame, material_of_test(law))
           .kirchhoff_stress() /
         (per_grown_volume ? determinant(F_e) : 1.);
}


template <int dim>
void
stiffens_at_the_same_stress()
{
  std::mt19937 generator(5);
  for (const std::string law : {"neo-Hookean", "isochoric neo-Hookean"})
    for (const bool grown : {false, true})
      for (const Lame &after :
           {lame(1.01, 0.4), lame(30., 0.4), lame(3., 0.49), lame(1e4, 0.4)})
        for (unsigned int n = 0; n < 20; ++n)
          {
            const Tensor<2, dim> F_e = some_strain<dim>(generator);
            const auto           D   = given_up_by_stiffening<dim>(
              F_e, constants, after, material_of_test(law), grown);
            EXPECT_LT((true_stress<dim>(
                         F_e * invert(Tensor<2, dim>(D)), after, law, grown) -
                       true_stress<dim>(F_e, constants, law, grown))
                        .norm(),
                      1e-10)
              << law << grown << dim;
          }
}


TEST(Relaxation, StiffensAtTheSameStress)
{
  stiffens_at_the_same_stress<2>();
  stiffens_at_the_same_stress<3>();
}
