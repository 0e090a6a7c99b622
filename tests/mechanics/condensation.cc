// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/condensation.h>

#include <deal.II/lac/full_matrix.h>

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "common/finite_differences.h"

using namespace Morula;

namespace
{
  template <int dim, int n_components>
  struct Problem
  {
    static constexpr unsigned int n      = BSpline<dim>::n;
    static constexpr unsigned int n_dofs = n_components * n;

    typename SplineSpace<dim>::GridCell grid_cell;
    FullMatrix<double>                  C; // n_dofs x n_components m

    /** A sparse C of random weights; none: the identity. */
    Problem(const unsigned int m, const bool weights, std::mt19937 &generator)
      : C(n_dofs, n_components * m)
    {
      std::uniform_real_distribution<double> uniform(-5., 5.);
      grid_cell.number = 0;
      for (unsigned int s = 0; s < m; ++s)
        grid_cell.unknowns.push_back(3 * s);
      if (weights)
        grid_cell.weights.assign(n * m, 0.);
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int s = 0; s < m; ++s)
          {
            double weight = a == s ? 1. : 0.;
            if (weights)
              grid_cell.weights[a * m + s] = weight =
                generator() % 3 == 0 ? uniform(generator) : 0.;
            for (unsigned int i = 0; i < n_components; ++i)
              C(i * n + a, i * m + s) = weight;
          }
    }
  };

  std::vector<double>
  random_values(const unsigned int n, std::mt19937 &generator)
  {
    std::uniform_real_distribution<double> uniform(-1., 1.);
    std::vector<double>                    values(n);
    for (double &value : values)
      value = uniform(generator);
    return values;
  }

  template <int dim, int n_components>
  void
  check_components()
  {
    constexpr unsigned int n = BSpline<dim>::n;
    constexpr unsigned int N = n_components * n;
    std::mt19937           generator(1);
    for (const auto &[m, weights] : {std::pair<unsigned int, bool>(n, false),
                                     {n, true},
                                     {dim + 1, true},
                                     {2 * n, true}})
      {
        SCOPED_TRACE(std::to_string(n_components) + " components, " +
                     std::to_string(m) + " unknowns");
        const Problem<dim, n_components>      problem(m, weights, generator);
        const auto                           &C = problem.C;
        const Condensation<dim, n_components> condensation(problem.grid_cell);
        ASSERT_EQ(condensation.m(), m);

        const auto coefficients = random_values(n_components * m, generator);
        const auto field        = condensation.expand(coefficients);
        std::vector<double> found, expected(N, 0.);
        for (unsigned int row = 0; row < N; ++row)
          {
            found.push_back(field.coefficient[row / n][row % n]);
            for (unsigned int k = 0; k < n_components * m; ++k)
              expected[row] += C(row, k) * coefficients[k];
          }
        expect_near(found, expected, 1e-14);

        std::array<double, N> forces;
        const auto            values = random_values(N, generator);
        std::copy(values.begin(), values.end(), forces.begin());
        std::vector<double> sums(n_components * m, 0.),
          magnitudes(n_components * m, 0.);
        for (unsigned int k = 0; k < n_components * m; ++k)
          for (unsigned int row = 0; row < N; ++row)
            {
              sums[k] += C(row, k) * forces[row];
              magnitudes[k] += std::abs(C(row, k)) * forces[row];
            }
        expect_near(condensation.condense(forces), sums, 1e-14);
        expect_near(condensation.condense(forces, true), magnitudes, 1e-14);

        // Unsymmetric, so that a transposed product shows.
        const auto         K_values = random_values(N * N, generator);
        FullMatrix<double> K(N, N, K_values.data()), KC(N, n_components * m),
          dense(n_components * m, n_components * m);
        K.mmult(KC, C);
        C.Tmmult(dense, KC);
        std::vector<double> rows;
        for (unsigned int k = 0; k < n_components * m; ++k)
          for (unsigned int l = 0; l < n_components * m; ++l)
            rows.push_back(dense(k, l));
        typename Condensation<dim, n_components>::Work work;
        expect_near(condensation.condense(K_values, work), rows, 1e-13);
      }
  }

  template <int dim>
  void
  check_products()
  {
    check_components<dim, 1>();
    check_components<dim, 2>();
    check_components<dim, 3>();
  }
} // namespace


TEST(Condensation, AgreesWithTheDenseProducts)
{
  MORULA_BOTH_DIMENSIONS(check_products)
}
