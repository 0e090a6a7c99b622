// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_halo_h
#define morula_base_halo_h

#include <morula/base/send_records.h>

#include <deal.II/base/array_view.h>
#include <deal.II/base/partitioner.h>

#include <map>
#include <utility>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /**
   * The entries of a distributed vector that a rank needs besides its own. They
   * come and go by messages between neighbours alone: deal.II's Partitioner
   * has no barrier and no reduction.
   */
  class Halo
  {
  public:
    /** Collective.
     *  @param own    an interval; those of all ranks follow each other
     *  @param others of other ranks */
    Halo(const IndexSet &own, const IndexSet &others, const MPI_Comm comm)
      : partitioner(own, others, comm)
      , buffer(partitioner.n_import_indices())
    {}

    /** Puts the other ranks' entries into @p others, in the order of their
     *  numbers. Neighbours have to do the same. */
    void
    fetch(const double *own, double *others) const
    {
      // deal.II sends the own entries that others need and receives the ghost
      // entries, without a barrier.
      const ArrayView<double>  ghosts(others, partitioner.n_ghost_indices());
      std::vector<MPI_Request> requests;
      partitioner.export_to_ghosted_array_start(
        channel,
        ArrayView<const double>(own, partitioner.locally_owned_size()),
        make_array_view(buffer),
        ghosts,
        requests);
      partitioner.export_to_ghosted_array_finish(ghosts, requests);
    }

    /** The transpose: adds @p others to the entries of the ranks that own them,
     *  and clears them. */
    void
    add_back(double *others, double *own) const
    {
      const ArrayView<double>  ghosts(others, partitioner.n_ghost_indices());
      std::vector<MPI_Request> requests;
      partitioner.import_from_ghosted_array_start(VectorOperation::add,
                                                  channel,
                                                  ghosts,
                                                  make_array_view(buffer),
                                                  requests);
      partitioner.import_from_ghosted_array_finish(
        VectorOperation::add,
        ArrayView<const double>(buffer.data(), buffer.size()),
        ArrayView<double>(own, partitioner.locally_owned_size()),
        ghosts,
        requests);
    }

    /**
     * Lists of any length that go with the entries. Collective.
     * @tparam T trivially copyable
     * @param append appends the list of an own entry, by its number among these
     * @param length of a list, about: for so much there is room at once
     * @param take   gets the lists of consecutive entries of other ranks, one
     *               after the other; called in the order of the entries
     */
    template <typename T, typename Append, typename Take>
    void
    fetch_lists(const Append     &append,
                const std::size_t length,
                const Take       &take) const
    {
      // A rank that needs entries of this one gets their lists in one message.
      std::map<unsigned int, std::vector<T>> sent;
      for (const auto &[rank, entries] : needed_elsewhere())
        {
          std::vector<T> &lists = sent[rank];
          lists.reserve(entries.size() * length);
          for (const unsigned int entry : entries)
            append(entry, lists);
        }
      for (const auto &[rank, lists] :
           send_records(sent, partitioner.get_mpi_communicator()))
        take(lists);
    }

  private:
    /** The numbers of own entries that others need, by their rank. */
    std::vector<std::pair<unsigned int, std::vector<unsigned int>>>
    needed_elsewhere() const
    {
      std::vector<std::pair<unsigned int, std::vector<unsigned int>>> result;
      // The partitioner has the entries that others need as ranges, one rank
      // after the other.
      auto range = partitioner.import_indices().begin();
      for (const auto &[rank, n] : partitioner.import_targets())
        {
          auto &entries =
            result.emplace_back(rank, std::vector<unsigned int>()).second;
          for (; entries.size() < n; ++range)
            for (unsigned int entry = range->first; entry < range->second;
                 ++entry)
              entries.push_back(entry);
        }
      return result;
    }

    /** No other exchange is under way at the same time. */
    static constexpr unsigned int channel = 0;

    Utilities::MPI::Partitioner partitioner;
    mutable std::vector<double> buffer; // of the messages
  };
} // namespace Morula

#endif
