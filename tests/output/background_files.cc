// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "output/room.h"

/** What rank @p r writes into the file. */
std::string
part(const unsigned int r)
{
  return std::string(1000, 'a' + r);
}

std::string
all_parts()
{
  std::string all;
  for (unsigned int r = 0; r < number_of_ranks(); ++r)
    all += part(r);
  return all;
}

/** A file with a part of each rank, once @p go is true. */
std::vector<std::unique_ptr<PendingFile>>
one_file(const std::string &path, std::shared_future<void> go)
{
  std::vector<std::unique_ptr<PendingFile>> files;
  files.push_back(
    pending(SharedFile::make(path, number_of_ranks() * 1000, MPI_COMM_WORLD, 0),
            [go, r = this_rank()](SharedFile &file) {
              go.wait();
              file.write(part(r), r * 1000);
            }));
  files.push_back(nullptr); // was written at once
  return files;
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
  EXPECT_EQ(directory.files(), std::vector<std::string>{"a.tmp"});

  go.set_value();
  while (!background.written())
    ;
  EXPECT_TRUE(background.pending());
  background.finish();
  EXPECT_FALSE(background.pending());
  EXPECT_FALSE(background.written());
  EXPECT_EQ(content(directory / "a"), all_parts());
  EXPECT_EQ(directory.files(), std::vector<std::string>{"a"});
}

// The text of a file whose length is not known before it is made.
TEST(BackgroundFiles, HaveStages)
{
  const ScratchDirectory directory;
  BackgroundFiles        background(MPI_COMM_WORLD);
  std::promise<void>     first, second;
  const auto             begin = [&]() {
    std::vector<std::unique_ptr<PendingFile>> files;
    files.push_back(std::make_unique<PendingFile>(
      PendingFile{[go = first.get_future().share()]() { go.wait(); },
                              {},
                  [path = directory / "a", go = second.get_future().share()]() {
                    return std::move(one_file(path, go)[0]);
                  }}));
    return files;
  };
  background.start(begin(), false);
  EXPECT_FALSE(background.written());
  EXPECT_EQ(directory.files(), std::vector<std::string>{});
  first.set_value();
  // The second stage begins once all ranks have done the first one.
  while (directory.files().empty())
    EXPECT_FALSE(background.written());
  second.set_value();
  while (!background.written())
    ;
  background.finish();
  EXPECT_EQ(content(directory / "a"), all_parts());
}

TEST(BackgroundFiles, FinishThoseBefore)
{
  const ScratchDirectory directory;
  BackgroundFiles        background(MPI_COMM_WORLD);
  background.start(one_file(directory / "a", at_once()), false);
  background.start(one_file(directory / "b", at_once()), true);
  EXPECT_FALSE(background.pending());
  MPI_Barrier(MPI_COMM_WORLD);
  EXPECT_EQ(content(directory / "a"), all_parts());
  EXPECT_EQ(content(directory / "b"), all_parts());
}

// A disk that becomes full for the last rank while the run goes on.
TEST(BackgroundFiles, FailTogetherLater)
{
  const ScratchDirectory directory;
  on_root(MPI_COMM_WORLD, [&]() { write(directory / "a", "as it was"); });
  BackgroundFiles background(MPI_COMM_WORLD);
  {
    std::promise<void>      go;
    std::optional<FullDisk> full;
    background.start(one_file(directory / "a", go.get_future()), false);
    if (this_rank() + 1 == number_of_ranks())
      full.emplace(1);
    go.set_value();
    EXPECT_THROW(background.finish(), std::runtime_error);
  }
  EXPECT_FALSE(background.pending());
  EXPECT_EQ(directory.files(), std::vector<std::string>{"a"});
  EXPECT_EQ(content(directory / "a"), "as it was");
}

// A run that ends for another reason: nothing half-written is left.
TEST(BackgroundFiles, AreGivenUpAtTheEnd)
{
  const ScratchDirectory directory;
  {
    BackgroundFiles background(MPI_COMM_WORLD);
    background.start(one_file(directory / "a", at_once()), false);
  }
  EXPECT_EQ(directory.files(), std::vector<std::string>{});
}
