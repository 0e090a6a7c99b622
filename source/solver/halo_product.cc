// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/solver/halo_product.h>

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace Morula
{
  HaloProduct::HaloProduct(const Matrix      &K,
                           const unsigned int n_components,
                           const bool         symmetric)
    : K(K)
    , columns(K.trilinos_matrix().ColMap())
    , n_own(K.locally_owned_range_indices().n_elements())
  {
    // The columns of other ranks stand in Epetra's order behind the own ones.
    // An IndexSet has them in ascending order, as the halo brings them; `order`
    // translates.
    const IndexSet own = K.locally_owned_range_indices();
    IndexSet       others(own.size());
    for (int k = n_own; k < columns.NumMyElements(); ++k)
      others.add_index(columns.GID(k));
    others.compress();
    std::vector<int> order;
    for (int k = n_own; k < columns.NumMyElements(); ++k)
      order.push_back(others.index_within_set(columns.GID(k)));
    rows = BlockRows::make(K.trilinos_matrix(), order, n_components, symmetric);

    const MPI_Comm comm = K.get_mpi_communicator();
    // On one rank x can be read where it stands, and nothing is exchanged.
    if (Utilities::MPI::n_mpi_processes(comm) == 1)
      return;
    halo.emplace(own, others, comm);
    by_column.resize(columns.NumMyElements());
  }

  bool
  HaloProduct::is_of(const Matrix &other) const
  {
    // A matrix at the same address may have got another pattern since. Its map
    // tells: it is shared with the matrix that it belongs to.
    return &other == &K &&
           columns.DataPtr() == other.trilinos_matrix().ColMap().DataPtr();
  }

  void
  HaloProduct::read()
  {
    rows->read(K.trilinos_matrix());
  }

  void
  HaloProduct::vmult(Vector &y, const Vector &x) const
  {
    const double *columns_of_x = x.begin();
    if (halo)
      {
        // The own entries are copied in front of those that come from
        // neighbours: BlockRows wants all of them in one array.
        std::copy_n(x.begin(), n_own, by_column.begin());
        halo->fetch(by_column.data(), by_column.data() + n_own);
        columns_of_x = by_column.data();
      }
    rows->vmult(y.trilinos_vector()[0], columns_of_x);
  }
} // namespace Morula
