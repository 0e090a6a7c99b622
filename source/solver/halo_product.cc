// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/solver/halo_product.h>

#include <deal.II/base/mpi.h>

#include <Epetra_CrsMatrix.h>

#include <algorithm>

namespace Morula
{
  HaloProduct::HaloProduct(const Matrix &K)
    : K(K)
    , columns(K.trilinos_matrix().ColMap())
    , n_own(K.locally_owned_range_indices().n_elements())
  {
    const MPI_Comm comm = K.get_mpi_communicator();
    if (Utilities::MPI::n_mpi_processes(comm) == 1)
      return;

    const IndexSet own = K.locally_owned_range_indices();
    IndexSet       others(own.size());
    for (int k = 0; k < columns.NumMyElements(); ++k)
      others.add_index(columns.GID(k));
    others.subtract_set(own);
    others.compress();
    halo.emplace(own, others, comm);
    for (int k = 0; k < columns.NumMyElements(); ++k)
      {
        const types::global_dof_index column = columns.GID(k);
        sources.push_back(own.is_element(column) ?
                            own.index_within_set(column) :
                            n_own + others.index_within_set(column));
      }
    gathered.resize(n_own + others.n_elements());
    values.resize(sources.size());
  }

  const HaloProduct::Matrix &
  HaloProduct::matrix() const
  {
    return K;
  }

  bool
  HaloProduct::is_of(const Matrix &other) const
  {
    // The map is shared with the matrix that it is of.
    return &other == &K &&
           columns.DataPtr() == other.trilinos_matrix().ColMap().DataPtr();
  }

  void
  HaloProduct::vmult(Vector &y, const Vector &x) const
  {
    if (!halo)
      {
        K.vmult(y, x);
        return;
      }
    std::copy_n(x.begin(), n_own, gathered.begin());
    halo->fetch(gathered.data(), gathered.data() + n_own);
    for (std::size_t k = 0; k < values.size(); ++k)
      values[k] = gathered[sources[k]];

    const Epetra_CrsMatrix &epetra = K.trilinos_matrix();
    double *const           result = y.trilinos_vector()[0];
    for (std::size_t row = 0; row < n_own; ++row)
      {
        int     length;
        double *entries;
        int    *ids;
        epetra.ExtractMyRowView(row, length, entries, ids);
        double sum = 0.;
        for (int k = 0; k < length; ++k)
          sum += entries[k] * values[ids[k]];
        result[row] = sum;
      }
  }
} // namespace Morula
