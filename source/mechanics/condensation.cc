// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/condensation.h>

namespace Morula
{
  namespace
  {
    void
    transpose(const std::vector<double> &X,
              const unsigned int         n_rows,
              const unsigned int         n_columns,
              std::vector<double>       &result)
    {
      result.resize(X.size());
      for (unsigned int r = 0; r < n_rows; ++r)
        for (unsigned int c = 0; c < n_columns; ++c)
          result[c * n_rows + r] = X[r * n_columns + c];
    }
  } // namespace

  template <int dim>
  Condensation<dim>::Condensation(
    const typename SplineSpace<dim>::GridCell &grid_cell)
    : grid_cell(grid_cell)
  {}

  template <int dim>
  unsigned int
  Condensation<dim>::m() const
  {
    return grid_cell.unknowns.size();
  }

  template <int dim>
  template <typename Visit>
  void
  Condensation<dim>::for_each_weight(const unsigned int a,
                                     const Visit       &visit) const
  {
    if (grid_cell.weights.empty())
      visit(a, 1.);
    else
      for (unsigned int s = 0; s < m(); ++s)
        if (grid_cell.weights[a * m() + s] != 0.)
          visit(s, grid_cell.weights[a * m() + s]);
  }

  template <int dim>
  LocalField<dim>
  Condensation<dim>::expand(const std::vector<double> &coefficients) const
  {
    LocalField<dim> field = {};
    for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
      for_each_weight(a, [&](const unsigned int s, const double weight) {
        for (unsigned int i = 0; i < dim; ++i)
          field.coefficient[i][a] += weight * coefficients[i * m() + s];
      });
    return field;
  }

  template <int dim>
  std::vector<double>
  Condensation<dim>::condense(
    const std::array<double, LocalSystem<dim>::n_dofs> &forces,
    const bool                                          magnitudes) const
  {
    std::vector<double> result(dim * m(), 0.);
    for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
      for_each_weight(a, [&](const unsigned int s, const double weight) {
        for (unsigned int i = 0; i < dim; ++i)
          result[i * m() + s] += (magnitudes ? std::abs(weight) : weight) *
                                 forces[i * BSpline<dim>::n + a];
      });
    return result;
  }

  template <int dim>
  void
  Condensation<dim>::times_rows(const std::vector<double> &X,
                                const unsigned int         n_columns,
                                std::vector<double>       &result) const
  {
    result.assign(dim * m() * n_columns, 0.);
    for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
      for_each_weight(a, [&](const unsigned int s, const double weight) {
        for (unsigned int i = 0; i < dim; ++i)
          {
            const double *const source =
              &X[(i * BSpline<dim>::n + a) * n_columns];
            double *const target = &result[(i * m() + s) * n_columns];
            for (unsigned int c = 0; c < n_columns; ++c)
              target[c] += weight * source[c];
          }
      });
  }

  template <int dim>
  const std::vector<double> &
  Condensation<dim>::condense(const std::vector<double> &matrix,
                              Work                      &work) const
  {
    if (grid_cell.weights.empty())
      return matrix;
    constexpr unsigned int n_dofs = LocalSystem<dim>::n_dofs;
    // (Cᵀ (Cᵀ K)ᵀ)ᵀ: both products run over contiguous rows.
    times_rows(matrix, n_dofs, work.product);
    transpose(work.product, dim * m(), n_dofs, work.transposed);
    times_rows(work.transposed, dim * m(), work.product);
    transpose(work.product, dim * m(), dim * m(), work.transposed);
    return work.transposed;
  }

  template class Condensation<2>;
  template class Condensation<3>;
} // namespace Morula
