// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_common_temporary_file_h
#define morula_tests_common_temporary_file_h

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <string>

namespace Morula
{
  /**
   * A file that exists, for all ranks, as long as the object does. Every file
   * has a name of its own: rank 0 would write one anew while another rank still
   * reads the one before.
   */
  class TemporaryFile
  {
  public:
    TemporaryFile(const std::string &ending, const std::string &content)
    {
      const std::string process = std::to_string(
        dealii::Utilities::MPI::broadcast(MPI_COMM_WORLD,
                                          static_cast<long>(getpid())));
      path = ::testing::TempDir() + "morula-test-" + process + '-' +
             std::to_string(n_made++) + ending;
      if (is_writer())
        std::ofstream(path, std::ios::binary) << content;
      MPI_Barrier(MPI_COMM_WORLD);
    }

    TemporaryFile(const TemporaryFile &) = delete;

    ~TemporaryFile()
    {
      MPI_Barrier(MPI_COMM_WORLD);
      if (is_writer())
        std::remove(path.c_str());
    }

    std::string path;

  private:
    /** As many on all ranks, as all of them make every file. */
    static inline unsigned int n_made = 0;

    static bool
    is_writer()
    {
      return dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
    }
  };
} // namespace Morula

#endif
