// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/available_memory.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <optional>

namespace Morula
{
  using namespace dealii;
  namespace fs = std::filesystem;

  namespace
  {
    /** The number behind the word @p key in a file; @p otherwise if there is no
     *  such number. */
    std::uint64_t
    number_behind(const fs::path     &file,
                  const std::string  &key,
                  const std::uint64_t otherwise)
    {
      std::ifstream in(file);
      std::string   word;
      // Words and numbers are read one by one, as these files are lists of
      // names with their numbers.
      while (in >> word)
        if (std::uint64_t number; word == key && in >> number)
          return number;
      return otherwise;
    }

    /** The number that a file consists of. */
    std::uint64_t
    number_in(const fs::path &file, const std::uint64_t otherwise)
    {
      std::ifstream in(file);
      std::uint64_t number;
      return in >> number ? number : otherwise;
    }

    /** Where a version of control groups says what. */
    struct ControlGroups
    {
      std::string line; // how a process's line begins; its path follows
      std::string directory;
      std::string limit;
      std::string used;
      std::string unused_files; // of memory.stat
    };

    // The first version has a line for each kind of resource, the second one
    // line for all of them.
    const std::array<ControlGroups, 2> versions = {{{":memory:/",
                                                     "sys/fs/cgroup/memory",
                                                     "memory.limit_in_bytes",
                                                     "memory.usage_in_bytes",
                                                     "total_inactive_file"},
                                                    {"0::/",
                                                     "sys/fs/cgroup",
                                                     "memory.max",
                                                     "memory.current",
                                                     "inactive_file"}}};

    /** What a group leaves. Files that are kept in memory and that nobody uses
     *  make room. A group without a limit says "max", or an enormous number. */
    std::uint64_t
    left_by(const fs::path &group, const ControlGroups &names)
    {
      constexpr std::uint64_t unlimited = ~std::uint64_t(0);
      // A file that is missing means no limit: most groups have none.
      const std::uint64_t limit = number_in(group / names.limit, unlimited);
      const std::uint64_t files =
        number_behind(group / "memory.stat", names.unused_files, 0);
      const std::uint64_t used = number_in(group / names.used, 0);
      return limit == unlimited ?
               unlimited :
               limit - std::min(limit, used - std::min(used, files));
    }

    /** The path of this process's group that such a line names. */
    std::optional<fs::path>
    path_in(const std::string &line, const ControlGroups &names)
    {
      const auto begin = line.find(names.line);
      return begin == std::string::npos ?
               std::nullopt :
               std::optional<fs::path>(line.substr(begin + names.line.size()));
    }

    /** Ranks of @p comm on this machine. Collective. */
    unsigned int
    n_ranks_here(const MPI_Comm comm)
    {
      // Memory is shared by the ranks of one machine only.
      MPI_Comm machine;
      MPI_Comm_split_type(
        comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
      const unsigned int n = Utilities::MPI::n_mpi_processes(machine);
      MPI_Comm_free(&machine);
      return n;
    }
  } // namespace

  std::uint64_t
  available_memory(const std::string &root)
  {
    // What the machine has is less for a process in a control group, as in a
    // container or a batch job. Each line of the file names a group of this
    // process; that group and all above it may limit its memory, and the
    // smallest of all counts. Without these files nothing is known, and the
    // answer is 0.
    constexpr std::uint64_t kB = 1024;
    std::uint64_t           available =
      kB * number_behind(fs::path(root) / "proc/meminfo", "MemAvailable:", 0);

    std::ifstream lines(fs::path(root) / "proc/self/cgroup");
    for (std::string line; std::getline(lines, line);)
      for (const ControlGroups &names : versions)
        if (auto group = path_in(line, names))
          for (;; group = group->parent_path()) // those above limit, too
            {
              available =
                std::min(available,
                         left_by(fs::path(root) / names.directory / *group,
                                 names));
              if (group->empty())
                break;
            }
    return available;
  }


  bool
  memory_is_short(const MPI_Comm comm)
  {
    Utilities::System::MemoryStats taken; // kB
    Utilities::System::get_memory_stats(taken);
    // The most that this rank has taken so far stands for each rank of the
    // machine.
    const double all        = 1024. * taken.VmHWM * n_ranks_here(comm);
    const bool   short_here = available_memory() < all;
    return Utilities::MPI::max(short_here ? 1 : 0, comm) == 1;
  }
} // namespace Morula
