// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/available_memory.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace Morula
{
  using namespace dealii;
  namespace fs = std::filesystem;

  namespace
  {
    /** The number behind the word @p key in a file, or at its beginning if
     *  there is no key; @p otherwise if there is no such number. */
    std::uint64_t
    number_in(const fs::path     &file,
              const std::string  &key,
              const std::uint64_t otherwise)
    {
      std::ifstream in(file);
      std::uint64_t number;
      for (std::string word; word != key;)
        if (!(in >> word))
          return otherwise;
      return in >> number ? number : otherwise;
    }
  } // namespace

  std::uint64_t
  available_memory(const std::string &root)
  {
    // A container or a batch job is a control group, which may have less than
    // the machine, as may all groups above it. A group without a limit says
    // "max". Files that are kept in memory and that nobody uses make room.
    constexpr std::uint64_t unlimited = ~std::uint64_t(0);
    std::uint64_t           available =
      1024 * number_in(fs::path(root) / "proc/meminfo", "MemAvailable:", 0);
    const fs::path groups = fs::path(root) / "sys/fs/cgroup";
    std::ifstream  lines(fs::path(root) / "proc/self/cgroup");
    for (std::string line; std::getline(lines, line);)
      if (line.compare(0, 4, "0::/") == 0)
        for (fs::path path = line.substr(4);; path = path.parent_path())
          {
            const fs::path      group = groups / path;
            const std::uint64_t limit =
              number_in(group / "memory.max", "", unlimited);
            const std::uint64_t used =
              number_in(group / "memory.current", "", 0);
            const std::uint64_t files =
              number_in(group / "memory.stat", "inactive_file", 0);
            if (limit != unlimited)
              available =
                std::min(available,
                         limit - std::min(limit, used - std::min(used, files)));
            if (path.empty())
              break;
          }
    return available;
  }


  bool
  memory_is_short(const MPI_Comm comm)
  {
    Utilities::System::MemoryStats taken; // kB
    Utilities::System::get_memory_stats(taken);
    // Memory is shared by the ranks of one machine. The most that this rank has
    // taken so far stands for each of them.
    MPI_Comm machine;
    MPI_Comm_split_type(comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
    const double all =
      1024. * taken.VmHWM * Utilities::MPI::n_mpi_processes(machine);
    MPI_Comm_free(&machine);
    return Utilities::MPI::max(available_memory() < all ? 1 : 0, comm) == 1;
  }
} // namespace Morula
