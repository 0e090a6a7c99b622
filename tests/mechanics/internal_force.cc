// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "mechanics/room.h"

/** One volumetric strain a grid cell. */
const std::vector<VolumetricStrain> forms_of_grid_cells = {
  VolumetricStrain::projected, VolumetricStrain::pooled};

/** Where all points have the same ln J_e, it is that of the grid cell.
 *  Pooled, the pressure is that of the mean modulus. */
template <int dim>
void
check_uniform_volume_ratio_of(const std::string     &law,
                              const VolumetricStrain form)
{
  SCOPED_TRACE(law);
  std::mt19937 generator(5);
  auto         points = random_material_points<dim>(generator,
                                            4,
                                            false,
                                            form == VolumetricStrain::pooled,
                                            material_of_test(law));
  for (auto &state : points.current)
    state.A *= std::pow(0.9 / determinant(state.A), 1. / dim);
  const auto field = affine_field(random_tensor<1, dim>(generator),
                                  0.2 * random_tensor<2, dim>(generator),
                                  points.h);
  const InternalForce<dim> plain(points);
  const InternalForce<dim> of_grid_cell(points, form);
  const TermOnOneCell<dim> expected(plain, GrowthAt::current);
  const TermOnOneCell<dim> found(of_grid_cell, GrowthAt::current);
  expect_near(found.residual(field), expected.residual(field), 1e-12);
  EXPECT_NEAR(found.energy(field),
              expected.energy(field),
              1e-12 * expected.energy(field));
  const double J = 0.9 * determinant(field.step_deformation(
                           SplineValues<dim>(points.xi[0], points.h)));
  EXPECT_NEAR(of_grid_cell.log_volume_ratio(0, field), std::log(J), 1e-12);
}

/** A tangent takes the volume change from the linearisation that it is
 *  given: the exact tangent at the same place, another one elsewhere. The
 *  term itself remembers nothing. */
