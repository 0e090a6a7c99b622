// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "mechanics/room.h"

template <int dim>
LocalSystem<dim>
system_of(const Term<dim>                        &term,
          const LocalField<dim>                  &field,
          const GrowthAt                          growth,
          const typename LocalSystem<dim>::Wanted wanted)
{
  LocalSystem<dim> system(wanted);
  term.add(0, field, growth, system);
  return system;
}

template <typename Container>
void
expect_same(const Container &found,
            const Container &expected,
            const double     tolerance = 1e-13)
{
  double size = 0.;
  for (const double value : expected)
    size = std::max(size, std::abs(value));
  ASSERT_EQ(found.size(), expected.size());
  for (unsigned int k = 0; k < found.size(); ++k)
    ASSERT_NEAR(found[k], expected[k], tolerance * size) << "entry " << k;
}

template <int dim>
std::vector<double>
entries(const LocalField<dim> &field)
{
  const double *const first = &field.coefficient[0][0];
  return {first, first + LocalSystem<dim>::n_dofs};
}

template <int dim>
void
expect_same(const LocalSystem<dim> &found, const LocalSystem<dim> &expected)
{
  expect_same(found.residual, expected.residual);
  if (expected.wanted == LocalSystem<dim>::rounding) // else incomplete
    expect_same(found.magnitude, expected.magnitude);
  expect_same(found.matrix, expected.matrix);
  ASSERT_EQ(found.linearisations.size(), expected.linearisations.size());
  for (std::size_t k = 0; k < expected.linearisations.size(); ++k)
    {
      const auto &theirs = expected.linearisations[k];
      const auto &ours   = found.linearisations[k];
      EXPECT_NEAR(ours.value, theirs.value, 1e-14);
      expect_same(entries(ours.derivative), entries(theirs.derivative));
      expect_same(entries(ours.field), entries(theirs.field));
    }
  EXPECT_NEAR(found.energy, expected.energy, 1e-13 * expected.energy_magnitude);
  EXPECT_NEAR(found.energy_magnitude,
              expected.energy_magnitude,
              1e-13 * expected.energy_magnitude);
  if (std::isinf(expected.smallest_J.value)) // no points
    {
      EXPECT_EQ(found.smallest_J.value, expected.smallest_J.value);
    }
  else
    {
      EXPECT_NEAR(found.smallest_J.value, expected.smallest_J.value, 1e-13);
    }
  EXPECT_EQ(found.smallest_J.place, expected.smallest_J.place);
  EXPECT_EQ(found.inverted, expected.inverted);
}

/** The kernels of the neo-Hookean material. */
template <int dim>
const std::vector<VectorKernels<dim>> &
all_kernels()
{
  return neo_hookean().vector_kernels<dim>();
}

template <int dim>
std::unique_ptr<InternalForce<dim>>
by_kernels(const MaterialPoints<dim> &points,
           const VectorKernels<dim>  &kernels,
           const VolumetricStrain     form = VolumetricStrain::pointwise)
{
  return internal_force(points, form, kernels.name);
}

template <int dim>
void
check_any_number_of(const Material        &material,
                    const VolumetricStrain form,
                    const unsigned int     n,
                    const bool             uniform,
                    const double           stretch)
{
  std::mt19937 generator(n);
  const auto   points = stretched_by(
    stretch,
    random_material_points<dim>(generator, n, true, uniform, material));
  const auto               field = random_field<dim>(generator, 0.15);
  const InternalForce<dim> plain(points, form);
  for (const auto &kernels : material.vector_kernels<dim>())
    {
      SCOPED_TRACE(kernels.name + std::string(", points: ") +
                   std::to_string(n));
      const auto  made       = by_kernels(points, kernels, form);
      const auto &vectorized = *made;
      if (form == VolumetricStrain::pooled)
        {
          EXPECT_NEAR(vectorized.energy_of(0, field).theta[0],
                      plain.energy_of(0, field).theta[0],
                      1e-14);
        }
      for (const GrowthAt growth : {GrowthAt::previous, GrowthAt::current})
        for (const auto wanted : {LocalSystem<dim>::energy_and_residual,
                                  LocalSystem<dim>::rounding,
                                  LocalSystem<dim>::tangent})
          expect_same(system_of(vectorized, field, growth, wanted),
                      system_of(plain, field, growth, wanted));
    }
}

TEST_2D_3D(VectorizedInternalForce, IsThePlainOneWithAnyNumberOfPoints)
{
  for (const std::string &name : all_materials().names())
    for (const VolumetricStrain form : all_forms)
      for (const unsigned int n : {1, 2, 3, 7, 8, 9, 16, 41, 125})
        for (const bool uniform : {true, false})
          for (const double stretch : {0.8, 1.2})
            {
              SCOPED_TRACE(name);
              check_any_number_of<dim>(
                material_of_test(name), form, n, uniform, stretch);
            }
}

