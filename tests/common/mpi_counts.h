// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_common_mpi_counts_h
#define morula_tests_common_mpi_counts_h

#include <mpi.h>

namespace Morula
{
  /** Collective calls of this rank since it has begun. */
  struct MpiCounts
  {
    unsigned int reductions = 0, barriers = 0, others = 0;
  };

  inline MpiCounts mpi_counts;
} // namespace Morula

// PETSc counts these calls with macros of the same names.
#undef MPI_Allreduce
#undef MPI_Barrier
#undef MPI_Ibarrier
#undef MPI_Bcast
#undef MPI_Allgather

// MPI's profiling interface: these stand in front of the library's own, also
// for what deal.II and Trilinos call. Include this in one file of a room only.
extern "C" {
int
MPI_Allreduce(const void  *sent,
              void        *received,
              int          n,
              MPI_Datatype type,
              MPI_Op       operation,
              MPI_Comm     comm)
{
  ++Morula::mpi_counts.reductions;
  return PMPI_Allreduce(sent, received, n, type, operation, comm);
}

int
MPI_Barrier(MPI_Comm comm)
{
  ++Morula::mpi_counts.barriers;
  return PMPI_Barrier(comm);
}

int
MPI_Ibarrier(MPI_Comm comm, MPI_Request *request)
{
  ++Morula::mpi_counts.barriers;
  return PMPI_Ibarrier(comm, request);
}

int
MPI_Bcast(void *buffer, int n, MPI_Datatype type, int root, MPI_Comm comm)
{
  ++Morula::mpi_counts.others;
  return PMPI_Bcast(buffer, n, type, root, comm);
}

int
MPI_Allgather(const void  *sent,
              int          n_sent,
              MPI_Datatype sent_type,
              void        *received,
              int          n_received,
              MPI_Datatype received_type,
              MPI_Comm     comm)
{
  ++Morula::mpi_counts.others;
  return PMPI_Allgather(
    sent, n_sent, sent_type, received, n_received, received_type, comm);
}
}

#endif
