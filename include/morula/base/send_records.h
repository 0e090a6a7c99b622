// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_send_records_h
#define morula_base_send_records_h

#include <deal.II/base/mpi.templates.h>

#include <cstring>
#include <map>
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

  /** The records of all ranks, by rank. Collective. */
  template <typename Record>
  std::vector<std::vector<Record>>
  gather_everywhere(const std::vector<Record> &own, const MPI_Comm comm)
  {
    std::vector<std::vector<Record>> all;
    for (const auto &list :
         dealii::Utilities::MPI::all_gather(comm, Bytes::of(own)))
      all.push_back(Bytes::records<Record>(list));
    return all;
  }
} // namespace Morula

#endif
