// ranks: 1 2
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/input_error.h>
#include <morula/output/directory.h>

#include <gtest/gtest.h>

#include "scratch_directory.h"

using namespace Morula;

namespace
{
  using Names = std::vector<std::string>;

  void
  fill(const ScratchDirectory &directory, const Names &names)
  {
    on_root(MPI_COMM_WORLD, [&]() {
      for (const std::string &name : names)
        write(directory / name, "old");
    });
  }
} // namespace

TEST(Directory, NumbersFiles)
{
  EXPECT_EQ(numbered_file("cells", 0, "csv"), "cells-0000.csv");
  EXPECT_EQ(numbered_file("surface", 12345, "vtu"), "surface-12345.vtu");
}

TEST(Directory, LosesTheOldRunAndNothingElse)
{
  const ScratchDirectory directory;
  const Names            strangers = {"Cells-0000.vtu",
                                      "cells-000.vtu",
                                      "cells-0000.png",
                                      "cells-0000.vtu.bak",
                                      "mycells-0000.vtu",
                                      "notes.txt",
                                      "scene.prm",
                                      "statistics-old.csv"};
  Names                  all       = {"parameters.prm",
                                      "parameters.prm.tmp",
                                      "log.txt",
                                      "cells.pvd",
                                      "surface.pvd",
                                      "cells-0000.vtu",
                                      "cells-10000.pvtu",
                                      "cells-0001.csv.tmp",
                                      "surface-0001.vtu",
                                      "surface-0001.csv",
                                      "condition.csv",
                                      "lineage.csv",
                                      "statistics.csv",
                                      "timings.csv",
                                      "snapshot.h5",
                                      "snapshot.h5.tmp"};
  all.insert(all.end(), strangers.begin(), strangers.end());
  fill(directory, all);
  on_root(MPI_COMM_WORLD, [&]() {
    std::filesystem::create_directory(directory / "cells-0007.vtu");
  });

  prepare_directory(directory / "", "set A = 1\n", {}, MPI_COMM_WORLD);
  Names left = strangers;
  left.push_back("cells-0007.vtu"); // a directory is not ours
  left.push_back("parameters.prm");
  std::sort(left.begin(), left.end());
  EXPECT_EQ(directory.files(), left);
  EXPECT_EQ(content(directory / "parameters.prm"), "set A = 1\n");
}

TEST(Directory, IsCreated)
{
  const ScratchDirectory directory;
  check_directory(directory / "a/b/");
  EXPECT_FALSE(std::filesystem::exists(directory / "a"));
  MPI_Barrier(MPI_COMM_WORLD);
  prepare_directory(directory / "a/b/", "", {}, MPI_COMM_WORLD);
  EXPECT_TRUE(std::filesystem::exists(directory / "a/b/parameters.prm"));
}

TEST(Directory, MustBeOne)
{
  const ScratchDirectory directory;
  fill(directory, {"file"});
  EXPECT_THROW(check_directory(""), InputError);
  EXPECT_THROW(check_directory(directory / "file"), InputError);
  EXPECT_THROW(check_directory(directory / "file/below"), InputError);
  EXPECT_THROW(prepare_directory(directory / "file", "", {}, MPI_COMM_WORLD),
               InputError);
  EXPECT_EQ(content(directory / "file"), "old");
  EXPECT_THROW(check_directory("/proc/sys/none"), InputError);
}

TEST(Directory, DoesNotLoseTheInputOfTheNewRun)
{
  const ScratchDirectory directory;
  fill(directory, {"cells-0003.csv", "log.txt"});
  EXPECT_THROW(prepare_directory(directory / "",
                                 "",
                                 {directory / "../nothing",
                                  directory / "./cells-0003.csv"},
                                 MPI_COMM_WORLD),
               InputError);
  EXPECT_EQ(directory.files(), (Names{"cells-0003.csv", "log.txt"}));
}

TEST(Directory, LosesWhatCameAfterTheSnapshot)
{
  const ScratchDirectory directory;
  fill(directory,
       {"cells-0004.vtu",
        "cells-0005.vtu",
        "surface-0006.csv",
        "parameters.prm",
        "statistics.csv",
        "snapshot.h5"});
  prepare_resume(directory / "", "new", 5, MPI_COMM_WORLD);
  EXPECT_EQ(directory.files(),
            (Names{"cells-0004.vtu",
                   "parameters.prm",
                   "snapshot.h5",
                   "statistics.csv"}));
  EXPECT_EQ(content(directory / "parameters.prm"), "new");
}
