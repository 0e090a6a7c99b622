// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "base/room.h"

/** A machine with 8,000 kB to give, whose files can be changed. */
class AvailableMemory : public testing::Test
{
protected:
  AvailableMemory()
  {
    std::filesystem::create_directories(root / "proc/self");
    std::filesystem::create_directories(root / "sys/fs/cgroup/job/step");
    write(root / "proc/meminfo",
          "MemTotal: 9000 kB\nMemFree: 1 kB\nMemAvailable: 8000 kB\n");
  }

  void
  put(const std::string &file, const std::string &text)
  {
    write(root / ("sys/fs/cgroup/" + file), text);
  }

  const ScratchDirectory root;
};

TEST_F(AvailableMemory, IsWhatLinuxSays)
{
  EXPECT_EQ(available_memory(root / ""), 8000u * 1024);
}

TEST_F(AvailableMemory, IsNothingWhereTheSystemDoesNotTell)
{
  EXPECT_EQ(available_memory(root / "nothing/"), 0u);
}

TEST_F(AvailableMemory, IsLimitedByTheGroupsOfTheProcess)
{
  write(root / "proc/self/cgroup", "10:name=x:/other\n0::/job/step\n");
  EXPECT_EQ(available_memory(root / ""), 8000u * 1024);

  put("job/step/memory.max", "max\n");
  put("job/step/memory.current", "9999999\n");
  EXPECT_EQ(available_memory(root / ""), 8000u * 1024);

  put("job/memory.max", "1000000\n");
  put("job/memory.current", "700000\n");
  EXPECT_EQ(available_memory(root / ""), 300000u);

  put("job/memory.stat", "anon 500000\ninactive_file 200000\n");
  EXPECT_EQ(available_memory(root / ""), 500000u);

  put("job/step/memory.max", "100000\n"); // and used more, for a moment
  EXPECT_EQ(available_memory(root / ""), 0u);
}

TEST_F(AvailableMemory, OfThisMachineIsSomething)
{
  EXPECT_GT(available_memory(), 1u << 20);
}
