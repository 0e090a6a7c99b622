// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_finite_differences_h
#define morula_tests_finite_differences_h

#include <morula/mechanics/material_points.h>
#include <morula/mechanics/term.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "common/body_on_grid.h"

namespace Morula
{
  /** A term on the only grid cell of a test, by component and spline. */
  template <int dim>
  class TermOnOneCell
  {
  public:
    static constexpr unsigned int n      = BSpline<dim>::n;
    static constexpr unsigned int n_dofs = LocalSystem<dim>::n_dofs;
    using Vector                         = std::vector<double>;

    TermOnOneCell(const Term<dim> &term, const GrowthAt growth)
      : term(term)
      , growth(growth)
    {}

    double
    energy(const LocalField<dim> &field) const
    {
      return added(field, LocalSystem<dim>::energy_and_residual).energy;
    }

    Vector
    residual(const LocalField<dim> &field) const
    {
      const auto system = added(field, LocalSystem<dim>::energy_and_residual);
      return {system.residual.begin(), system.residual.end()};
    }

    /** Row by row. */
    Vector
    tangent(const LocalField<dim> &field) const
    {
      return added(field, LocalSystem<dim>::tangent).matrix;
    }

    bool
    inverted(const LocalField<dim>                  &field,
             const typename LocalSystem<dim>::Wanted wanted) const
    {
      return added(field, wanted).inverted;
    }

    LocalSystem<dim>
    added(const LocalField<dim>                  &field,
          const typename LocalSystem<dim>::Wanted wanted) const
    {
      LocalSystem<dim> system(wanted);
      term.add(0, field, growth, system);
      return system;
    }

    /** dΠ/du by central differences. */
    Vector
    energy_differences(const LocalField<dim> &field) const
    {
      Vector derivative;
      for (unsigned int dof = 0; dof < n_dofs; ++dof)
        derivative.push_back((energy(shifted(field, dof, eps)) -
                              energy(shifted(field, dof, -eps))) /
                             (2. * eps));
      return derivative;
    }

    /** dR/du by central differences, row by row. */
    Vector
    residual_differences(const LocalField<dim> &field) const
    {
      Vector derivative(n_dofs * n_dofs);
      for (unsigned int dof = 0; dof < n_dofs; ++dof)
        {
          const Vector after  = residual(shifted(field, dof, eps));
          const Vector before = residual(shifted(field, dof, -eps));
          for (unsigned int row = 0; row < n_dofs; ++row)
            derivative[row * n_dofs + dof] =
              (after[row] - before[row]) / (2. * eps);
        }
      return derivative;
    }

  private:
    static constexpr double eps = 1e-4; // µm, for h = 50

    static LocalField<dim>
    shifted(LocalField<dim> field, const unsigned int dof, const double by)
    {
      field.coefficient[dof / n][dof % n] += by;
      return field;
    }

    const Term<dim> &term;
    const GrowthAt   growth;
  };

  /** Equal but for @p tolerance times the largest entry. */
  inline void
  expect_near(const std::vector<double> &found,
              const std::vector<double> &expected,
              const double               tolerance)
  {
    ASSERT_EQ(found.size(), expected.size());
    double largest = 0., difference = 0.;
    for (std::size_t i = 0; i < found.size(); ++i)
      {
        largest    = std::max(largest, std::abs(expected[i]));
        difference = std::max(difference, std::abs(found[i] - expected[i]));
      }
    EXPECT_LE(difference, tolerance * largest) << "of " << largest;
  }

  /** The energy's derivative is the residual, the residual's the tangent. */
  template <int dim>
  void
  expect_derivatives(const Term<dim> &term, const LocalField<dim> &field)
  {
    for (const GrowthAt growth : {GrowthAt::previous, GrowthAt::current})
      {
        const TermOnOneCell<dim> at(term, growth);
        if (term.is_conservative())
          expect_near(at.energy_differences(field), at.residual(field), 1e-7);
        expect_near(at.residual_differences(field), at.tangent(field), 1e-7);
      }
  }

  /** A displacement with gradients up to about @p gradient, h = 50 µm. */
  template <int dim>
  LocalField<dim>
  random_field(std::mt19937 &generator, const double gradient)
  {
    std::uniform_real_distribution<double> uniform(-25. * gradient,
                                                   25. * gradient);
    LocalField<dim>                        field;
    for (auto &component : field.coefficient)
      for (double &c : component)
        c = uniform(generator);
    return field;
  }

  /** A displacement u = a + A x of the grid cell [0, h]^dim. */
  template <int dim>
  LocalField<dim>
  affine_field(const Tensor<1, dim> &a, const Tensor<2, dim> &A, const double h)
  {
    LocalField<dim> field;
    for (unsigned int b = 0; b < BSpline<dim>::n; ++b)
      {
        Tensor<1, dim> center;
        for (unsigned int d = 0; d < dim; ++d)
          center[d] = (BSpline<dim>::offset(b, d) + 0.5) * h;
        const Tensor<1, dim> u = a + A * center;
        for (unsigned int d = 0; d < dim; ++d)
          field.coefficient[d][b] = u[d];
      }
    return field;
  }

  template <int dim>
  GroupedPoints<dim>
  random_points_in_cell(std::mt19937 &generator, const unsigned int n)
  {
    GroupedPoints<dim> points;
    points.offsets = {0, n};
    points.h       = 50.;
    for (unsigned int p = 0; p < n; ++p)
      {
        Point<dim> xi;
        for (unsigned int d = 0; d < dim; ++d)
          xi[d] = std::uniform_real_distribution<double>(0., 1.)(generator);
        points.xi.push_back(xi);
      }
    return points;
  }

  /** Deformed and grown, each by itself. */
  template <int dim>
  std::vector<ElasticState<dim>>
  random_states(std::mt19937 &generator, const unsigned int n)
  {
    std::vector<ElasticState<dim>> states;
    for (unsigned int p = 0; p < n; ++p)
      states.push_back(
        {unit_tensor<dim>() + 0.2 * random_tensor<2, dim>(generator),
         100. + generator() % 900});
    return states;
  }
} // namespace Morula

#endif
