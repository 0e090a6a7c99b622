// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_send_records_h
#define morula_base_send_records_h

#include <deal.II/base/exceptions.h>
#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <numeric>
#include <type_traits>
#include <vector>

namespace Morula
{
  /** Records as MPI sends them: byte by byte. */
  template <typename Record>
  class RecordType
  {
    static_assert(std::is_trivially_copyable<Record>::value);

  public:
    RecordType()
    {
      MPI_Type_contiguous(sizeof(Record), MPI_BYTE, &type);
      MPI_Type_commit(&type);
    }

    RecordType(const RecordType &) = delete;

    ~RecordType()
    {
      MPI_Type_free(&type);
    }

    operator MPI_Datatype() const
    {
      return type;
    }

  private:
    MPI_Datatype type;
  };

  /**
   * Sends lists of records to some ranks. Collective. deal.II's some_to_some()
   * copies what it sends and what it receives once more, into new memory
   * (doc/performance.md, Two ranks), and demands a serialize() of each type of
   * record.
   * @return what came, by sender
   */
  template <typename Record>
  std::map<unsigned int, std::vector<Record>>
  send_records(const std::map<unsigned int, std::vector<Record>> &lists,
               const MPI_Comm                                     comm)
  {
    constexpr int            tag = 1;
    const RecordType<Record> record;
    const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(comm);
    std::map<unsigned int, std::vector<Record>> received;
    std::vector<unsigned int>                   receivers;
    for (const auto &[receiver, list] : lists)
      if (receiver == rank)
        received[rank] = list;
      else
        receivers.push_back(receiver);
    // Ranks agree on this: no message of the next call can come before.
    const unsigned int n_senders =
      dealii::Utilities::MPI::compute_n_point_to_point_communications(
        comm, receivers);

    std::vector<MPI_Request> requests(receivers.size());
    for (std::size_t i = 0; i < receivers.size(); ++i)
      {
        const std::vector<Record> &list  = lists.at(receivers[i]);
        const int                  error = MPI_Isend(list.data(),
                                    list.size(),
                                    record,
                                    receivers[i],
                                    tag,
                                    comm,
                                    &requests[i]);
        AssertThrowMPI(error);
      }
    for (unsigned int i = 0; i < n_senders; ++i)
      {
        MPI_Status status;
        int        n;
        int        error = MPI_Probe(MPI_ANY_SOURCE, tag, comm, &status);
        AssertThrowMPI(error);
        error = MPI_Get_count(&status, record, &n);
        AssertThrowMPI(error);
        std::vector<Record> &list = received[status.MPI_SOURCE];
        list.resize(n);
        error = MPI_Recv(list.data(),
                         n,
                         record,
                         status.MPI_SOURCE,
                         tag,
                         comm,
                         MPI_STATUS_IGNORE);
        AssertThrowMPI(error);
      }
    const int error =
      MPI_Waitall(requests.size(), requests.data(), MPI_STATUSES_IGNORE);
    AssertThrowMPI(error);
    return received;
  }

  /** The records of all ranks, by rank. deal.II's all_gather compresses what it
   *  sends, on one rank, too: a fifth of a run whose surface is merged in each
   *  step (doc/performance.md). Collective. */
  template <typename Record>
  std::vector<std::vector<Record>>
  gather_everywhere(const std::vector<Record> &own, const MPI_Comm comm)
  {
    const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(comm);
    if (n_ranks == 1)
      return {own};
    const int        n_own = own.size();
    std::vector<int> sizes(n_ranks), offsets(n_ranks + 1, 0);
    MPI_Allgather(&n_own, 1, MPI_INT, sizes.data(), 1, MPI_INT, comm);
    std::partial_sum(sizes.begin(), sizes.end(), offsets.begin() + 1);

    const RecordType<Record> record;
    std::vector<Record>      list(offsets.back());
    MPI_Allgatherv(own.data(),
                   n_own,
                   record,
                   list.data(),
                   sizes.data(),
                   offsets.data(),
                   record,
                   comm);

    std::vector<std::vector<Record>> all;
    for (unsigned int rank = 0; rank < n_ranks; ++rank)
      all.emplace_back(list.begin() + offsets[rank],
                       list.begin() + offsets[rank + 1]);
    return all;
  }


  /** All records that the above give, one list after the other. */
  template <typename Record>
  std::vector<Record>
  in_one(const std::vector<std::vector<Record>> &lists)
  {
    std::vector<Record> all;
    for (const std::vector<Record> &list : lists)
      all.insert(all.end(), list.begin(), list.end());
    return all;
  }

  /** Likewise. */
  template <typename Record>
  std::vector<Record>
  in_one(const std::map<unsigned int, std::vector<Record>> &lists)
  {
    std::vector<Record> all;
    for (const auto &[rank, list] : lists)
      all.insert(all.end(), list.begin(), list.end());
    return all;
  }


  /** Where a rank's keys stand among those of all ranks. */
  struct GlobalOrder
  {
    /** For each of this rank's keys, in their order: how many keys of all ranks
     *  are smaller. */
    std::vector<std::uint64_t> places;
    std::uint64_t              n_keys = 0; // of all ranks
  };

  /**
   * Where each of this rank's @p keys stands in the order of all ranks' keys.
   * The place does not depend on the number of ranks or on which rank has which
   * key. Equal keys have the same place. Each rank sorts all keys, which are
   * few beside the points of a rank: those of cells that divide in a step, or
   * of patches. Collective.
   * @tparam Key trivially copyable, with operator<
   */
  template <typename Key>
  GlobalOrder
  global_order(const std::vector<Key> &keys, const MPI_Comm comm)
  {
    std::vector<Key> all = in_one(gather_everywhere(keys, comm));
    std::sort(all.begin(), all.end());
    GlobalOrder order;
    order.n_keys = all.size();
    order.places.reserve(keys.size());
    for (const Key &key : keys)
      order.places.push_back(std::lower_bound(all.begin(), all.end(), key) -
                             all.begin());
    return order;
  }
} // namespace Morula

#endif
