// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_gather_h
#define morula_output_gather_h

#include <deal.II/base/exceptions.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/mpi_large_count.h>

#include <type_traits>
#include <utility>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /**
   * Gathers all ranks' strings, or vectors of plain values, on rank 0. The
   * result is in the order of the ranks; on other ranks it is empty. A rank's
   * part may be larger than 2 GB, which Utilities::MPI::gather() does not
   * allow. Collective.
   */
  template <typename Container>
  std::vector<Container>
  gather_to_root(Container local, const MPI_Comm comm)
  {
    using T = typename Container::value_type;
    static_assert(std::is_trivially_copyable<T>::value,
                  "only plain values can be sent byte by byte");
    constexpr int tag = 0;

    const std::vector<std::size_t> sizes =
      Utilities::MPI::gather(comm, local.size());
    if (Utilities::MPI::this_mpi_process(comm) != 0)
      {
        if (!local.empty())
          {
            const int ierr = Utilities::MPI::LargeCount::Send_c(
              local.data(), local.size() * sizeof(T), MPI_BYTE, 0, tag, comm);
            AssertThrowMPI(ierr);
          }
        return {};
      }

    std::vector<Container> all(sizes.size());
    all[0] = std::move(local);
    for (std::size_t rank = 1; rank < all.size(); ++rank)
      if (sizes[rank] > 0)
        {
          all[rank].resize(sizes[rank]);
          const int ierr =
            Utilities::MPI::LargeCount::Recv_c(&all[rank][0],
                                               sizes[rank] * sizeof(T),
                                               MPI_BYTE,
                                               rank,
                                               tag,
                                               comm,
                                               MPI_STATUS_IGNORE);
          AssertThrowMPI(ierr);
        }
    return all;
  }
} // namespace Morula

#endif
