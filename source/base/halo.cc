// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/halo.h>

#include <deal.II/base/array_view.h>

namespace Morula
{
  namespace
  {
    /** No other exchange is under way at the same time. */
    constexpr unsigned int channel = 0;
  } // namespace

  Halo::Halo(const IndexSet &own, const IndexSet &others, const MPI_Comm comm)
    : partitioner(own, others, comm)
    , buffer(partitioner.n_import_indices())
  {}

  void
  Halo::fetch(const double *own, double *others) const
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

  void
  Halo::add_back(double *others, double *own) const
  {
    const ArrayView<double>  ghosts(others, partitioner.n_ghost_indices());
    std::vector<MPI_Request> requests;
    partitioner.import_from_ghosted_array_start(
      VectorOperation::add, channel, ghosts, make_array_view(buffer), requests);
    partitioner.import_from_ghosted_array_finish(
      VectorOperation::add,
      ArrayView<const double>(buffer.data(), buffer.size()),
      ArrayView<double>(own, partitioner.locally_owned_size()),
      ghosts,
      requests);
  }

  std::vector<std::pair<unsigned int, std::vector<unsigned int>>>
  Halo::needed_elsewhere() const
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
} // namespace Morula
