// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/solver/overlapping_cholesky.h>

#include <Epetra_Import.h>
#include <Epetra_Map.h>

#include <algorithm>
#include <vector>

namespace Morula
{
  namespace
  {
    IndexSet
    difference(IndexSet all, const IndexSet &part)
    {
      all.subtract_set(part);
      return all;
    }

    Epetra_Map
    map_of(const IndexSet &set, const Epetra_Comm &comm)
    {
      std::vector<int> rows;
      for (const auto row : set)
        rows.push_back(static_cast<int>(row));
      return Epetra_Map(-1, rows.size(), rows.data(), 0, comm);
    }

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

  OverlappingCholesky::OverlappingCholesky(const Matrix      &K,
                                           const IndexSet    &others,
                                           const unsigned int n_components,
                                           const Parameters  &parameters)
    : own(K.locally_owned_range_indices())
    , others(difference(others, own))
    , gathered(own.n_elements() + this->others.n_elements())
  {
    const Epetra_CrsMatrix &epetra = K.trilinos_matrix();
    const Epetra_Map        map    = map_of(this->others, epetra.Comm());
    Epetra_CrsMatrix        received(Copy, map, 0);
    if (epetra.Comm().NumProc() > 1)
      {
        halo.emplace(own, this->others, K.get_mpi_communicator());
        const int error =
          received.Import(epetra, Epetra_Import(map, epetra.RowMap()), Insert);
        AssertThrow(error == 0, ExcTrilinosError(error));
      }
    factorize(epetra, received, n_components, parameters);
  }

  void
  OverlappingCholesky::factorize(const Epetra_CrsMatrix &K,
                                 const Epetra_CrsMatrix &received,
                                 const unsigned int      n_components,
                                 const Parameters       &parameters)
  {
    const int  n_own     = own.n_elements();
    const auto number_of = [&](const types::global_dof_index row) {
      if (own.is_element(row))
        return static_cast<int>(own.index_within_set(row));
      return others.is_element(row) ?
               n_own + static_cast<int>(others.index_within_set(row)) :
               -1;
    };
    std::vector<int> numbers(K.NumMyCols()); // of the matrix's columns
    for (int k = 0; k < K.NumMyCols(); ++k)
      numbers[k] = number_of(K.GCID(k));

    const auto row_of = [&](const int row, IncompleteCholesky::Row &result) {
      result.columns.clear();
      result.values.clear();
      const bool is_own = row < n_own;
      int        length, *ids;
      double    *entries;
      if (is_own)
        K.ExtractMyRowView(row, length, entries, ids);
      else
        received.ExtractGlobalRowView(others.nth_index_in_set(row - n_own),
                                      length,
                                      entries,
                                      ids);
      for (int k = 0; k < length; ++k)
        {
          const int column = is_own ? numbers[ids[k]] : number_of(ids[k]);
          if (column >= 0)
            {
              result.columns.push_back(column);
              result.values.push_back(entries[k]);
            }
        }
    };
    factor = make_factor(n_components, gathered.size(), row_of, parameters);
  }

  bool
  OverlappingCholesky::is_positive() const
  {
    return factor->is_positive();
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
    const std::size_t n_own  = own.n_elements();
    double *const     result = y.trilinos_vector()[0];
    std::copy_n(x.begin(), n_own, gathered.begin());
    halo->fetch(gathered.data(), gathered.data() + n_own);
    factor->solve(gathered.data());
    std::copy_n(gathered.begin(), n_own, result);
    halo->add_back(gathered.data() + n_own, result);
  }
} // namespace Morula
