// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "output/room.h"

TEST(OutputFile, AppearsWhenItIsComplete)
{
  const ScratchDirectory directory(MPI_COMM_SELF);
  const std::string      path = directory / "a";
  write(path, "old");
  {
    OutputFile file(path, OutputFile::Mode::replace);
    file.write("ne");
    file.write(std::string(3000000, 'w'));
    EXPECT_EQ(content(path), "old");
    file.commit();
  }
  EXPECT_EQ(content(path), "ne" + std::string(3000000, 'w'));
  EXPECT_EQ(directory.files(), std::vector<std::string>{"a"});
}

TEST(OutputFile, LeavesTheOldOneWhenItIsGivenUp)
{
  const ScratchDirectory directory(MPI_COMM_SELF);
  const std::string      path = directory / "a";
  write(path, "old");
  {
    OutputFile file(path, OutputFile::Mode::replace);
    file.write("new");
  }
  {
    const FullDisk full(10);
    EXPECT_THROW(write_atomically(path, "longer than the disk"),
                 std::runtime_error);
    OutputFile file(path, OutputFile::Mode::replace);
    EXPECT_THROW(file.reserve(11), std::runtime_error);
    EXPECT_NO_THROW(file.reserve(10));
  }
  EXPECT_EQ(content(path), "old");
  EXPECT_EQ(directory.files(), std::vector<std::string>{"a"});
}
