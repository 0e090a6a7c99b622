// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "mechanics/room.h"

/** Where all points have the same ln J_e, it is that of the pool. */
template <int dim>
void
check_uniform_volume_ratio_of(const std::string &law)
{
  SCOPED_TRACE(law);
  std::mt19937 generator(5);
  auto         points = random_material_points<dim>(
    generator, 4, false, true, material_of_test(law));
  for (auto &state : points.current)
    state.A *= std::pow(0.9 / determinant(state.A), 1. / dim);
  pool(points);
  const auto field = affine_field(random_tensor<1, dim>(generator),
                                  0.2 * random_tensor<2, dim>(generator),
                                  points.h);
  const InternalForce<dim> plain(points);
  const InternalForce<dim> pooled(points, VolumetricStrain::pooled);
  const TermOnOneCell<dim> expected(plain, GrowthAt::current);
  const TermOnOneCell<dim> found(pooled, GrowthAt::current);
  expect_near(found.residual(field), expected.residual(field), 1e-12);
  EXPECT_NEAR(found.energy(field),
              expected.energy(field),
              1e-12 * expected.energy(field));
  const double J = 0.9 * determinant(field.step_deformation(
                           SplineValues<dim>(points.xi[0], points.h)));
  EXPECT_NEAR(pooled.energy_of(0, field).theta.at(0), std::log(J), 1e-12);
}

/** A tangent takes the volume change from the linearisation that it is
 *  given: the exact tangent at the same place, another one elsewhere. The
 *  term itself remembers nothing. */
template <int dim>
void
check_linearisation()
{
  std::mt19937 generator(8);
  const auto   points =
    stretched_by(1.3, random_material_points<dim>(generator, 4, true, true));
  const auto               first  = random_field<dim>(generator, 0.1);
  const auto               second = random_field<dim>(generator, 0.1);
  const InternalForce<dim> term(points, VolumetricStrain::pooled);
  const auto               theta = [&](const LocalField<dim> &field) {
    return term.energy_of(0, field).theta.at(0);
  };
  using Linearisations = std::vector<VolumeLinearisation<dim>>;
  const auto tangent   = [&](const LocalField<dim> &field,
                           const GrowthAt         growth,
                           const Linearisations  &last) {
    LocalSystem<dim> system(LocalSystem<dim>::tangent);
    system.last = last.empty() ? nullptr : &last;
    term.add(0, field, growth, system);
    return system;
  };
  const auto exact  = tangent(first, GrowthAt::current, {});
  const auto before = tangent(first, GrowthAt::previous, {});
  ASSERT_EQ(exact.linearisations.size(), 1u);
  ASSERT_EQ(before.linearisations.size(), 1u);
  const VolumeLinearisation<dim> &linear = exact.linearisations[0];
  // Of both, the linearisation is that at the new growth.
  EXPECT_EQ(linear.value, before.linearisations[0].value);
  EXPECT_EQ(linear.at(first), theta(first));
  // ... and its derivative that of the mean.
  const double eps = 1e-4;
  for (unsigned int dof = 0; dof < LocalSystem<dim>::n_dofs; ++dof)
    {
      auto after = first, earlier = first;
      (&after.coefficient[0][0])[dof] += eps;
      (&earlier.coefficient[0][0])[dof] -= eps;
      EXPECT_NEAR(linear.at(after) - linear.at(earlier),
                  theta(after) - theta(earlier),
                  1e-12);
    }
  expect_near(tangent(first, GrowthAt::current, exact.linearisations).matrix,
              exact.matrix,
              1e-14);
  const auto own     = tangent(second, GrowthAt::current, {});
  const auto given   = tangent(second, GrowthAt::current, exact.linearisations);
  double     largest = 0.;
  for (std::size_t i = 0; i < own.matrix.size(); ++i)
    largest = std::max(largest, std::abs(own.matrix[i] - given.matrix[i]));
  EXPECT_GT(largest, 0.); // here they differ
  expect_near(tangent(second, GrowthAt::current, {}).matrix, own.matrix, 0.);
}


TEST_2D_3D(InternalForce, ResidualAndTangentAreDerivatives)
{
  std::mt19937 generator(1);
  for (const std::string &name : all_materials().names())
    for (const bool growing : {true, false})
      for (const bool uniform : {true, false})
        {
          SCOPED_TRACE(name);
          const auto points = random_material_points<dim>(
            generator, 4, growing, uniform, material_of_test(name));
          for (const VolumetricStrain form : all_forms)
            for (const double stretch : {0.8, 1., 1.2})
              {
                const auto stretched = stretched_by(stretch, points);
                const InternalForce<dim> term(stretched, form);
                EXPECT_TRUE(term.is_conservative());
                expect_derivatives(term, random_field<dim>(generator, 0.15));
              }
        }
}


TEST_2D_3D(InternalForce, UniformVolumeRatioIsThatOfThePool)
{
  for (const std::string &name : all_materials().names())
    check_uniform_volume_ratio_of<dim>(name);
}


