// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_send_records_h
#define morula_base_send_records_h

#include <deal.II/base/mpi.templates.h>

#include <cstring>
#include <map>
#include <numeric>
#include <type_traits>
#include <vector>

namespace Morula
{
  namespace Bytes
  {
    /** The bytes of some records. deal.II would demand a serialize() of each
     *  type of record, though it copies only bytes, too. */
    template <typename Record>
    std::vector<char>
    of(const std::vector<Record> &records)
    {
      static_assert(std::is_trivially_copyable<Record>::value);
      std::vector<char> bytes(records.size() * sizeof(Record));
      if (!records.empty())
        std::memcpy(bytes.data(), records.data(), bytes.size());
      return bytes;
    }

    /** Inverse of of(). */
    template <typename Record>
    std::vector<Record>
    records(const std::vector<char> &bytes)
    {
      std::vector<Record> list(bytes.size() / sizeof(Record));
      if (!list.empty())
        std::memcpy(list.data(), bytes.data(), bytes.size());
      return list;
    }
  } // namespace Bytes

  /** Sends lists of records to some ranks. Collective. @return what came, by
   *  sender */
  template <typename Record>
  std::map<unsigned int, std::vector<Record>>
  send_records(const std::map<unsigned int, std::vector<Record>> &lists,
               const MPI_Comm                                     comm)
  {
    std::map<unsigned int, std::vector<char>> bytes;
    for (const auto &[rank, list] : lists)
      bytes[rank] = Bytes::of(list);
    std::map<unsigned int, std::vector<Record>> received;
    for (const auto &[rank, list] :
         dealii::Utilities::MPI::some_to_some(comm, bytes))
      received[rank] = Bytes::records<Record>(list);
    return received;
  }

  /** The records of all ranks, by rank. deal.II's all_gather compresses what it
   *  sends, on one rank, too: a fifth of a run whose surface is merged in each
   *  step (doc/performance.md, Free tissue). Collective. */
  template <typename Record>
  std::vector<std::vector<Record>>
  gather_everywhere(const std::vector<Record> &own, const MPI_Comm comm)
  {
    static_assert(std::is_trivially_copyable<Record>::value);
    const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(comm);
    if (n_ranks == 1)
      return {own};
    const int        n_own = own.size();
    std::vector<int> sizes(n_ranks), offsets(n_ranks + 1, 0);
    MPI_Allgather(&n_own, 1, MPI_INT, sizes.data(), 1, MPI_INT, comm);
    std::partial_sum(sizes.begin(), sizes.end(), offsets.begin() + 1);

    MPI_Datatype record;
    MPI_Type_contiguous(sizeof(Record), MPI_BYTE, &record);
    MPI_Type_commit(&record);
    std::vector<Record> list(offsets.back());
    MPI_Allgatherv(own.data(),
                   n_own,
                   record,
                   list.data(),
                   sizes.data(),
                   offsets.data(),
                   record,
                   comm);
    MPI_Type_free(&record);

    std::vector<std::vector<Record>> all;
    for (unsigned int rank = 0; rank < n_ranks; ++rank)
      all.emplace_back(list.begin() + offsets[rank],
                       list.begin() + offsets[rank + 1]);
    return all;
  }
} // namespace Morula

#endif
