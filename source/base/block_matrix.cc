// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/block_matrix.h>

#include <deal.II/base/exceptions.h>
#include <deal.II/base/mpi.h>

#include <algorithm>

namespace Morula
{
  namespace
  {
    /** Calls action with n as a constant, so that loops over a block are
     *  unrolled. */
    template <typename Action>
    void
    with_constant(const unsigned int n, const Action &action)
    {
      switch (n)
        {
          case 1:
            return action(std::integral_constant<int, 1>());
          case 2:
            return action(std::integral_constant<int, 2>());
          default:
            AssertThrow(n == 3, ExcNotImplemented());
            return action(std::integral_constant<int, 3>());
        }
    }

    /** y += B x */
    template <int n>
    void
    add(const double *block, const double *x, double *y)
    {
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
          y[i] += block[n * i + j] * x[j];
    }

    /** y += Bᵀ x */
    template <int n>
    void
    add_transpose(const double *block, const double *x, double *y)
    {
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
          y[j] += block[n * i + j] * x[i];
    }
  } // namespace

  IndexSet
  unknowns_of(const IndexSet &splines, const unsigned int n)
  {
    IndexSet result(splines.size() * n);
    for (auto range = splines.begin_intervals();
         range != splines.end_intervals();
         ++range)
      result.add_range(*range->begin() * n, (range->last() + 1) * n);
    result.compress();
    return result;
  }

  void
  BlockMatrix::reinit(const IndexSet             &own,
                      const std::vector<Columns> &columns,
                      const unsigned int          n,
                      const bool                  symmetric,
                      const MPI_Comm              comm)
  {
    // The columns of other ranks come first, since the numbers of columns
    // count them behind the own ones. Then each row's columns are numbered,
    // sorted and made unique. Only the pattern is new: the memory of the
    // entries is kept, if it is large enough.
    this->n         = n;
    this->symmetric = symmetric;
    this->comm      = comm;
    own_            = own;
    std::vector<types::global_dof_index> foreign;
    for (const Columns &row : columns)
      for (const auto spline : row)
        if (!own_.is_element(spline))
          foreign.push_back(spline);
    std::sort(foreign.begin(), foreign.end());
    others_ = IndexSet(own_.size());
    others_.add_indices(foreign.begin(), foreign.end());
    others_.compress();

    const int n_own = own_.n_elements();
    columns_.clear();
    begins.assign(1, 0);
    ends_of_own.clear();
    for (int row = 0; row < n_own; ++row)
      {
        columns_.push_back(row); // the diagonal
        for (const auto spline : columns[row])
          if (const int column = column_of(spline); !symmetric || column > row)
            columns_.push_back(column);
        const auto begin = columns_.begin() + begins.back();
        std::sort(begin, columns_.end());
        columns_.erase(std::unique(begin, columns_.end()), columns_.end());
        ends_of_own.push_back(std::lower_bound(begin, columns_.end(), n_own) -
                              columns_.begin());
        begins.push_back(columns_.size());
      }
    values.assign(columns_.size() * n * n, 0.);

    // On one rank x can be read where it stands, and nothing is exchanged.
    halo.reset();
    if (Utilities::MPI::n_mpi_processes(comm) == 1)
      return;
    halo = std::make_shared<const Halo>(unknowns_of(own_, n),
                                        unknowns_of(others_, n),
                                        comm);
    by_column.resize(n * (n_own + others_.n_elements()));
  }

  void
  BlockMatrix::clear()
  {
    std::fill(values.begin(), values.end(), 0.);
  }

  void
  BlockMatrix::vmult(Vector &y, const Vector &x) const
  {
    const double *columns_of_x = x.begin();
    if (halo)
      {
        // The own entries are copied in front of those that come from
        // neighbours: a product wants all of them in one array.
        std::copy_n(x.begin(), n * own_.n_elements(), by_column.begin());
        halo->fetch(by_column.data(), by_column.data() + n * own_.n_elements());
        columns_of_x = by_column.data();
      }
    with_constant(n, [&](const auto size) {
      multiply<size.value>(y.begin(), columns_of_x);
    });
  }

