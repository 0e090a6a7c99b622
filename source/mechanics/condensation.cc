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

  template <int dim, int n_components>
  Condensation<dim, n_components>::Condensation(
    const typename SplineSpace<dim>::GridCell &grid_cell)
    : grid_cell(grid_cell)
  {}

  template <int dim, int n_components>
  unsigned int
  Condensation<dim, n_components>::m() const
  {
    return grid_cell.unknowns.size();
  }

  template <int dim, int n_components>
  template <typename Visit>
  void
  Condensation<dim, n_components>::for_each_weight(const unsigned int a,
                                                   const Visit &visit) const
  {
    // Most grid cells are inside the tissue, and have no weights: spline a is
    // unknown a. Else row a of C is mostly zeros.
    if (grid_cell.weights.empty())
      visit(a, 1.);
    else
      for (unsigned int s = 0; s < m(); ++s)
        if (grid_cell.weights[a * m() + s] != 0.)
          visit(s, grid_cell.weights[a * m() + s]);
  }

  template <int dim, int n_components>
  LocalField<dim, n_components>
  Condensation<dim, n_components>::expand(
    const std::vector<double> &coefficients) const
  {
    // This is u = C ũ of doc/theory.md (3.5), component by component.
    LocalField<dim, n_components> field = {};
    for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
      for_each_weight(a, [&](const unsigned int s, const double weight) {
        for (unsigned int i = 0; i < n_components; ++i)
          field.coefficient[i][a] += weight * coefficients[i * m() + s];
      });
    return field;
  }

  template <int dim, int n_components>
  std::vector<double>
  Condensation<dim, n_components>::condense(
    const std::array<double, n_dofs> &forces, const bool magnitudes) const
  {
    // This is r̃ = Cᵀ r of doc/theory.md (3.5). Sums of magnitudes must not
    // cancel, so they take |C|.
    std::vector<double> result(n_components * m(), 0.);
    for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
      for_each_weight(a, [&](const unsigned int s, const double weight) {
        for (unsigned int i = 0; i < n_components; ++i)
          result[i * m() + s] += (magnitudes ? std::abs(weight) : weight) *
                                 forces[i * BSpline<dim>::n + a];
      });
    return result;
  }

  template <int dim, int n_components>
  void
  Condensation<dim, n_components>::times_rows(const std::vector<double> &X,
                                              const unsigned int   n_columns,
                                              std::vector<double> &result) const
  {
    // Each row of X is added to the m rows of the result with its weight. The
    // innermost loop runs over the contiguous columns.
    result.assign(n_components * m() * n_columns, 0.);
    for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
      for_each_weight(a, [&](const unsigned int s, const double weight) {
        for (unsigned int i = 0; i < n_components; ++i)
          {
            const double *const source =
              &X[(i * BSpline<dim>::n + a) * n_columns];
            double *const target = &result[(i * m() + s) * n_columns];
            for (unsigned int c = 0; c < n_columns; ++c)
              target[c] += weight * source[c];
          }
      });
  }

  template <int dim, int n_components>
  const std::vector<double> &
  Condensation<dim, n_components>::condense(const std::vector<double> &matrix,
                                            Work &work) const
  {
    if (grid_cell.weights.empty())
      return matrix;
    // K̃ = Cᵀ K C of doc/theory.md (3.5) is (Cᵀ (Cᵀ K)ᵀ)ᵀ: written so, both
    // products run over contiguous rows, and one function does both.
    times_rows(matrix, n_dofs, work.product);
    transpose(work.product, n_components * m(), n_dofs, work.transposed);
    times_rows(work.transposed, n_components * m(), work.product);
    transpose(work.product,
              n_components * m(),
              n_components * m(),
              work.transposed);
    return work.transposed;
  }

  template class Condensation<2, 1>;
  template class Condensation<2, 2>;
  template class Condensation<2, 3>;
  template class Condensation<3, 1>;
  template class Condensation<3, 2>;
  template class Condensation<3, 3>;
} // namespace Morula
