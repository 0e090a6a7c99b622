// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/solver/overlapping_cholesky.h>

#include <vector>

namespace Morula
{
  namespace
  {
    /** Own rows, then the others. */
    Epetra_Map
    block_map(const OverlappingCholesky::Matrix &K, IndexSet others)
    {
      const IndexSet own = K.locally_owned_range_indices();
      others.subtract_set(own);
      std::vector<int> rows;
      for (const IndexSet &part : {own, others})
        for (const auto row : part)
          rows.push_back(static_cast<int>(row));
      return Epetra_Map(
        -1, rows.size(), rows.data(), 0, K.trilinos_matrix().Comm());
    }

    /** Entries of a block on and above the diagonal, row by row: Ifpack reads
     *  no others. */
    struct Triangle
    {
      std::vector<int>    lengths, columns;
      std::vector<double> values;
    };

    /** The rows are those of K on this rank, then the received ones. */
    Triangle
    upper_triangle(const Epetra_CrsMatrix &K,
                   const Epetra_CrsMatrix &received,
                   const Epetra_Map       &rows)
    {
      // Tables, as to ask the map for each entry takes longer than the rest.
      const int        n_own = K.NumMyRows(), n = rows.NumMyElements();
      std::vector<int> numbers(K.NumGlobalRows(), -1);
      for (int k = 0; k < n; ++k)
        numbers[rows.GID(k)] = k;
      std::vector<int> numbers_of_columns(K.NumMyCols());
      for (int k = 0; k < K.NumMyCols(); ++k)
        numbers_of_columns[k] = numbers[K.GCID(k)];

      Triangle          result;
      const std::size_t n_most = K.NumMyNonzeros() + received.NumMyNonzeros();
      result.columns.reserve(n_most);
      result.values.reserve(n_most);
      for (int row = 0; row < n; ++row)
        {
          const std::size_t begin = result.columns.size();
          const bool        own   = row < n_own;
          int               length, *ids;
          double           *entries;
          if (own)
            K.ExtractMyRowView(row, length, entries, ids);
          else
            received.ExtractGlobalRowView(rows.GID(row), length, entries, ids);
          for (int k = 0; k < length; ++k)
            {
              const int column = (own ? numbers_of_columns : numbers)[ids[k]];
              if (column >= row)
                {
                  result.columns.push_back(column);
                  result.values.push_back(entries[k]);
                }
            }
          result.lengths.push_back(result.columns.size() - begin);
        }
      return result;
    }
  } // namespace

  OverlappingCholesky::OverlappingCholesky(const Matrix     &K,
                                           const IndexSet   &others,
                                           const Parameters &parameters)
    : rows(block_map(K, others))
    , import(rows, K.trilinos_matrix().RowMap())
    , self(MPI_COMM_SELF)
    , local(rows.NumMyElements(), 0, self)
    , gathered(rows)
  {
    if (rows.Comm().NumProc() > 1)
      block = block_of(K.trilinos_matrix());
    factorize(block ? *block : K.trilinos_matrix(), parameters);
  }

  std::unique_ptr<Epetra_CrsMatrix>
  OverlappingCholesky::block_of(const Epetra_CrsMatrix &K) const
  {
    const int        n_own = K.NumMyRows(), n = rows.NumMyElements();
    const Epetra_Map others(
      -1, n - n_own, rows.MyGlobalElements() + n_own, 0, rows.Comm());
    Epetra_CrsMatrix received(Copy, others, 0);
    int error = received.Import(K, Epetra_Import(others, K.RowMap()), Insert);
    AssertThrow(error == 0, ExcTrilinosError(error));

    // All rows are inserted at once: one by one takes three times as long.
    const Triangle triangle = upper_triangle(K, received, rows);
    auto           result   = std::make_unique<Epetra_CrsMatrix>(
      Copy, local, local, triangle.lengths.data(), true);
    for (int row = 0, begin = 0; row < n; begin += triangle.lengths[row++])
      result->InsertMyValues(row,
                             triangle.lengths[row],
                             &triangle.values[begin],
                             &triangle.columns[begin]);
    error = result->FillComplete();
    AssertThrow(error == 0, ExcTrilinosError(error));
    return result;
  }

  void
  OverlappingCholesky::factorize(const Epetra_CrsMatrix &A,
                                 const Parameters       &parameters)
  {
    // Ifpack only reads the matrix.
    factor = std::make_unique<Ifpack_IC>(const_cast<Epetra_CrsMatrix *>(&A));
    Teuchos::ParameterList list;
    list.set("fact: ict level-of-fill", parameters.fill);
    list.set("fact: relative threshold", parameters.relative_diagonal);
    list.set("fact: absolute threshold", parameters.absolute_diagonal);
    factor->SetParameters(list);
    int error = factor->Initialize();
    AssertThrow(error == 0, ExcTrilinosError(error));
    error = factor->Compute();
    AssertThrow(error == 0, ExcTrilinosError(error));
  }

  bool
  OverlappingCholesky::is_positive() const
  {
    const Epetra_Vector &inverse_pivots = factor->D();
    for (int k = 0; k < inverse_pivots.MyLength(); ++k)
      if (!(inverse_pivots[k] > 0.))
        return false;
    return true;
  }

  void
  OverlappingCholesky::vmult(Vector &y, const Vector &x) const
  {
    if (!block)
      {
        factor->ApplyInverse(x.trilinos_vector(), y.trilinos_vector());
        return;
      }
    gathered.Import(x.trilinos_vector(), import, Insert);
    Epetra_Vector view(View, local, gathered.Values());
    factor->ApplyInverse(view, view);
    y.trilinos_vector().PutScalar(0.);
    y.trilinos_vector().Export(gathered, import, Add);
  }
} // namespace Morula
