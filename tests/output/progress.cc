// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "output/room.h"

StatisticsRow
row(const double time)
{
  StatisticsRow row;
  row.step              = 12;
  row.time              = time;
  row.dt                = 0.05;
  row.cells             = 65752;
  row.newton_iterations = 4;
  return row;
}

/** The estimate after @p done days of 4 that cost cost(t) seconds so far. */
template <typename Cost>
double
left_after(const double done, const Cost &cost)
{
  TimeLeft time_left(0., 4.);
  for (unsigned int step = 1; step <= 20; ++step)
    time_left.add(done * step / 20., cost(done * step / 20.));
  return time_left.seconds();
}

TEST(TimeLeft, IsUnknownAtFirstAndNothingAtTheEnd)
{
  TimeLeft time_left(1., 3.);
  EXPECT_EQ(time_left.seconds(), -1.);
  time_left.add(1.5, 10.);
  EXPECT_NEAR(time_left.seconds(), 30., 1e-12);
  time_left.add(3., 50.);
  EXPECT_EQ(time_left.seconds(), 0.);
  TimeLeft after_setup(1., 3.);
  after_setup.add(1., 6.);
  EXPECT_EQ(after_setup.seconds(), -1.);
  after_setup.add(1.5, 10.);
  EXPECT_NEAR(after_setup.seconds(), 12., 1e-12);
}

TEST(TimeLeft, FollowsTheCost)
{
  EXPECT_NEAR(left_after(1., [](double t) { return 10. * t; }), 30., 1e-9);
  EXPECT_NEAR(left_after(1., [](double t) { return 10. * t * t; }), 150., 1e-9);
  // cells that double within a day: after half of the time, the truth is 120
  const double estimate =
    left_after(2., [](double t) { return 10. * (std::exp2(t) - 1.); });
  // (a constant cost would give 30)
  EXPECT_NEAR(estimate, 60., 1e-9);
  // a dear beginning is not taken for a trend
  EXPECT_GT(left_after(1., [](double t) { return 100. + t; }), 50.);
}

TEST(TimeLeft, IsPrintedForPeople)
{
  EXPECT_EQ(duration(0.), "0 s");
  EXPECT_EQ(duration(59.4), "59 s");
  EXPECT_EQ(duration(200.), "3 min 20 s");
  EXPECT_EQ(duration(3599.6), "1 h 00 min");
  EXPECT_EQ(duration(7500.), "2 h 05 min");
  EXPECT_EQ(duration(97200.), "1 d 03 h");
}

TEST(ProgressLine, SaysWhatTheStepDid)
{
  EXPECT_EQ(progress_line(row(0.6), 4., 200., 125.),
            "step 12: day 0.6 of 4, 65752 cells, 4 iterations, 3 min 20 s, "
            "2 min 05 s left");
  EXPECT_EQ(progress_line(row(0.6), 4., 200., -1.),
            "step 12: day 0.6 of 4, 65752 cells, 4 iterations, 3 min 20 s");
}

TEST(Summary, HasALineForEachNumber)
{
  StatisticsRow row;
  row.time                = 4.;
  row.cells               = 7468;
  row.tissue.total_volume = 7.54e6;
  row.step                = 80;
  row.wall_seconds        = 200.;
  EXPECT_EQ(summary_block("Finished", 3, row, 2, "output/"),
            "Finished\n"
            "  day             4\n"
            "  cells           7468\n"
            "  volume          7.54e+06 um^3\n"
            "  steps           80, 2 rejected\n"
            "  wall time       3 min 20 s\n"
            "  error in time   none to estimate\n"
            "  files in        output/");
}

TEST(Progress, PutsOneLineAStepIntoTheLog)
{
  const ScratchDirectory directory;
  const std::string      path = directory / "log.txt";
  {
    Progress progress(path, false, 0., 4., MPI_COMM_WORLD);
    progress.message("Morula");
    progress.step(row(1.), 200.);
  }
  const std::string first =
    "Morula\n" + progress_line(row(1.), 4., 200., 600.) + '\n';
  EXPECT_EQ(content(path), first);
  MPI_Barrier(MPI_COMM_WORLD);
  {
    Progress progress(path, true, 1., 4., MPI_COMM_WORLD);
    progress.step(row(2.), 200.);
    progress.fail("too late");
  }
  MPI_Barrier(MPI_COMM_WORLD);
  EXPECT_EQ(content(path),
            first + progress_line(row(2.), 4., 200., 400.) + "\ntoo late\n");
}

TEST(Progress, SaysWhenTheLogCannotBeWritten)
{
  const ScratchDirectory directory;
  EXPECT_THROW(
    Progress(directory / "none/log.txt", false, 0., 1., MPI_COMM_WORLD),
    std::runtime_error);
  Progress       progress(directory / "log.txt", false, 0., 1., MPI_COMM_WORLD);
  const FullDisk full(3);
  EXPECT_THROW(progress.message("a long message"), std::runtime_error);
  EXPECT_NO_THROW(progress.fail("another"));
}

TEST(Timings, HaveARowPerSectionEntered)
{
  TimerOutput timer(MPI_COMM_WORLD,
                    std::cout,
                    TimerOutput::never,
                    TimerOutput::wall_times);
  for (unsigned int i = 0; i < 3; ++i)
    {
      const TimerOutput::Scope scope(timer, "assembly");
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  SectionTimes times =
    section_times(timer, {{"assembly", {2., 1000.}}, {"output", {1., 10.}}});
  EXPECT_EQ(times.size(), 2u);
  EXPECT_EQ(times["assembly"].calls, 5.);
  EXPECT_GT(times["assembly"].wall_seconds, 1000.029);
  EXPECT_LT(times["assembly"].wall_seconds, 1010.);

  times["assembly"].wall_seconds = 1000.;
  const ScratchDirectory directory;
  write_timings(directory / "timings.csv", times, 1600., MPI_COMM_WORLD);
  EXPECT_EQ(content(directory / "timings.csv"),
            "section,calls,wall_seconds,share\n"
            "assembly,5,1000,0.625\n"
            "output,1,10,0.00625\n"
            "total,1,1600,1\n");
}