// Without shear, the pooled energy is that of one body of the sum of the
// volumes, and so is the pressure: who carries them makes no difference.
TEST_2D_3D(InternalForce, PooledVolumeIsOneSum)
{
  std::mt19937 generator(9);
  auto         points = random_material_points<dim>(generator, 6, false, true);
  points.lame         = {{1.7, 0.}};
  pool(points);
  points           = stretched_by(1.3, points);
  const auto field = random_field<dim>(generator, 0.1);
  double     v = 0., grown = 0.;
  for (unsigned int p = 0; p < points.xi.size(); ++p)
    {
      v += points.carried[p] * determinant(field.step_deformation(
                                 SplineValues<dim>(points.xi[p], points.h)));
      grown += points.current[p].W;
    }
  const double             theta = std::log(v / grown);
  const InternalForce<dim> term(points, VolumetricStrain::pooled);
  const TermOnOneCell<dim> at(term, GrowthAt::current);
  EXPECT_NEAR(term.energy_of(0, field).theta.at(0), theta, 1e-13);
  EXPECT_NEAR(at.energy(field), 0.5 * grown * 1.7 * theta * theta, 1e-11);
  // The grown volume moves from a point to another one: the sum and so the
  // forces stay.
  auto         others = points;
  const double gone   = 0.999 * others.current[0].W;
  others.current[0].W -= gone;
  others.current[1].W += gone;
  others.grown[0].after -= gone;
  others.grown[1].after += gone;
  const InternalForce<dim> moved(others, VolumetricStrain::pooled);
  expect_near(TermOnOneCell<dim>(moved, GrowthAt::current).residual(field),
              at.residual(field),
              1e-12);
}


// Under pressure, without shear, ϑ begins with that of the sums and changes by
// the mean of ln det f by volume; points are left with that of the sum. A field
// that moves volume from point to point, and none in sum, costs energy: (2.8b).
TEST_2D_3D(InternalForce, UnderPressureVolumeDoesNotMoveForFree)
{
  std::mt19937 generator(10);
  auto         points = random_material_points<dim>(generator, 6, false, true);
  points.lame         = {{1.7, 0.}};
  pool(points);
  points            = stretched_by(0.8, points);
  const auto field  = random_field<dim>(generator, 0.1);
  double     before = 0., after = 0., grown = 0., change = 0.;
  for (unsigned int p = 0; p < points.xi.size(); ++p)
    {
      const double c     = points.carried[p];
      const double det_f = determinant(
        field.step_deformation(SplineValues<dim>(points.xi[p], points.h)));
      before += c;
      after += c * det_f;
      change += c * std::log(det_f);
      grown += points.grown[p].after;
    }
  ASSERT_LT(before, grown);
  const double             theta = std::log(before / grown) + change / before;
  const InternalForce<dim> term(points, VolumetricStrain::pooled);
  EXPECT_NEAR(TermOnOneCell<dim>(term, GrowthAt::current).energy(field),
              0.5 * grown * 1.7 * theta * theta,
              1e-11);
  EXPECT_NEAR(term.energy_of(0, field).theta.at(0),
              std::log(after / grown),
              1e-13);
  EXPECT_LT(theta, std::log(after / grown));
}


// Groups of a mixed pool have one pressure and the pool's volume; the energy's
// derivatives are those of doc/theory.md (2.7). Groups that are alike share the
// volume by what they have grown to.
TEST(PoolEnergy, OfGroupsIsTheLeast)
{
  for (const std::string &name : all_materials().names())
    for (const double theta : {-0.5, 0., 0.3})
      {
        SCOPED_TRACE(name + ' ' + std::to_string(theta));
        const Material &material = material_of_test(name);
        Pools           pools;
        pools.list = {{0, 3, 0, 3}};
        // Λ = k G with k = 1, 10, 100
        for (const auto &[k, G] :
             {std::pair(1., 2.), std::pair(10., 3.), std::pair(100., 5.)})
          pools.groups.push_back({0, 0, 0, {}, {0., G}}),
            pools.groups.back().modulus = {0., k * G};
        const auto of = [&](const double theta) {
          return pool_energy(
            pools, pools.list[0], GrowthAt::current, theta, material);
        };
        const PoolEnergy found = of(theta);
        double           v     = 0.;
        for (unsigned int g = 0; g < 3; ++g)
          v += pools.groups[g].grown.after * std::exp(found.theta[g]);
        EXPECT_NEAR(v, 10. * std::exp(theta), 1e-12 * v);
        const double q = found.U.modulus * found.U.slope / v;
        for (unsigned int g = 0; g < 3; ++g)
          EXPECT_NEAR(pools.groups[g].modulus.after /
                        pools.groups[g].grown.after *
                        material.volumetric(found.theta[g]).slope /
                        std::exp(found.theta[g]),
                      q,
                      1e-10 * (1. + std::abs(q)));
        const double eps  = 1e-5;
        const auto   more = of(theta + eps).U, less = of(theta - eps).U;
        EXPECT_NEAR(found.U.slope,
                    (more.energy - less.energy) / (2. * eps),
                    1e-6);
        EXPECT_NEAR(found.U.curvature,
                    (more.slope - less.slope) / (2. * eps),
                    1e-6 * (1. + std::abs(found.U.curvature)));
        for (PoolGroup &group : pools.groups)
          group.modulus.after = group.grown.after;
        for (const double ln_J : of(theta).theta)
          EXPECT_NEAR(ln_J, theta, 1e-12);
      }
}


