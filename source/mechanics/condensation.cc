// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/condensation.h>

namespace Morula
{
  namespace
  {
    std::vector<double>
    transpose(const std::vector<double> &X,
              const unsigned int         n_rows,
              const unsigned int         n_columns)
    {
      std::vector<double> result(X.size());
      for (unsigned int r = 0; r < n_rows; ++r)
        for (unsigned int c = 0; c < n_columns; ++c)
          result[c * n_rows + r] = X[r * n_columns + c];
      return result;
    }
  } // namespace

  template <int dim>
  Condensation<dim>::Condensation(const typename SplineSpace<dim>::Cell &cell)
    : m_(cell.unknowns.size())
    , identity(cell.weights.empty())
  {
    for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
      if (identity)
        rows[a] = {{a, 1.}};
      else
        for (unsigned int s = 0; s < m_; ++s)
          if (cell.weights[a * m_ + s] != 0.)
            rows[a].push_back({s, cell.weights[a * m_ + s]});
  }

  template <int dim>
  unsigned int
  Condensation<dim>::m() const
  {
    return m_;
  }

  template <int dim>
  LocalField<dim>
  Condensation<dim>::expand(const std::vector<double> &coefficients) const
  {
    LocalField<dim> field;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
        {
          double sum = 0.;
          for (const Entry &entry : rows[a])
            sum += entry.weight * coefficients[i * m_ + entry.unknown];
          field.coefficient[i][a] = sum;
        }
    return field;
  }

  template <int dim>
  std::vector<double>
  Condensation<dim>::condense(
    const std::array<double, LocalSystem<dim>::n_dofs> &forces,
    const bool                                          magnitudes) const
  {
    std::vector<double> result(dim * m_, 0.);
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
        for (const Entry &entry : rows[a])
          result[i * m_ + entry.unknown] +=
            (magnitudes ? std::abs(entry.weight) : entry.weight) *
            forces[i * BSpline<dim>::n + a];
    return result;
  }

  template <int dim>
  std::vector<double>
  Condensation<dim>::times_rows(const std::vector<double> &X,
                                const unsigned int         n_columns) const
  {
    std::vector<double> result(dim * m_ * n_columns, 0.);
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
        {
          const double *const source =
            &X[(i * BSpline<dim>::n + a) * n_columns];
          for (const Entry &entry : rows[a])
            {
              double *const target =
                &result[(i * m_ + entry.unknown) * n_columns];
              for (unsigned int c = 0; c < n_columns; ++c)
                target[c] += entry.weight * source[c];
            }
        }
    return result;
  }

  template <int dim>
  std::vector<double>
  Condensation<dim>::condense(const std::vector<double> &matrix) const
  {
    if (identity)
      return matrix;
    constexpr unsigned int n_dofs = LocalSystem<dim>::n_dofs;
    // (Cᵀ (Cᵀ K)ᵀ)ᵀ: both products run over contiguous rows.
    const std::vector<double> half =
      transpose(times_rows(matrix, n_dofs), dim * m_, n_dofs);
    return transpose(times_rows(half, dim * m_), dim * m_, dim * m_);
  }

  template class Condensation<2>;
  template class Condensation<3>;
} // namespace Morula
