// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_halo_h
#define morula_base_halo_h

#include <deal.II/base/partitioner.h>

#include <vector>

namespace Morula
{
  using namespace dealii;

  /**
   * The entries of a distributed vector that a rank needs besides its own. They
   * come and go by messages between neighbours alone. Epetra's Import has a
   * barrier of all ranks in front of each exchange (Epetra_MpiDistributor sends
   * to receivers that must be ready) and compares maps by a reduction;
   * deal.II's Partitioner has neither.
   */
  class Halo
  {
  public:
    /** Collective.
     *  @param own    an interval; those of all ranks follow each other
     *  @param others of other ranks */
    Halo(const IndexSet &own, const IndexSet &others, const MPI_Comm comm);

    /** Puts the other ranks' entries into @p others, in the order of their
     *  numbers. Neighbours have to do the same. */
    void
    fetch(const double *own, double *others) const;

    /** The transpose: adds @p others to the entries of the ranks that own them,
     *  and clears them. */
    void
    add_back(double *others, double *own) const;

  private:
    Utilities::MPI::Partitioner partitioner;
    mutable std::vector<double> buffer; // of the messages
  };
} // namespace Morula

#endif