template <int dim>
void
check_linearisation_of(const VolumetricStrain form)
{
  std::mt19937 generator(8);
  const auto   points = random_material_points<dim>(generator, 4, true, true);
  const auto   first  = random_field<dim>(generator, 0.1);
  const auto   second = random_field<dim>(generator, 0.1);
  const InternalForce<dim> term(points, form);
  const auto               tangent =
    [&](const LocalField<dim>                         &field,
        const GrowthAt                                 growth,
        const std::optional<VolumeLinearisation<dim>> &last) {
      LocalSystem<dim> system(LocalSystem<dim>::tangent);
      system.last = last ? &*last : nullptr;
      term.add(0, field, growth, system);
      return system;
    };
  const auto exact  = tangent(first, GrowthAt::current, {});
  const auto before = tangent(first, GrowthAt::previous, {});
  ASSERT_TRUE(exact.linearisation && before.linearisation);
  // Of both, the linearisation is that at the new growth.
  EXPECT_EQ(exact.linearisation->value, before.linearisation->value);
  EXPECT_EQ(exact.linearisation->at(first), term.log_volume_ratio(0, first));
  // ... and its derivative that of the mean.
  const double eps = 1e-4;
  for (unsigned int dof = 0; dof < LocalSystem<dim>::n_dofs; ++dof)
    {
      auto after = first, earlier = first;
      (&after.coefficient[0][0])[dof] += eps;
      (&earlier.coefficient[0][0])[dof] -= eps;
      EXPECT_NEAR(exact.linearisation->at(after) -
                    exact.linearisation->at(earlier),
                  term.log_volume_ratio(0, after) -
                    term.log_volume_ratio(0, earlier),
                  1e-12);
    }
  expect_near(tangent(first, GrowthAt::current, exact.linearisation).matrix,
              exact.matrix,
              1e-14);
  const auto own     = tangent(second, GrowthAt::current, {});
  const auto given   = tangent(second, GrowthAt::current, exact.linearisation);
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


TEST_2D_3D(InternalForce, UniformVolumeRatioIsThatOfTheGridCell)
{
  for (const std::string &name : all_materials().names())
    for (const VolumetricStrain form : forms_of_grid_cells)
      check_uniform_volume_ratio_of<dim>(name, form);
}


// Without shear, the pooled energy is that of one body of the sum of the
// volumes, and so is the pressure: what single points have makes no difference.
TEST_2D_3D(InternalForce, PooledVolumeIsOneSum)
{
  std::mt19937 generator(9);
  auto         points =
    stretched_by(1.2, random_material_points<dim>(generator, 6, false, true));
  points.lame       = {{1.7, 0.}};
  const auto field  = random_field<dim>(generator, 0.1);
  double     volume = 0., grown = 0.;
  for (unsigned int p = 0; p < points.xi.size(); ++p)
    {
      const auto &[A, W] = points.current[p];
      volume += W * determinant(A) *
                determinant(field.step_deformation(
                  SplineValues<dim>(points.xi[p], points.h)));
      grown += W;
    }
  const double             theta = std::log(volume / grown);
  const InternalForce<dim> term(points, VolumetricStrain::pooled);
  const TermOnOneCell<dim> at(term, GrowthAt::current);
  EXPECT_NEAR(term.log_volume_ratio(0, field), theta, 1e-13);
  EXPECT_NEAR(at.energy(field), 0.5 * grown * 1.7 * theta * theta, 1e-11);
  // The grown volume moves from a point to the others with its volume: the
  // one shrinks to nothing without stretch, the sum and so the forces stay.
  auto         others = points;
  const double gone   = 0.999 * others.current[0].W;
  others.current[0].W -= gone;
  others.current[0].A *=
    std::pow((points.current[0].W * determinant(points.current[0].A)) /
               (others.current[0].W * determinant(points.current[0].A)),
             1. / dim);
  others.current[1].W += gone;
  others.current[1].A *=
    std::pow(points.current[1].W / others.current[1].W, 1. / dim);
  const InternalForce<dim> moved(others, VolumetricStrain::pooled);
  expect_near(TermOnOneCell<dim>(moved, GrowthAt::current).residual(field),
              at.residual(field),
              1e-12);
}


// Under pressure, without shear, ϑ begins with that of the sums and changes by
// the mean of ln det f by volume; points are left with that of the sum. A field
// that moves volume from point to point, and none in sum, costs energy: (2.9b).
TEST_2D_3D(InternalForce, UnderPressureVolumeDoesNotMoveForFree)
{
  std::mt19937 generator(10);
  const auto   points =
    stretched_by(0.8, random_material_points<dim>(generator, 6, false, true));
  const auto field  = random_field<dim>(generator, 0.1);
  double     before = 0., after = 0., grown = 0., change = 0.;
  for (unsigned int p = 0; p < points.xi.size(); ++p)
    {
      const auto &[A, W] = points.current[p];
      const double V     = W * determinant(A);
      const double det_f = determinant(
        field.step_deformation(SplineValues<dim>(points.xi[p], points.h)));
      before += V;
      after += V * det_f;
      change += V * std::log(det_f);
      grown += W;
    }
  ASSERT_LT(before, grown);
  const InternalForce<dim> term(points, VolumetricStrain::pooled);
  const double             theta = term.log_volume_ratio(0, field);
  EXPECT_NEAR(theta, std::log(before / grown) + change / before, 1e-13);
  EXPECT_NEAR(term.log_volume_ratio_after(0, field),
              std::log(after / grown),
              1e-13);
  EXPECT_LT(theta, std::log(after / grown));
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
TEST_2D_3D(InternalForce, ProjectedOrPooledIsOneConstraintAGridCell)
{
  std::mt19937 generator(7);
  auto         points = random_material_points<dim>(generator, 6, false, true);
  points.lame         = {{1., 0.}};
  for (auto &state : points.current)
    state.A = unit_tensor<dim>();
  for (const VolumetricStrain form : forms_of_grid_cells)
    {
      const InternalForce<dim> term(points, form);
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
}


TEST_2D_3D(InternalForce, TakesTheVolumeChangeFromTheLastTangent)
{
  for (const VolumetricStrain form : forms_of_grid_cells)
    check_linearisation_of<dim>(form);
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
