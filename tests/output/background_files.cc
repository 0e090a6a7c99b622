// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "output/room.h"

/** Writes a file once @p go is true. */
std::function<void()>
one_file(const std::string &path, std::shared_future<void> go)
{
  return [path, go]() {
    go.wait();
    write_atomically(path, "content");
  };
}

std::shared_future<void>
at_once()
{
  std::promise<void> promise;
  promise.set_value();
  return promise.get_future();
}

TEST(BackgroundFiles, AreWrittenMeanwhile)
{
  const ScratchDirectory directory;
  BackgroundFiles        background(MPI_COMM_WORLD);
  EXPECT_FALSE(background.pending());
  EXPECT_FALSE(background.written());
  background.finish(); // there is nothing to wait for

  std::promise<void> go;
  background.start(one_file(directory / "a", go.get_future()), false);
  EXPECT_TRUE(background.pending());
  EXPECT_FALSE(background.written()); // the thread waits
  EXPECT_EQ(directory.files(), std::vector<std::string>{});

  go.set_value();
  while (!background.written())
    ;
  EXPECT_TRUE(background.pending());
  background.finish();
  EXPECT_FALSE(background.pending());
  EXPECT_FALSE(background.written());
  EXPECT_EQ(content(directory / "a"), "content");
  EXPECT_EQ(directory.files(), std::vector<std::string>{"a"});
}

TEST(BackgroundFiles, FinishThoseBefore)
{
  const ScratchDirectory directory;
  BackgroundFiles        background(MPI_COMM_WORLD);
  background.start(one_file(directory / "a", at_once()), false);
  background.start(one_file(directory / "b", at_once()), true);
  EXPECT_FALSE(background.pending());
  EXPECT_EQ(directory.files(), (std::vector<std::string>{"a", "b"}));
}

// A disk that becomes full while the run goes on: all ranks are told, and the
// old file stays.
TEST(BackgroundFiles, FailTogetherLater)
{
  const ScratchDirectory directory;
  on_root(MPI_COMM_WORLD, [&]() { write(directory / "a", "old"); });
  BackgroundFiles background(MPI_COMM_WORLD);
  {
    std::promise<void> go;
    background.start(one_file(directory / "a", go.get_future()), false);
    const FullDisk full(1);
    go.set_value();
    EXPECT_THROW(background.finish(), std::runtime_error);
  }
  EXPECT_FALSE(background.pending());
  EXPECT_EQ(directory.files(), std::vector<std::string>{"a"});
  EXPECT_EQ(content(directory / "a"), "old");
}
