// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/solver/block_product.h>

namespace Morula
{
  BlockProduct::BlockProduct(const Epetra_CrsMatrix &K, const unsigned int n)
    : n(n)
    , exists_(n > 1 && K.NumMyRows() % n == 0)
  {
    for (int row = 0; exists_ && row < K.NumMyRows(); row += n)
      exists_ = read(K, row);
  }

  bool
  BlockProduct::exists() const
  {
    return exists_;
  }

  bool
  BlockProduct::read(const Epetra_CrsMatrix &K, const int first_row)
  {
    int     length_of_all = 0;
    double *entries;
    int    *ids;
    for (unsigned int i = 0; i < n; ++i)
      {
        int length;
        K.ExtractMyRowView(first_row + i, length, entries, ids);
        rows.push_back(entries);
        if (i == 0)
          {
            length_of_all = length;
            for (int k = 0; k < length; k += n)
              columns.push_back(ids[k]);
            ends.push_back(columns.size());
          }
        if (length != length_of_all || length % n != 0)
          return false;
        const int *column = columns.data() + columns.size() - length / n;
        for (int k = 0; k < length; ++k)
          if (ids[k] != column[k / n] + static_cast<int>(k % n))
            return false;
      }
    return true;
  }

  template <unsigned int n_components>
  void
  BlockProduct::multiply(double *y, const double *x) const
  {
    constexpr unsigned int n     = n_components;
    std::size_t            begin = 0;
    for (std::size_t r = 0; r < ends.size(); ++r)
      {
        const std::size_t n_blocks = ends[r] - begin;
        const int *const  column   = columns.data() + begin;
        // One sum for each entry of a block: additions need not wait for each
        // other.
        double        sums[n][n] = {};
        const double *row[n];
        for (unsigned int i = 0; i < n; ++i)
          row[i] = rows[r * n + i];
        for (std::size_t b = 0; b < n_blocks; ++b)
          for (unsigned int i = 0; i < n; ++i)
            for (unsigned int j = 0; j < n; ++j)
              sums[i][j] += row[i][b * n + j] * x[column[b] + j];
        for (unsigned int i = 0; i < n; ++i)
          {
            y[r * n + i] = sums[i][0];
            for (unsigned int j = 1; j < n; ++j)
              y[r * n + i] += sums[i][j];
          }
        begin = ends[r];
      }
  }

  void
  BlockProduct::vmult(double *y, const double *x) const
  {
    if (n == 3)
      multiply<3>(y, x);
    else
      multiply<2>(y, x);
  }
} // namespace Morula
