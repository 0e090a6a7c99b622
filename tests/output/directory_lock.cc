// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "output/room.h"

bool file_system_knows_locks = true;

/** Instead of the C library's, in this executable. */
extern "C" int
flock(int descriptor, int operation) noexcept
{
  if (file_system_knows_locks)
    return syscall(SYS_flock, descriptor, operation);
  errno = ENOLCK;
  return -1;
}

const MPI_Comm comm = MPI_COMM_WORLD;

/** What is said to a second run; empty if it may go on. */
std::string
second_run(const std::string &directory)
{
  return complaint_of([&] { const DirectoryLock lock(directory, comm); });
}

/** The same where it only looks. */
std::string
look(const std::string &directory)
{
  return complaint_of(
    [&] { on_root(comm, [&]() { DirectoryLock::check_free(directory); }); });
}


TEST(DirectoryLock, KeepsOthersOutAndNamesTheHolder)
{
  const ScratchDirectory scratch;
  const std::string      directory = scratch / "run";
  EXPECT_EQ(look(directory), "");
  {
    const DirectoryLock lock(directory, comm);
    const std::string   holder =
      "process " +
      std::to_string(dealii::Utilities::MPI::broadcast(comm, getpid())) +
      " on " + dealii::Utilities::System::get_hostname();
    EXPECT_EQ(lock.reason_without_lock(), "");
    for (const std::string &said : {second_run(directory), look(directory)})
      {
        EXPECT_NE(said.find("Output directory = '" + directory + "'"),
                  std::string::npos)
          << said;
        EXPECT_NE(said.find(holder), std::string::npos) << said;
      }
    EXPECT_EQ(content(directory + "/morula.lock"), holder + "\n");
    EXPECT_EQ(second_run(scratch / "other"), "");
    MPI_Barrier(comm);
  }
  EXPECT_EQ(look(directory), "");
  EXPECT_EQ(second_run(directory), "");
  MPI_Barrier(comm);
  EXPECT_TRUE(std::filesystem::is_empty(directory));
}

TEST(DirectoryLock, TakesOverAFileThatNobodyHolds)
{
  const ScratchDirectory scratch;
  on_root(comm, [&]() {
    write(scratch / "morula.lock",
          "process 1 on a host that is gone, and more\n");
  });
  EXPECT_EQ(look(scratch / ""), "");
  const DirectoryLock lock(scratch / "", comm);
  MPI_Barrier(comm);
  EXPECT_EQ(content(scratch / "morula.lock").find("gone"), std::string::npos);
}

TEST(DirectoryLock, LeavesTheFileOfAnotherRun)
{
  // somebody has removed the directory and begun another run in its place
  const ScratchDirectory scratch;
  {
    const DirectoryLock lock(scratch / "", comm);
    on_root(comm, [&]() {
      std::filesystem::remove(scratch / "morula.lock");
      write(scratch / "morula.lock", "process 2 on another host\n");
    });
  }
  EXPECT_EQ(content(scratch / "morula.lock"), "process 2 on another host\n");
  MPI_Barrier(comm);
}

TEST(DirectoryLock, SaysWhereThereAreNoLocks)
{
  const ScratchDirectory scratch;
  file_system_knows_locks = false;
  {
    const DirectoryLock lock(scratch / "", comm);
    EXPECT_NE(lock.reason_without_lock().find(
                "knows no locks (No locks available)"),
              std::string::npos)
      << lock.reason_without_lock();
    EXPECT_EQ(look(scratch / ""), "");
    EXPECT_EQ(second_run(scratch / ""), "");
  }
  file_system_knows_locks = true;
  EXPECT_EQ(scratch.files(), std::vector<std::string>());
}
