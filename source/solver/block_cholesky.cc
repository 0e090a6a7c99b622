// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/solver/block_cholesky.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace Morula
{
  namespace
  {
    /** Pivots of a matrix whose diagonal is scaled to 1: below this, single
     *  precision leaves only rounding of them. */
    constexpr float least_pivot = 1e-6f;
  } // namespace

  /** A column with all its blocks, at their places. */
  template <int n>
  class BlockCholesky<n>::Column
  {
  public:
    explicit Column(const int n_blocks)
      : blocks(n_blocks)
      , used(n_blocks, false)
    {}

    Block &
    operator[](const int row)
    {
      // The column stands as a full array of blocks, so that a block is found
      // without a search. The list of rows in use keeps the price of clear() at
      // the size of the column, not of the matrix.
      if (!used[row])
        {
          used[row]   = true;
          blocks[row] = Block();
          rows.push_back(row);
        }
      return blocks[row];
    }

    void
    clear()
    {
      for (const int row : rows)
        used[row] = false;
      rows.clear();
    }

    std::vector<int> rows; // in use

  private:
    std::vector<Block> blocks;
    std::vector<char>  used;
  };

  template <int n>
  BlockCholesky<n>::BlockCholesky(const int         n_rows,
                                  const Rows       &rows,
                                  const Parameters &parameters)
    : n_blocks(n_rows / n)
    , n_dropped(parameters.n_dropped / n)
    , scales(n_rows)
    , diagonal(n_blocks)
    , begins(1, 0)
    , firsts(n_blocks)
    , nexts(n_blocks, -1)
    , heads(n_blocks, -1)
  {
    // Crout's form makes the factor column by column: read column k of the
    // matrix, subtract what the finished columns contribute, factor the
    // diagonal's block, and keep the largest of the other blocks. A pivot that
    // is not positive ends it; the caller then asks for another factor.
    scale(rows, parameters);
    // keep() only appends, so room for all columns is taken at once.
    numbers.reserve(n_blocks * n_most);
    blocks.reserve(n_blocks * n_most);
    Column column(n_blocks);
    Row    row;
    for (int k = 0; k < n_blocks && positive_; ++k)
      {
        read(k, rows, row, column);
        eliminate(k, column);
        positive_ = invert_diagonal(k, column[k]);
        keep(k, column);
        column.clear();
      }
    // The lists of waiting columns are of no use once the factor stands.
    firsts = {};
    nexts = heads = {};
  }

  template <int n>
  void
  BlockCholesky<n>::scale(const Rows &rows, const Parameters &parameters)
  {
    // One pass over all rows finds the raised diagonal, whose inverse roots
    // scale the matrix to a unit diagonal, and counts the upper blocks. Their
    // mean per column is what the fill counts in: it does
    // not depend on how evenly the matrix is filled.
    Row         row;
    std::size_t n_above = 0; // blocks
    for (int k = 0; k < n_blocks; ++k)
      {
        double diagonal[n] = {};
        rows(k, row);
        for (std::size_t b = 0; b < row.columns.size(); ++b)
          if (row.columns[b] == k)
            for (int i = 0; i < n; ++i)
              diagonal[i] = row.values[(n * b + i) * n + i];
          else
            n_above += row.columns[b] > k;
        // The diagonal is raised so that the incomplete factor stays positive.
        for (int i = 0; i < n; ++i)
          {
            const double entry = parameters.relative_diagonal * diagonal[i] +
                                 parameters.absolute_diagonal;
            positive_         = positive_ && entry > 0.;
            scales[n * k + i] = entry > 0. ? 1. / std::sqrt(entry) : 1.;
          }
      }
    const double mean =
      parameters.mean_blocks.value_or(n_above / std::max(1., 1. * n_blocks));
    const auto at_most = [&](const double fill) {
      return std::min(std::ceil(fill * mean), 1. * n_blocks);
    };
    n_most            = at_most(parameters.fill);
    n_most_of_dropped = at_most(parameters.fill * parameters.fill_of_dropped);
  }

  template <int n>
  void
  BlockCholesky<n>::eliminate(const int k, Column &column)
  {
    // The columns j < k that reach row k are in k's list, each with firsts[j]
    // at its block in row k. Each subtracts its contribution; then it goes on
    // to the list of its next row. So no column searches for its place.
    for (int j = heads[k], next; j >= 0; j = next)
      {
        next = nexts[j];
        // L_kj is the block at firsts[j]. All products L_ij L_kjᵀ with i >= k
        // are subtracted.
        float factors[n][n];
        for (int c = 0; c < n; ++c)
          for (int m = 0; m < n; ++m)
            factors[c][m] = blocks[firsts[j]].column[m][c];
        for (std::size_t e = firsts[j]; e < begins[j + 1]; ++e)
          {
            Block       &target = column[numbers[e]];
            const Block &block  = blocks[e];
            for (int c = 0; c < n; ++c)
              for (int m = 0; m < n; ++m)
                target.column[c] -= block.column[m] * factors[c][m];
          }
        if (++firsts[j] < begins[j + 1])
          nexts[j] = std::exchange(heads[numbers[firsts[j]]], j);
      }
  }

  template <int n>
  bool
  BlockCholesky<n>::invert_diagonal(const int k, const Block &block)
  {
    // A dense Cholesky factorisation of the block on the diagonal. solve()
    // applies its inverse, so that is what is stored.
    float L[n][n] = {};
    for (int i = 0; i < n; ++i)
      for (int j = 0; j <= i; ++j)
        {
          float sum = block.column[j][i];
          for (int m = 0; m < j; ++m)
            sum -= L[i][m] * L[j][m];
          if (i != j)
            L[i][j] = sum / L[j][j];
          else if (sum > least_pivot)
            L[i][i] = std::sqrt(sum);
          else
            return false;
        }
    // Column c of the inverse is the solution of L x = e_c, by forward
    // substitution.
    diagonal[k] = Block();
    for (int c = 0; c < n; ++c)
      for (int i = c; i < n; ++i)
        {
          float sum = i == c ? 1.f : 0.f;
          for (int m = c; m < i; ++m)
            sum -= L[i][m] * diagonal[k].column[c][m];
          diagonal[k].column[c][i] = sum / L[i][i];
        }
    return true;
  }

  template <int n>
  void
  BlockCholesky<n>::keep(const int k, Column &column)
  {
    // The blocks are ranked by their Frobenius norm, and only the n_kept
    // largest stay: that limits memory and time however the matrix fills in.
    // What is left gets the diagonal's factor from the right, so that L_ik is
    // finished. Last, the column joins the list of the first row that it will
    // contribute to. Its blocks are in ascending order of rows: the lists in
    // eliminate() rely on that.
    std::vector<std::pair<float, int>> sizes; // negative: the largest first
    sizes.reserve(column.rows.size());
    for (const int row : column.rows)
      {
        Lane squares = {};
        for (const Lane &lane : column[row].column)
          squares += lane * lane;
        float sum = 0.f;
        for (int i = 0; i < n; ++i)
          sum += squares[i];
        if (row != k && sum > 0.f)
          sizes.emplace_back(-sum, row);
      }
    const std::size_t n_kept = k < n_dropped ? n_most_of_dropped : n_most;
    if (sizes.size() > n_kept)
      {
        std::nth_element(sizes.begin(), sizes.begin() + n_kept, sizes.end());
        sizes.resize(n_kept);
      }
    for (const auto &[size, row] : sizes)
      numbers.push_back(row);
    std::sort(numbers.begin() + begins[k], numbers.end());

    // L_ik L_kkᵀ = A_ik gives L_ik = A_ik L_kk⁻ᵀ.
    const Block inverse = diagonal[k];
    for (std::size_t e = begins[k]; e < numbers.size(); ++e)
      {
        const Block &block = column[numbers[e]];
        blocks.emplace_back();
        for (int c = 0; c < n; ++c)
          for (int m = 0; m <= c; ++m)
            blocks.back().column[c] += block.column[m] * inverse.column[m][c];
      }
    firsts[k] = begins[k];
    begins.push_back(numbers.size());
    if (firsts[k] < begins[k + 1])
      nexts[k] = std::exchange(heads[numbers[firsts[k]]], k);
  }


  template <int n>
  void
  BlockCholesky<n>::solve(double *x) const
  {
    // x is scaled by a power of two near its largest entry: entries of
    // residuals may lie outside the range of single precision, and a power of
    // two costs no digits. Then come x scaled as the matrix is, L⁻¹, the cut to
    // rows that count (D_r of doc/theory.md (7.2)), L⁻ᵀ, and the scales again.
    // L is stored by columns: the forward pass spreads each finished block over
    // the rows below, the backward pass collects the rows below into each
    // block.
    double largest = 0.;
    for (int r = 0; r < n * n_blocks; ++r)
      largest = std::max(largest, std::abs(scales[r] * x[r]));
    if (!(largest > 0.))
      return;
    const double      unit = std::exp2(std::ilogb(largest));
    std::vector<Part> y(n_blocks);
    for (int k = 0; k < n_blocks; ++k)
      for (int i = 0; i < n; ++i)
        y[k].values[i] = scales[n * k + i] * x[n * k + i] / unit;

    for (int k = 0; k < n_blocks; ++k)
      {
        Lane z = {};
        for (int m = 0; m < n; ++m)
          z += diagonal[k].column[m] * y[k].values[m];
        y[k].values = z;
        for (std::size_t e = begins[k]; e < begins[k + 1]; ++e)
          {
            Lane &sum = y[numbers[e]].values;
            for (int m = 0; m < n; ++m)
              sum -= blocks[e].column[m] * z[m];
          }
      }
    // Rows of other ranks have served the own ones; their part of the result
    // belongs to those ranks.
    std::fill_n(y.begin(), n_dropped, Part());
    for (int k = n_blocks - 1; k >= 0; --k)
      {
        // The sums over rows stay in the lanes of a register until the loop
        // ends.
        Lane sums[n] = {};
        for (std::size_t e = begins[k]; e < begins[k + 1]; ++e)
          for (int m = 0; m < n; ++m)
            sums[m] += blocks[e].column[m] * y[numbers[e]].values;
        Lane z = y[k].values;
        for (int m = 0; m < n; ++m)
          for (int i = 0; i < n; ++i)
            z[m] -= sums[m][i];
        for (int m = 0; m < n; ++m)
          {
            float sum = 0.f;
            for (int i = m; i < n; ++i)
              sum += diagonal[k].column[m][i] * z[i];
            y[k].values[m] = sum;
          }
      }
    for (int k = 0; k < n_blocks; ++k)
      for (int i = 0; i < n; ++i)
        x[n * k + i] = unit * scales[n * k + i] * y[k].values[i];
  }

  template class BlockCholesky<1>;
  template class BlockCholesky<2>;
  template class BlockCholesky<3>;
} // namespace Morula
