// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "output/room.h"

using Names = std::vector<std::string>;

void
fill(const ScratchDirectory &directory, const Names &names)
{
  on_root(MPI_COMM_WORLD, [&]() {
    for (const std::string &name : names)
      write(directory / name, "old");
  });
}

/** The parameters.prm of a run, of which no more than the record matters. */
const std::string record =
  "# A run of Morula 0.2.0.\n# scene: ../a.prm\n# state: not finished\n";

/** What is said when a run is to go there; empty if it may. */
std::string
complaint(const std::string &directory, const RunSetup &run)
{
  return complaint_of(
    [&] { prepare_directory(directory, run, MPI_COMM_WORLD); });
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
                                      "provenance.json",
                                      "cells.pvd",
                                      "surface.pvd",
                                      "cells-0000.vtu",
                                      "cells-10000.pvtu",
                                      "cells-0001.csv.tmp",
                                      "surface-0001.vtu",
                                      "surface-0001.csv",
                                      "condition.csv",
                                      "events.csv",
                                      "lineage.csv",
                                      "statistics.csv",
                                      "timings.csv",
                                      "snapshot.h5",
                                      "snapshot.h5.tmp"};
  all.insert(all.end(), strangers.begin(), strangers.end());
  fill(directory, all);
  on_root(MPI_COMM_WORLD, [&]() {
    write(directory / "parameters.prm", record);
    std::filesystem::create_directory(directory / "cells-0007.vtu");
  });

  prepare_directory(directory / "",
                    {"a.prm", "set A = 1\n", {}, true},
                    MPI_COMM_WORLD);
  Names left = strangers;
  left.push_back("cells-0007.vtu"); // a directory is not ours
  left.push_back("parameters.prm");
  std::sort(left.begin(), left.end());
  EXPECT_EQ(directory.files(), left);
  const std::string written = content(directory / "parameters.prm");
  EXPECT_EQ(written.substr(0, 18), "# A run of Morula ");
  EXPECT_EQ(written.substr(written.size() - 33),
            "\n# state: not finished\nset A = 1\n");
}

TEST(Directory, IsCreated)
{
  const ScratchDirectory directory;
  check_directory(directory / "a/b/");
  EXPECT_FALSE(std::filesystem::exists(directory / "a"));
  MPI_Barrier(MPI_COMM_WORLD);
  prepare_directory(directory / "a/b/", {}, MPI_COMM_WORLD);
  EXPECT_TRUE(std::filesystem::exists(directory / "a/b/parameters.prm"));
}

TEST(Directory, MustBeOne)
{
  const ScratchDirectory directory;
  fill(directory, {"file"});
  EXPECT_THROW(check_directory(""), InputError);
  EXPECT_THROW(check_directory(directory / "file"), InputError);
  EXPECT_THROW(check_directory(directory / "file/below"), InputError);
  EXPECT_THROW(prepare_directory(directory / "file", {}, MPI_COMM_WORLD),
               InputError);
  EXPECT_EQ(content(directory / "file"), "old");
  EXPECT_THROW(check_directory("/proc/sys/none"), InputError);
}

TEST(Directory, DoesNotLoseTheInputOfTheNewRun)
{
  const ScratchDirectory directory;
  fill(directory, {"cells-0003.csv", "log.txt"});
  on_root(MPI_COMM_WORLD,
          [&]() { write(directory / "parameters.prm", record); });
  const RunSetup run = {"a.prm",
                        "",
                        {directory / "../nothing",
                         directory / "./cells-0003.csv"},
                        true};
  expect_parts(complaint(directory / "", run), {"the scene reads '"});
  EXPECT_EQ(directory.files(),
            (Names{"cells-0003.csv", "log.txt", "parameters.prm"}));
}

TEST(Directory, KeepsRunsThatWouldBeLost)
{
  const ScratchDirectory directory;
  const RunSetup         a   = {directory / "a.prm", "set A = 1\n", {}, false};
  const RunSetup         b   = {directory / "b.prm", "set A = 2\n", {}, false};
  const std::string      run = directory / "run";

  const auto refused = [&](const RunSetup &setup) {
    const std::string said = complaint(run, setup);
    MPI_Barrier(MPI_COMM_WORLD);
    return said;
  };
  const auto says = [&](const RunSetup &setup, const std::string &part) {
    const std::string said = refused(setup);
    expect_parts(said, {part});
  };
  EXPECT_EQ(refused(a), "");
  says(a, "there is one that is not finished");
  note_finished(run, a, 3599., MPI_COMM_WORLD);
  says(b, "of another scene, '../a.prm'");
  EXPECT_EQ(refused(a), "");

  // from its own keys it is a run of the same scene
  note_finished(run, a, 1., MPI_COMM_WORLD);
  EXPECT_EQ(refused({run + "/parameters.prm", "", {}, false}), "");
  note_finished(run, a, 1., MPI_COMM_WORLD);
  says(b, "of another scene, '../a.prm'");
  EXPECT_EQ(refused(a), "");

  note_finished(run, a, 7265., MPI_COMM_WORLD);
  says(a, "that took 2 h 01 min");
  RunSetup replacing = b;
  replacing.replace  = true;
  EXPECT_EQ(refused(replacing), "");
  says(a, "of another scene, '../b.prm'");

  // somebody's own files
  on_root(MPI_COMM_WORLD, [&]() {
    write(run + "/parameters.prm", "set A = 1\n");
    write(run + "/statistics.csv", "country,people\n");
  });
  for (const RunSetup &setup : {a, replacing})
    says(setup, "', but no parameters.prm of such a run)");

  // files of these names without a run
  on_root(MPI_COMM_WORLD, [&]() {
    std::filesystem::remove(run + "/parameters.prm");
    std::filesystem::remove(run + "/statistics.csv");
    write(run + "/parameters.prm.tmp", "# A r");
  });
  EXPECT_EQ(refused(a), "");
  on_root(MPI_COMM_WORLD, [&]() {
    std::filesystem::remove(run + "/parameters.prm");
    write(run + "/cells-0001.csv", "x,y,z\n");
  });
  says(replacing, "there is 'cells-0001.csv', but no parameters.prm");
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
  prepare_resume(directory / "",
                 {"a.prm", "new", {}, false},
                 5,
                 MPI_COMM_WORLD);
  EXPECT_EQ(directory.files(),
            (Names{"cells-0004.vtu",
                   "parameters.prm",
                   "snapshot.h5",
                   "statistics.csv"}));
  const std::string written = content(directory / "parameters.prm");
  expect_parts(written, {"# state: not finished\nnew"});
}
