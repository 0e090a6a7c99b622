// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/solver/preconditioner.h>

#include <deal.II/base/mpi.h>

#include <EpetraExt_MatrixMatrix.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace Morula
{
  namespace
  {
    /** The columns of lower ranks that this rank's rows couple with, as
     *  unknowns. */
    IndexSet
    lower_columns(const Epetra_CrsMatrix &K, const IndexSet &own)
    {
      std::vector<types::global_dof_index> columns;
      for (int k = 0; k < K.NumMyCols(); ++k)
        // A rank without rows has no lower columns.
        if (const types::global_dof_index column = K.GCID(k);
            own.n_elements() > 0 && column < own.nth_index_in_set(0))
          columns.push_back(column);
      std::sort(columns.begin(), columns.end());
      IndexSet result(own.size());
      result.add_indices(columns.begin(), columns.end());
      result.compress();
      return result;
    }

    /** An entry of a row on its way to another rank. In front of a row's
     *  entries stands one with their number. */
    struct Entry
    {
      int   column;
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
      AssertThrow(n_rows % n_components == 0, ExcInternalError());
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
    std::vector<int>         columns; // in the block
    std::vector<float>       values;
  };

  OverlappingCholesky::OverlappingCholesky(const Matrix      &K,
                                           const unsigned int n_components,
                                           const Parameters  &parameters)
    : own(K.locally_owned_range_indices())
    // The block consists of the own rows and those of lower ranks in front of
    // them. The latter come by one exchange; then every rank factorises its
    // block alone.
    , others(lower_columns(K.trilinos_matrix(), own))
    , gathered(own.n_elements() + others.n_elements())
  {
    if (Utilities::MPI::n_mpi_processes(K.get_mpi_communicator()) > 1)
      halo.emplace(own, others, K.get_mpi_communicator());
    factorize(K.trilinos_matrix(),
              receive(K.trilinos_matrix(), n_components),
              n_components,
              parameters);
  }

  OverlappingCholesky::ReceivedRows
  OverlappingCholesky::receive(const Epetra_CrsMatrix &K,
                               const unsigned int      n_components) const
  {
    // Lower ranks send the rows that this rank's block begins with, and this
    // rank sends its own to higher ones; both happen in fetch_lists(). A row
    // travels from its diagonal on, as global columns and single precision
    // values, behind an entry with its length. What arrives is translated into
    // numbers of the block at once, and columns outside of the block are left
    // out.
    ReceivedRows received;
    received.begins.push_back(0);
    if (!halo)
      return received;
    const std::size_t length_of_row = K.MaxNumEntries() / 2; // at most, about
    received.columns.reserve(others.n_elements() * length_of_row);
    received.values.reserve(others.n_elements() * length_of_row);
    const int *const global_columns = K.ColMap().MyGlobalElements();
    const auto append = [&](const unsigned int row, std::vector<Entry> &rows) {
      int     length, *ids;
      double *entries;
      K.ExtractMyRowView(row, length, entries, ids);
      const int         first = K.GRID(row);
      const std::size_t head  = rows.size();
      rows.push_back({0, 0.f});
      for (int k = 0; k < length; ++k)
        if (const int column = global_columns[ids[k]]; column >= first)
          rows.push_back({column, static_cast<float>(entries[k])});
      rows[head].column = rows.size() - head - 1;
    };
    const auto take = [&](const std::vector<Entry> &rows) {
      for (auto entry = rows.begin(); entry != rows.end();)
        {
          const auto end  = entry + 1 + entry->column;
          int        last = -1, column = -1; // the same one, in the block
          for (++entry; entry != end; last = (entry++)->column)
            {
              // All unknowns of a spline are in the block, or none of them is.
              // So the search is made for the first one, and the others follow
              // it.
              if (entry->column != last + 1 ||
                  entry->column % n_components == 0)
                column = number_of(entry->column);
              else if (column >= 0)
                ++column;
              if (column < 0)
                continue;
              received.columns.push_back(column);
              received.values.push_back(entry->value);
            }
          received.begins.push_back(received.columns.size());
        }
    };
    halo->fetch_lists<Entry>(append, length_of_row, take);
    return received;
  }

  void
  OverlappingCholesky::factorize(const Epetra_CrsMatrix &K,
                                 const ReceivedRows     &received,
                                 const unsigned int      n_components,
                                 const Parameters       &parameters)
  {
    // The factorisation reads rows through a function. Rows of lower ranks were
    // received, own ones are in the matrix. Both are symmetric, and are given
    // from the diagonal's block on. The rows in front are those to be dropped
    // in the solution: D_r of doc/theory.md (7.2).
    const int        n_others = others.n_elements();
    std::vector<int> numbers(K.NumMyCols()); // of the matrix's columns
    for (int k = 0; k < K.NumMyCols(); ++k)
      numbers[k] = number_of(K.GCID(k));

    const auto row_of = [&](const int row, IncompleteCholesky::Row &result) {
      result.columns.clear();
      result.values.clear();
      if (row < n_others)
        {
          const auto begin = received.begins[row],
                     end   = received.begins[row + 1];
          result.columns.assign(received.columns.begin() + begin,
                                received.columns.begin() + end);
          result.values.assign(received.values.begin() + begin,
                               received.values.begin() + end);
          return;
        }
      const int first = row - row % n_components; // of the diagonal's block
      int       length, *ids;
      double   *entries;
      K.ExtractMyRowView(row - n_others, length, entries, ids);
      for (int k = 0; k < length; ++k)
        if (const int column = numbers[ids[k]]; column >= first)
          {
            result.columns.push_back(column);
            result.values.push_back(entries[k]);
          }
    };
    // The first rows of a block lack what lies outside of it. Counted from
    // these the factor of own rows would have so few blocks that it is barely
    // positive. So the fill counts in the mean of the own rows of the whole
    // matrix: half of the blocks beside the diagonal's.
    Parameters of_block      = parameters;
    of_block.n_dropped       = n_others;
    of_block.fill_of_dropped = fill_of_others;
    if (halo && own.n_elements() > 0)
      of_block.mean_blocks =
        0.5 * (1. * K.NumMyNonzeros() / (n_components * own.n_elements()) - 1.);
    factor = make_factor(n_components, gathered.size(), row_of, of_block);
  }

  void
  OverlappingCholesky::vmult(Vector &y, const Vector &x) const
  {
    if (!halo)
      {
        y = x;
        factor->solve(y.trilinos_vector()[0]);
        return;
      }
    // An exchange before brings the entries of lower ranks, one after it adds
    // to them what this rank's part of the inverse has for them: R_rᵀ L_r⁻ᵀ D_r
    // L_r⁻¹ R_r of doc/theory.md (7.2).
    const std::size_t n_own    = own.n_elements();
    const std::size_t n_others = others.n_elements();
    double *const     of_own   = gathered.data() + n_others;
    double *const     result   = y.trilinos_vector()[0];
    std::copy_n(x.begin(), n_own, of_own);
    halo->fetch(of_own, gathered.data());
    factor->solve(gathered.data());
    std::copy_n(of_own, n_own, result);
    halo->add_back(gathered.data(), result);
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

    /** Makes @p result (K + Kᵀ)/2. */
    void
    symmetrize(const Equilibrium::Matrix &K, Equilibrium::Matrix &result)
    {
      Epetra_CrsMatrix *sum   = nullptr; // made by the next line
      const int         error = EpetraExt::MatrixMatrix::Add(
        K.trilinos_matrix(), false, 0.5, K.trilinos_matrix(), true, 0.5, sum);
      const std::unique_ptr<Epetra_CrsMatrix> owner(sum);
      AssertThrow(error == 0 && sum->FillComplete() == 0, ExcInternalError());
      result.reinit(*sum);
    }
  } // namespace

  Preconditioner::Preconditioner(const LinearProblem &problem)
    : problem(problem)
    , n_tried(problem.n_components > 1 ? first_of_vectors : 0)
  {}

  void
  Preconditioner::make_next(const Matrix &K)
  {
    if (!problem.symmetric)
      symmetrize(K, symmetric_part);
    const Matrix &A = problem.symmetric ? K : symmetric_part;
    factorisation_.reset();
    // Free bodies leave the last factorisation out (see attempts).
    const std::size_t n_usable =
      problem.null_space.empty() ? std::size(attempts) : n_of_free_bodies;
    for (; !factorisation_ && n_tried < n_usable; ++n_tried)
      {
        OverlappingCholesky::Parameters parameters;
        parameters.fill              = attempts[n_tried].fill;
        parameters.relative_diagonal = attempts[n_tried].relative_diagonal;
        parameters.absolute_diagonal =
          absolute_diagonal * problem.typical_entry;
        auto made = std::make_unique<OverlappingCholesky>(A,
                                                          problem.n_components,
                                                          parameters);
        // Each rank knows of its own block only. All of them use the
        // factorisation, or none does.
        const bool failed = !made->is_positive(); // on this rank
        if (!Utilities::MPI::logical_or(failed, K.get_mpi_communicator()))
          factorisation_ = std::move(made);
      }
  }

  Equilibrium::Vector
  diagonal_magnitude(const Equilibrium::Matrix &K,
                     const Equilibrium::Vector &like)
  {
    Equilibrium::Vector diagonal(like);
    for (const auto row : diagonal.locally_owned_elements())
      diagonal(row) = std::abs(K.diag_element(row));
    diagonal.compress(VectorOperation::insert);
    return diagonal;
  }


} // namespace Morula