// A rotation of the deformed state leaves the energy and turns the forces.
TEST_2D_3D(InternalForce, IsFrameIndifferent)
{
  std::mt19937 generator(6);
  const auto   points = random_material_points<dim>(generator, 5, false, false);
  const auto   Q      = rotation<dim>(0.7);
  const auto   field  = random_field<dim>(generator, 0.15);
  // Q (x + u) - x
  LocalField<dim> rotated =
    affine_field(Tensor<1, dim>(), Q - unit_tensor<dim>(), points.h);
  for (unsigned int i = 0; i < dim; ++i)
    for (unsigned int j = 0; j < dim; ++j)
      for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
        rotated.coefficient[i][a] += Q[i][j] * field.coefficient[j][a];
  for (const VolumetricStrain form : all_forms)
    {
      const InternalForce<dim> term(points, form);
      const TermOnOneCell<dim> at(term, GrowthAt::current);
      EXPECT_NEAR(at.energy(rotated),
                  at.energy(field),
                  1e-12 * at.energy(field));
      const auto             forces = at.residual(field);
      std::vector<double>    expected(forces.size(), 0.);
      constexpr unsigned int n = BSpline<dim>::n;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          for (unsigned int a = 0; a < n; ++a)
            expected[i * n + a] += Q[i][j] * forces[j * n + a];
      expect_near(at.residual(rotated), expected, 1e-12);
    }
}


// Without shear stiffness and stress, the tangent is that of one constraint a
// grid cell: of rank one, however many points it holds.
TEST_2D_3D(InternalForce, PooledIsOneConstraintAPool)
{
  std::mt19937 generator(7);
  auto         points = random_material_points<dim>(generator, 6, false, true);
  points.lame         = {{1., 0.}};
  for (auto &state : points.current)
    state.A = unit_tensor<dim>();
  pool(points);
  const InternalForce<dim> term(points, VolumetricStrain::pooled);
  const auto               K =
    TermOnOneCell<dim>(term, GrowthAt::current).tangent(LocalField<dim>{});
  constexpr unsigned int N     = LocalSystem<dim>::n_dofs;
  unsigned int           pivot = 0;
  for (unsigned int i = 0; i < N; ++i)
    if (K[i * N + i] > K[pivot * N + pivot])
      pivot = i;
  std::vector<double> product(N * N);
  for (unsigned int i = 0; i < N; ++i)
    for (unsigned int j = 0; j < N; ++j)
      product[i * N + j] =
        K[i * N + pivot] * K[pivot * N + j] / K[pivot * N + pivot];
  expect_near(K, product, 1e-12);
}


TEST_2D_3D(InternalForce, TakesTheVolumeChangeFromTheLastTangent)
{
  check_linearisation<dim>();
}


// Energy and stress of a homogeneous deformation.
TEST_2D_3D(InternalForce, EnergyOfAHomogeneousDeformation)
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
          neo_hookean_point((unit_tensor<dim>() + A) * state.A, points.lame[0])
            .energy();
      EXPECT_NEAR(TermOnOneCell<dim>(term, growth).energy(field),
                  expected,
                  1e-12 * expected);
    }
}


// |contributions| bound the residual, and it does not change with them.
TEST_2D_3D(InternalForce, MagnitudesBoundTheSums)
{
  std::mt19937 generator(3);
  const auto   points = random_material_points<dim>(generator, 5, false, true);
  const auto   field  = random_field<dim>(generator, 0.1);
  for (const VolumetricStrain form : all_forms)
    {
      const InternalForce<dim> term(points, form);
      const auto system = TermOnOneCell<dim>(term, GrowthAt::current)
                            .added(field, LocalSystem<dim>::rounding);
      expect_near({system.residual.begin(), system.residual.end()},
                  TermOnOneCell<dim>(term, GrowthAt::current).residual(field),
                  0.);
      for (unsigned int dof = 0; dof < system.residual.size(); ++dof)
        EXPECT_GE(system.magnitude[dof],
                  std::abs(system.residual[dof]) * (1. - 1e-12));
      EXPECT_GE(system.energy_magnitude, system.energy);
    }
}


TEST_2D_3D(InternalForce, NoticesInversion)
{
  std::mt19937 generator(4);
  auto         points = random_material_points<dim>(generator, 2, false, true);
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
