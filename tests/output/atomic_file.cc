// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/output/atomic_file.h>

#include <gtest/gtest.h>

#include "output/scratch_directory.h"

using namespace Morula;

TEST(AtomicFile, AppearsWhenItIsComplete)
{
  const ScratchDirectory directory(MPI_COMM_SELF);
  const std::string      path = directory / "a";
  write(path, "old");
  {
    AtomicFile file(path);
    file.write("ne");
    file.write(std::string(3000000, 'w'));
    EXPECT_EQ(content(path), "old");
    file.commit();
  }
  EXPECT_EQ(content(path), "ne" + std::string(3000000, 'w'));
  EXPECT_EQ(directory.files(), std::vector<std::string>{"a"});
}

TEST(AtomicFile, LeavesTheOldOneWhenItIsGivenUp)
{
  const ScratchDirectory directory(MPI_COMM_SELF);
  const std::string      path = directory / "a";
  write(path, "old");
  {
    AtomicFile file(path);
    file.write("new");
  }
  {
    const FullDisk full(10);
    EXPECT_THROW(write_atomically(path, "longer than the disk"),
                 std::runtime_error);
    EXPECT_THROW(AtomicFile(path).reserve(11), std::runtime_error);
    EXPECT_NO_THROW(AtomicFile(path).reserve(10));
  }
  EXPECT_EQ(content(path), "old");
  EXPECT_EQ(directory.files(), std::vector<std::string>{"a"});
}

TEST(AtomicFile, NamesPathAndReason)
{
  try
    {
      write_atomically("/proc/none/a", "");
      ADD_FAILURE() << "there is no such directory";
    }
  catch (const std::runtime_error &error)
    {
      EXPECT_EQ(std::string(error.what()),
                "cannot open the file '/proc/none/a.tmp': No such file or "
                "directory");
    }
}

TEST(Agreement, LetsAllRanksFailAlike)
{
  const unsigned int rank =
    dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  const unsigned int last =
    dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) - 1;

  EXPECT_NO_THROW(everywhere(MPI_COMM_WORLD, []() {}));
  try
    {
      everywhere(MPI_COMM_WORLD, [&]() {
        if (rank == last)
          throw InputError("Grid/Spacing", "-1", "a length", "Give one.");
      });
      ADD_FAILURE() << "nothing was thrown";
    }
  catch (const InputError &error)
    {
      EXPECT_EQ(std::string(error.what()),
                "Grid/Spacing = '-1': allowed is a length. Give one.");
    }
  try
    {
      on_root(MPI_COMM_WORLD, [&]() { throw std::logic_error("broken"); });
      ADD_FAILURE() << "nothing was thrown";
    }
  catch (const std::runtime_error &error)
    {
      EXPECT_EQ(dynamic_cast<const InputError *>(&error), nullptr);
      EXPECT_EQ(std::string(error.what()), "broken");
    }
}
