// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/solver/preconditioner.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace Morula
{
  namespace
  {
    /** The columns of lower ranks that this rank's rows couple with. */
    IndexSet
    lower_columns(const BlockMatrix &K)
    {
      // A rank without rows has no lower columns.
      IndexSet result(K.own().size());
      if (K.own().n_elements() > 0)
        result.add_range(0, K.own().nth_index_in_set(0));
      return result & K.others();
    }

    /** An entry of a block on its way to another rank, with the spline of its
     *  column. In front of the blocks of a row stands one with their number. */
    struct Entry
    {
      int   spline;
      float value;
    };

    /** A column of a lower rank keeps this part of the blocks of an own column.
     *  With fewer the iterations increase (doc/performance.md, The linear
     *  solver). */
    constexpr double fill_of_others = 0.5;

    std::unique_ptr<IncompleteCholesky>
    make_factor(const unsigned int                    n_components,
                const int                             n_rows,
                const IncompleteCholesky::Rows       &rows,
                const IncompleteCholesky::Parameters &parameters)
    {
      switch (n_components)
        {
          case 2:
            return std::make_unique<BlockCholesky<2>>(n_rows, rows, parameters);
          case 3:
            return std::make_unique<BlockCholesky<3>>(n_rows, rows, parameters);
          default:
            AssertThrow(n_components == 1, ExcNotImplemented());
            return std::make_unique<BlockCholesky<1>>(n_rows, rows, parameters);
        }
    }
  } // namespace

  /** Rows of lower ranks, from the diagonal on: all that a symmetric block
   *  needs of them, as precise as its factor. */
  struct OverlappingCholesky::ReceivedRows
  {
    std::vector<std::size_t> begins;
    std::vector<int>         columns; // in the rank's block
    std::vector<float>       values;
  };

  OverlappingCholesky::OverlappingCholesky(const BlockMatrix &K,
                                           const Parameters  &parameters)
    // The block consists of the own rows and those of lower ranks in front of
    // them. The latter come by one exchange; then every rank factorises its
    // block alone.
    : others(lower_columns(K))
    , n_own(K.n_components() * K.own().n_elements())
    , n_others(K.n_components() * others.n_elements())
    , gathered(n_own + n_others)
  {
    if (Utilities::MPI::n_mpi_processes(K.communicator()) > 1)
      halo.emplace(unknowns_of(K.own(), K.n_components()),
                   unknowns_of(others, K.n_components()),
                   K.communicator());
    factorize(K, receive(K), parameters);
  }

  OverlappingCholesky::ReceivedRows
  OverlappingCholesky::receive(const BlockMatrix &K) const
  {
    // Lower ranks send the rows that this rank's block begins with, and this
    // rank sends its own to higher ones; both happen in fetch_lists(), which
    // asks for each unknown: a spline's row goes with its first one. A row
    // travels from its diagonal on, as splines and single precision values,
    // behind an entry with the number of its blocks. What arrives is translated
    // into numbers of the block at once, and columns outside of the block are
    // left out.
    ReceivedRows received;
    received.begins.push_back(0);
    if (!halo)
      return received;
    const unsigned int n = K.n_components(), size = n * n;
    const auto         append = [&](const unsigned int  unknown,
                            std::vector<Entry> &rows) {
      if (unknown % n != 0)
        return;
      const unsigned int row     = unknown / n;
      const auto         columns = K.columns(row);
      const double      *value   = K.blocks(row);
      const std::size_t  head    = rows.size();
      rows.push_back({0, 0.f});
      for (const int column : columns)
        {
          const int spline = K.spline_of(column);
          if (spline < int(K.spline_of(row)))
            value += size;
          else
            for (unsigned int k = 0; k < size; ++k)
              rows.push_back({spline, static_cast<float>(*value++)});
        }
      rows[head].spline = (rows.size() - head - 1) / size;
    };
    const auto take = [&](const std::vector<Entry> &rows) {
      for (auto entry = rows.begin(); entry != rows.end();)
        {
          const auto end = entry + 1 + entry->spline * size;
          for (++entry; entry != end; entry += size)
            {
              const bool is_own = K.own().is_element(entry->spline);
              if (!is_own && !others.is_element(entry->spline))
                continue;
              received.columns.push_back(
                is_own ? others.n_elements() +
                           K.own().index_within_set(entry->spline) :
                         others.index_within_set(entry->spline));
              for (unsigned int k = 0; k < size; ++k)
                received.values.push_back(entry[k].value);
            }
          received.begins.push_back(received.columns.size());
        }
    };
    halo->fetch_lists<Entry>(append, n * K.mean_blocks() / 2, take);
    return received;
  }

  void
  OverlappingCholesky::factorize(const BlockMatrix  &K,
                                 const ReceivedRows &received,
                                 const Parameters   &parameters)
  {
    // The factorisation reads rows of blocks through a function. Those of lower
    // ranks were received; of own ones, which are in the matrix, the columns of
    // higher ranks are not in the block, and those of lower ranks come before
    // the diagonal. The rows in front are those to be dropped in the solution:
    // D_r of doc/theory.md (7.2).
    const int  size   = K.n_components() * K.n_components();
    const int  first  = others.n_elements(); // own one
    const auto row_of = [&](const int row, IncompleteCholesky::Row &result) {
      if (row < first)
        {
          const auto begin = received.begins[row],
                     end   = received.begins[row + 1];
          result.columns.assign(received.columns.begin() + begin,
                                received.columns.begin() + end);
          result.values.assign(received.values.begin() + size * begin,
                               received.values.begin() + size * end);
          return;
        }
      const unsigned int n_columns = K.n_own_columns(row - first);
      const auto         columns   = K.columns(row - first);
      const double      *values    = K.blocks(row - first);
      result.columns.assign(columns.begin(), columns.begin() + n_columns);
      result.values.assign(values, values + size * n_columns);
      for (int &column : result.columns)
        column += first;
    };
    // The first rows of a block lack what lies outside of it. Counted from
    // these the factor of own rows would have so few blocks that it is barely
    // positive. So the fill counts in the mean of the own rows of the whole
    // matrix: half of the blocks beside the diagonal's.
    Parameters of_block      = parameters;
    of_block.n_dropped       = n_others;
    of_block.fill_of_dropped = fill_of_others;
    if (halo && n_own > 0)
      of_block.mean_blocks = 0.5 * (K.mean_blocks() - 1.);
    factor = make_factor(K.n_components(), gathered.size(), row_of, of_block);
  }

  void
  OverlappingCholesky::vmult(Vector &y, const Vector &x) const
  {
    if (!halo)
      {
        y = x;
        factor->solve(y.begin());
        return;
      }
    // An exchange before brings the entries of lower ranks, one after it adds
    // to them what this rank's part of the inverse has for them: R_rᵀ L_r⁻ᵀ D_r
    // L_r⁻¹ R_r of doc/theory.md (7.2).
    double *const of_own = gathered.data() + n_others;
    std::copy_n(x.begin(), n_own, of_own);
    halo->fetch(of_own, gathered.data());
    factor->solve(gathered.data());
    std::copy_n(of_own, n_own, y.begin());
    halo->add_back(gathered.data(), y.begin());
  }


  namespace
  {
    /**
     * Incomplete factorisations in the order in which they are tried. Fewer
     * blocks make them faster; the raised diagonal keeps them positive, and
     * usable for the later tangents of the step (doc/performance.md, The linear
     * solver). The first one is for a single component: coefficients of
     * splines that are far from each other hardly matter there. Free bodies do
     * without the last one: it excites motions that hardly anything resists,
     * such as the twist of a row of cells, by a thousand times what Jacobi
     * does.
     */
    struct Attempt
    {
      double fill, relative_diagonal;
    };
    constexpr Attempt attempts[] = {
      {0.5, 1.02}, {1.25, 1.02}, {1.5, 1.02}, {2., 1.02}, {2., 1.1}, {2., 1.5}};
    constexpr std::size_t first_of_vectors  = 1;
    constexpr std::size_t n_of_free_bodies  = 5;
    constexpr double      absolute_diagonal = 2e-5; // of a typical entry
  } // namespace

  Preconditioner::Preconditioner(const LinearProblem &problem)
    : problem(problem)
  {}

  void
  Preconditioner::make_next(const Matrix &K)
  {
    const BlockMatrix part =
      K.is_symmetric() ? BlockMatrix() : K.symmetric_part();
    const BlockMatrix &A = K.is_symmetric() ? K : part;
    factorisation_.reset();
    // Vectors leave the first factorisation out, free bodies the last one (see
    // attempts).
    if (A.n_components() > 1)
      n_tried = std::max(n_tried, first_of_vectors);
    const std::size_t n_usable =
      problem.null_space.empty() ? std::size(attempts) : n_of_free_bodies;
    for (; !factorisation_ && n_tried < n_usable; ++n_tried)
      {
        OverlappingCholesky::Parameters parameters;
        parameters.fill              = attempts[n_tried].fill;
        parameters.relative_diagonal = attempts[n_tried].relative_diagonal;
        parameters.absolute_diagonal =
          absolute_diagonal * problem.typical_entry;
        auto made = std::make_unique<OverlappingCholesky>(A, parameters);
        // Each rank knows of its own block only. All of them use the
        // factorisation, or none does.
        const bool failed = !made->is_positive(); // on this rank
        if (!Utilities::MPI::logical_or(failed, K.communicator()))
          factorisation_ = std::move(made);
      }
  }

  Equilibrium::Vector
  diagonal_magnitude(const Equilibrium::Matrix &K,
                     const Equilibrium::Vector &like)
  {
    Equilibrium::Vector diagonal = K.diagonal(like);
    for (double &entry : diagonal)
      entry = std::abs(entry);
    return diagonal;
  }

  DiagonalMatrix<Equilibrium::Vector>
  jacobi(const Equilibrium::Vector &magnitude, const double shift)
  {
    Equilibrium::Vector inverse(magnitude);
    for (double &entry : inverse)
      entry = entry > 0. ? 1. / ((1. + shift) * entry) : 1.;
    return DiagonalMatrix<Equilibrium::Vector>(inverse);
  }
} // namespace Morula