  template <int size>
  void
  BlockMatrix::multiply(double *y, const double *x) const
  {
    // Each block above the diagonal is read once, and used for its row and,
    // transposed, for its column: the product is bound by memory. Blocks
    // with columns of other ranks are used once, since those ranks have
    // their transposes in rows of their own.
    const int n_rows = own_.n_elements();
    std::fill_n(y, size * n_rows, 0.);
    for (int k = 0; k < n_rows; ++k)
      {
        double x_of_row[size], sums[size] = {}; // in registers
        std::copy_n(x + size * k, size, x_of_row);
        std::size_t b = begins[k];
        if (symmetric)
          {
            add<size>(&values[size * size * b++], x_of_row, sums); // diagonal
            for (; b < ends_of_own[k]; ++b)
              {
                const double *const block = &values[size * size * b];
                add<size>(block, x + size * columns_[b], sums);
                add_transpose<size>(block, x_of_row, y + size * columns_[b]);
              }
          }
        for (; b < begins[k + 1]; ++b)
          add<size>(&values[size * size * b], x + size * columns_[b], sums);
        for (int i = 0; i < size; ++i)
          y[size * k + i] += sums[i];
      }
  }

  std::size_t
  BlockMatrix::find(const unsigned int row, const int column) const
  {
    return std::lower_bound(columns_.begin() + begins[row],
                            columns_.begin() + begins[row + 1],
                            column) -
           columns_.begin();
  }

  BlockMatrix::Vector
  BlockMatrix::diagonal(const Vector &like) const
  {
    Vector result(like);
    for (unsigned int row = 0; row < own_.n_elements(); ++row)
      for (unsigned int i = 0; i < n; ++i)
        result.local_element(n * row + i) =
          values[find(row, row) * n * n + (n + 1) * i];
    return result;
  }

  void
  BlockMatrix::add_to_diagonal(const double factor, const Vector &values)
  {
    for (unsigned int row = 0; row < own_.n_elements(); ++row)
      for (unsigned int i = 0; i < n; ++i)
        this->values[find(row, row) * n * n + (n + 1) * i] +=
          factor * values.local_element(n * row + i);
  }

  BlockMatrix
  BlockMatrix::symmetric_part() const
  {
    // Each block becomes the mean with its counterpart's transpose. That of an
    // own column is at hand; that of another rank's comes from there.
    struct Block
    {
      types::global_dof_index row, column;
      double                  entries[9];
    };
    std::vector<Columns> splines(own_.n_elements());
    for (unsigned int row = 0; row < splines.size(); ++row)
      for (const int column : columns(row))
        splines[row].push_back(spline_of(column));
    BlockMatrix result;
    result.reinit(own_, splines, n, true, comm);
    const auto add_half = [&](const unsigned int row,
                              const int          column,
                              const double      *block,
                              const bool         transpose) {
      double *target = &result.values[result.find(row, column) * n * n];
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
          *target++ += 0.5 * block[transpose ? n * j + i : n * i + j];
    };
    for (int row = 0; row < int(splines.size()); ++row)
      for (std::size_t b = begins[row]; b < begins[row + 1]; ++b)
        {
          const double *const block = &values[b * n * n];
          if (columns_[b] >= row)
            add_half(row, columns_[b], block, false);
          if (columns_[b] <= row)
            add_half(columns_[b], row, block, true);
        }
    if (halo)
      halo->fetch_lists<Block>(
        [&](const unsigned int unknown, std::vector<Block> &list) {
          const unsigned int row = unknown / n;
          for (std::size_t b = ends_of_own[row];
               unknown % n == 0 && b < begins[row + 1];
               ++b)
            {
              list.push_back({spline_of(row), spline_of(columns_[b]), {}});
              std::copy_n(&values[b * n * n], n * n, list.back().entries);
            }
        },
        n * n,
        [&](const std::vector<Block> &list) {
          for (const Block &block : list)
            if (own_.is_element(block.column))
              add_half(column_of(block.column),
                       column_of(block.row),
                       block.entries,
                       true);
        });
    return result;
  }

  double
  BlockMatrix::mean_blocks() const
  {
    std::size_t sum = columns_.size();
    for (unsigned int row = 0; symmetric && row < own_.n_elements(); ++row)
      sum += n_own_columns(row) - 1; // their transposes
    return 1. * sum / std::max<std::size_t>(1, own_.n_elements());
  }
} // namespace Morula