// In single precision, one after the other into the same matrix.
TEST_2D_3D(VectorizedInternalForce, InSinglePrecisionIsNearlyThePlainOne)
{
  for (const std::string &name : all_materials().names())
    for (const VolumetricStrain form : all_forms)
      for (const unsigned int n : {1, 7, 8, 125})
        {
          const Material &material = material_of_test(name);
          std::mt19937    generator(n);
          const auto      points =
            random_material_points<dim>(generator, n, true, false, material);
          const auto field    = random_field<dim>(generator, 0.15);
          const auto expected = system_of(InternalForce<dim>(points, form),
                                          field,
                                          GrowthAt::current,
                                          LocalSystem<dim>::tangent);
          for (const auto &kernels : material.vector_kernels<dim>())
            {
              SCOPED_TRACE(name + ' ' + kernels.name);
              LocalSystem<dim> system(LocalSystem<dim>::tangent);
              system.in_single = true;
              by_kernels(points, kernels, form)
                ->add(0, field, GrowthAt::current, system);
              // of n sums, each rounded to 6e-8
              expect_same(system.matrix, expected.matrix, 1e-6);
              double largest = 0.;
              for (unsigned int k = 0; k < system.matrix.size(); ++k)
                largest =
                  std::max(largest,
                           std::abs(system.matrix[k] - expected.matrix[k]));
              EXPECT_GT(largest, 0.); // else it is not in single precision
              // symmetric to the last bit, but for the means of a grid cell
              constexpr unsigned int n_dofs = LocalSystem<dim>::n_dofs;
              const bool pointwise = form == VolumetricStrain::pointwise;
              for (unsigned int i = 0; pointwise && i < n_dofs; ++i)
                for (unsigned int j = 0; j < i; ++j)
                  ASSERT_EQ(system.matrix[i * n_dofs + j],
                            system.matrix[j * n_dofs + i]);
            }
        }
}

// Sums of products of rows, added to a block inside a larger matrix.
TEST_2D_3D(VectorKernels, ProductsOfRows)
{
  std::mt19937           generator(8);
  constexpr unsigned int n = BSpline<dim>::n, stride = 2 * n + 1;
  for (const unsigned int n_products : {1, 2, 5, 40})
    {
      std::vector<SplineProduct<dim>> products(n_products);
      for (auto &product : products)
        for (auto &row : product.factors)
          for (unsigned int a = 0; a < SplineProduct<dim>::width; ++a)
            row[a] = a < n ? std::normal_distribution<>()(generator) : 0.;
      std::vector<double> before(n * stride), expected;
      for (double &entry : before)
        entry = std::normal_distribution<>()(generator);
      expected = before;
      add_products_plainly<dim>(products.data(),
                                n_products,
                                &expected[3],
                                stride);
      EXPECT_DOUBLE_EQ(expected[0], before[0]);
      double first = before[3];
      for (const auto &product : products)
        first += product.factors[0][0] * product.factors[1][0];
      EXPECT_NEAR(expected[3], first, 1e-13);
      for (const auto &kernels : all_kernels<dim>())
        {
          SCOPED_TRACE(kernels.name);
          std::vector<double> found = before;
          kernels.add_products(products.data(), n_products, &found[3], stride);
          expect_same(found, expected);
        }
    }
  EXPECT_EQ(product_kernel<dim>(neo_hookean(), "plain"),
            &add_products_plainly<dim>);
  EXPECT_EQ(product_kernel<dim>(neo_hookean(), "automatic"),
            all_kernels<dim>().front().add_products);
}

// Displacements and deformations of any number of points.
TEST_2D_3D(VectorKernels, Motions)
{
  std::mt19937 generator(9);
  for (const unsigned int n : {1, 3, 8, 29})
    {
      const auto points = random_material_points<dim>(generator, n, true, true);
      const auto field  = random_field<dim>(generator, 0.15);
      KernelInput input{};
      input.n                          = n;
      input.xi                         = &points.xi[0][0];
      input.h                          = points.h;
      input.coefficients               = &field.coefficient[0][0];
      constexpr unsigned int n_numbers = dim + dim * dim;
      std::vector<double>    expected(n * n_numbers), found(n * n_numbers);
      find_motions_plainly<dim>(input, expected.data());
      const SplineValues<dim> splines(points.xi[n - 1], points.h);
      EXPECT_EQ(expected[(n - 1) * n_numbers], field.value(splines)[0]);
      EXPECT_EQ(expected[n * n_numbers - 1],
                field.step_deformation(splines)[dim - 1][dim - 1]);
      for (const auto &kernels : all_kernels<dim>())
        {
          SCOPED_TRACE(kernels.name);
          kernels.find_motions(input, found.data());
          expect_same(found, expected);
        }
    }
}


