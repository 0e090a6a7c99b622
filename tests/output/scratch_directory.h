// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_output_scratch_directory_h
#define morula_tests_output_scratch_directory_h

#include <morula/base/agreement.h>

#include <deal.II/base/mpi.h>

#include <stdlib.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

/** A new directory that all ranks know and that goes at the end. */
class ScratchDirectory
{
public:
  explicit ScratchDirectory(const MPI_Comm comm = MPI_COMM_WORLD)
    : comm(comm)
  {
    Morula::on_root(comm, [&]() {
      path =
        (std::filesystem::temp_directory_path() / "morula-XXXXXX").string();
      if (mkdtemp(&path[0]) == nullptr)
        throw std::runtime_error("no scratch directory");
    });
    path = dealii::Utilities::MPI::broadcast(comm, path);
  }

  ~ScratchDirectory()
  {
    MPI_Barrier(comm);
    std::error_code error;
    if (dealii::Utilities::MPI::this_mpi_process(comm) == 0)
      std::filesystem::remove_all(path, error);
  }

  std::string
  operator/(const std::string &name) const
  {
    return path + '/' + name;
  }

  /**
   * Names of the files in it, sorted. Collective: no rank looks before all have
   * done what they do before, and none goes on before all have looked.
   */
  std::vector<std::string>
  files() const
  {
    MPI_Barrier(comm);
    std::vector<std::string> names;
    for (const auto &entry : std::filesystem::directory_iterator(path))
      names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    MPI_Barrier(comm);
    return names;
  }

private:
  MPI_Comm    comm;
  std::string path;
};

inline std::string
content(const std::string &path)
{
  std::ifstream     in(path, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

inline void
write(const std::string &path, const std::string &text)
{
  std::ofstream(path, std::ios::binary) << text;
}

/** While it lives, no file can grow beyond so many bytes: a full disk. */
class FullDisk
{
public:
  explicit FullDisk(const unsigned long bytes)
    : old_handler(std::signal(SIGXFSZ, SIG_IGN))
  {
    getrlimit(RLIMIT_FSIZE, &old_limit);
    rlimit limit   = old_limit;
    limit.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &limit);
  }

  ~FullDisk()
  {
    setrlimit(RLIMIT_FSIZE, &old_limit);
    std::signal(SIGXFSZ, old_handler);
  }

private:
  void (*old_handler)(int);
  rlimit old_limit;
};

#endif