TEST_2D_3D(VectorizedInternalForce, NoPointsAddNothing)
{
  std::mt19937 generator(4);
  auto         points = random_material_points<dim>(generator, 1, true, true);
  points.offsets      = {0, 0};
  const auto field    = random_field<dim>(generator, 0.15);
  for (const auto &kernels : all_kernels<dim>())
    expect_same(system_of(*by_kernels(points, kernels),
                          field,
                          GrowthAt::current,
                          LocalSystem<dim>::tangent),
                LocalSystem<dim>(LocalSystem<dim>::tangent));
}

TEST_2D_3D(VectorizedInternalForce, SaysWhichPointIsInverted)
{
  std::mt19937 generator(5);
  auto         points = random_material_points<dim>(generator, 11, true, true);
  points.current[9].A[0][0] *= -1.; // J_e < 0
  const auto field = random_field<dim>(generator, 0.05);
  for (const auto &kernels : all_kernels<dim>())
    for (const auto wanted :
         {LocalSystem<dim>::energy_and_residual, LocalSystem<dim>::tangent})
      {
        const LocalSystem<dim> system = system_of(*by_kernels(points, kernels),
                                                  field,
                                                  GrowthAt::current,
                                                  wanted);
        EXPECT_TRUE(system.inverted);
        EXPECT_LT(system.smallest_J.value, 0.);
        EXPECT_EQ(system.smallest_J.place, points.xi[9]);
        for (const double entry : system.residual)
          ASSERT_EQ(entry, 0.);
      }
}


// The kernels have a logarithm of their own: from the smallest to the largest
// volume ratios, with the accuracy of libm's.
TEST(VectorizedInternalForce, LogarithmsAreAccurate)
{
  std::mt19937  generator(6);
  LocalField<3> rest = {};
  for (const auto &kernels : all_kernels<3>())
    for (const double J : {1e-100,
                           1e-9,
                           0.1,
                           0.5,
                           0.707,
                           0.7072,
                           1. - 1e-12,
                           1. + 1e-12,
                           1.4142,
                           1.4143,
                           3.,
                           1e9,
                           1e100})
      {
        auto points = random_material_points<3>(generator, 1, true, true);
        points.lame = {{1., 0.}}; // τ = λ ln J_e I alone
        auto &A     = points.current[0].A;
        A           = unit_symmetric_tensor<3>();
        A[0][0]     = J;
        const auto   found = system_of(*by_kernels(points, kernels),
                                     rest,
                                     GrowthAt::current,
                                     LocalSystem<3>::energy_and_residual);
        const double log_J = std::log(J);
        EXPECT_NEAR(std::sqrt(2. * found.energy / points.current[0].W),
                    std::abs(log_J),
                    5e-16 * std::abs(log_J) +
                      // of J itself, from a determinant
                      1e-15);
      }
}

// And an exponential: of a change of volume alone, 4 U = e^2ϑ - 1 - 2ϑ.
TEST(VectorizedInternalForce, ExponentialsAreAccurate)
{
  std::mt19937    generator(6);
  LocalField<3>   rest     = {};
  const Material &material = material_of_test("isochoric neo-Hookean");
  for (const auto &kernels : material.vector_kernels<3>())
    for (const double log_J :
         {-30., -3., -0.8, -0.3, -1e-3, -1e-8, 1e-9, 1e-4, 0.2, 1.5, 9., 60.})
      {
        auto points =
          random_material_points<3>(generator, 1, true, true, material);
        points.lame = {{1., 0.}};
        auto &A     = points.current[0].A;
        A           = unit_symmetric_tensor<3>();
        A[0][0]     = std::exp(log_J);
        LocalSystem<3> system(LocalSystem<3>::energy_and_residual);
        by_kernels(points, kernels)->add(0, rest, GrowthAt::current, system);
        const double twice = 2. * std::log(A[0][0]);
        EXPECT_NEAR(system.energy,
                    points.current[0].W * 0.25 * (std::expm1(twice) - twice),
                    1e-15 * system.energy_magnitude);
      }
}

TEST(VectorizedInternalForce, IsChosenByName)
{
  std::mt19937 generator(7);
  const auto   points = random_material_points<3>(generator, 3, true, true);
  const auto   is_vectorized = [&](const VolumetricStrain form,
                                 const std::string     &kernel) {
    const auto              force = internal_force(points, form, kernel);
    const InternalForce<3> &made  = *force;
    return typeid(made) != typeid(InternalForce<3>);
  };
  for (const VolumetricStrain form : all_forms)
    {
      EXPECT_TRUE(is_vectorized(form, "automatic"));
      EXPECT_TRUE(is_vectorized(form, "baseline"));
      EXPECT_FALSE(is_vectorized(form, "plain"));
    }
}
