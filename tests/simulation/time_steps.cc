// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "simulation/room.h"

TimeParameters
times(const double end, const double step, const double smallest = 1e-4)
{
  TimeParameters parameters;
  parameters.end_time      = end;
  parameters.step          = step;
  parameters.smallest_step = smallest;
  return parameters;
}

/** Ends of all steps that follow, if none fails. */
std::vector<double>
all_ends(TimeSteps &steps)
{
  std::vector<double> ends;
  while (!steps.finished())
    {
      ends.push_back(steps.next());
      EXPECT_GT(steps.next(), steps.time());
      steps.accept();
      EXPECT_EQ(steps.time(), ends.back());
      if (ends.size() > 100000)
        break;
    }
  return ends;
}

void
expect_times(const std::vector<double> &found,
             const std::vector<double> &expected)
{
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_NEAR(found[i], expected[i], 1e-14);
}


TEST(TimeSteps, AreExactMultiples)
{
  TimeSteps  steps(times(100., 0.1));
  const auto ends = all_ends(steps);
  ASSERT_EQ(ends.size(), 1000u);
  for (unsigned int i = 0; i + 1 < ends.size(); ++i)
    EXPECT_EQ(ends[i], (i + 1) * 0.1);
  EXPECT_EQ(ends.back(), 100.);
}


TEST(TimeSteps, EndTimeCutsTheLast)
{
  {
    TimeSteps steps(times(0.13, 0.05));
    expect_times(all_ends(steps), {0.05, 0.1, 0.13});
    EXPECT_EQ(steps.time(), 0.13);
  }
  {
    // 3 * 0.1 > 0.3: no fourth step of rounding's length.
    TimeSteps steps(times(0.3, 0.1));
    EXPECT_EQ(all_ends(steps).size(), 3u);
    EXPECT_EQ(steps.time(), 3 * 0.1);
  }
  {
    TimeSteps steps(times(0.02, 0.05));
    EXPECT_EQ(all_ends(steps), (std::vector<double>{0.02}));
  }
  {
    TimeSteps steps(times(0., 0.05));
    EXPECT_TRUE(steps.finished());
  }
}


TEST(TimeSteps, ARejectedStepIsHalvedAndCoarsenedOneLevelAtATime)
{
  TimeSteps steps(times(3., 1.));
  steps.accept();
  EXPECT_TRUE(steps.reject()); // [1, 1.5]
  EXPECT_EQ(steps.time(), 1.);
  EXPECT_EQ(steps.next(), 1.5);
  EXPECT_TRUE(steps.reject()); // [1, 1.25]
  EXPECT_EQ(steps.next(), 1.25);
  steps.accept();
  EXPECT_EQ(steps.next(), 1.5); // the second quarter
  EXPECT_TRUE(steps.reject());
  EXPECT_EQ(steps.next(), 1.375);
  // Four eighths, as this is the second failure, then quarters: no step is more
  // than twice as long as the last.
  EXPECT_EQ(all_ends(steps),
            (std::vector<double>{1.375, 1.5, 1.625, 1.75, 2., 3.}));
}


/** Steps that succeed until the next one is as long as @p length. */
unsigned int
steps_until(TimeSteps &steps, const double length)
{
  unsigned int n = 0;
  for (; n < 1000 && steps.next() - steps.time() < length; ++n)
    steps.accept();
  return n;
}


TEST(TimeSteps, LearnWhenALongerStepIsWorthATry)
{
  // Each failure doubles the wait, up to 32 steps; in halves of a step the
  // longer one comes at a multiple of two.
  TimeSteps steps(times(1000., 1.));
  for (const unsigned int wait : {2, 4, 8, 16, 32, 32})
    {
      EXPECT_TRUE(steps.reject());
      EXPECT_EQ(steps_until(steps, 1.), wait);
    }
  // Another failure of the same step teaches nothing.
  EXPECT_TRUE(steps.reject());
  EXPECT_TRUE(steps.reject());
  EXPECT_EQ(steps.state().patience, 32u);
  // What has been learned is forgotten again, and outlives a run.
  for (unsigned int i = 0; i < 96; ++i)
    steps.accept();
  EXPECT_EQ(steps.state().patience, 16u);
  TimeSteps again(times(1000., 1.));
  again.restore(steps.state());
  EXPECT_EQ(steps.next() - steps.time(), 1.);
  EXPECT_TRUE(steps.reject());
  EXPECT_TRUE(again.reject());
  EXPECT_EQ(steps_until(steps, 1.), 32u);
  EXPECT_EQ(steps_until(again, 1.), 32u);
}


TEST(TimeSteps, HeldBackStepsStayShort)
{
  // The drag goes first, by half of it a step after two steps; then steps
  // become longer.
  TimeSteps steps(times(4., 1., 0.1));
  EXPECT_TRUE(steps.hold_back(false)); // [0, 0.25]
  std::vector<double> drags;
  while (steps.state().drag > 1.)
    {
      EXPECT_EQ(steps.next() - steps.time(), 0.25); // also in later intervals
      drags.push_back(steps.state().drag);
      steps.accept();
    }
  ASSERT_EQ(drags.size(), 11u);
  EXPECT_EQ(drags[1], 1000.);
  for (unsigned int i = 2; i < drags.size(); ++i)
    EXPECT_EQ(drags[i], 0.5 * drags[i - 1]);
  EXPECT_EQ(all_ends(steps), (std::vector<double>{3., 4.}));
  // Where a strand turns by more than half of what it may the drag becomes
  // stronger, and by more than a quarter it stays.
  TimeSteps turning(times(4., 1., 0.1));
  EXPECT_TRUE(turning.hold_back(false));
  const std::vector<std::pair<double, double>> turns_and_drags{
    {0.25, 1000.}, {1., 2000.}, {0.5, 2000.}, {0.25, 1000.}, {0.25, 500.}};
  for (const auto &[turn, drag] : turns_and_drags)
    {
      turning.accept(turn);
      EXPECT_EQ(turning.state().drag, drag);
    }
  // A step that has gone too far is made shorter before it is held back.
  TimeSteps far(times(4., 1., 0.1));
  EXPECT_TRUE(far.hold_back(true));
  EXPECT_EQ(far.next(), 0.25);
  EXPECT_EQ(far.state().drag, 1.);
  EXPECT_TRUE(far.hold_back(true));
  EXPECT_EQ(far.state().drag, 1000.);
  // At last only halving is left.
  while (far.hold_back(true))
    EXPECT_LT(far.state().drag, 1e7);
  EXPECT_EQ(far.next(), 0.25);
}


TEST(TimeSteps, RejectsDownToTheSmallestStep)
{
  TimeSteps steps(times(1., 0.1, 0.0125));
  for (unsigned int i = 1; i <= 3; ++i)
    {
      EXPECT_TRUE(steps.reject());
      EXPECT_NEAR(steps.next(), 0.1 / (1 << i), 1e-15);
    }
  EXPECT_FALSE(steps.reject());
  // It stands where it stood.
  EXPECT_EQ(steps.time(), 0.);
  EXPECT_NEAR(steps.next(), 0.0125, 1e-15);
  EXPECT_FALSE(TimeSteps(times(1., 0.1, 0.06)).reject());
}


TEST(TimeSteps, HalvesOfTheLastStepEndAtEndTime)
{
  TimeSteps steps(times(0.13, 0.1));
  steps.accept();
  EXPECT_TRUE(steps.reject());
  expect_times(all_ends(steps), {0.115, 0.13});
  EXPECT_EQ(steps.time(), 0.13);
}


TEST(TimeSteps, ARestoredRunGoesOnTheSameWay)
{
  TimeSteps steps(times(2.05, 0.1));
  for (unsigned int i = 0; i < 7; ++i)
    steps.accept();
  steps.reject();
  steps.reject();
  steps.accept();
  TimeSteps again(times(2.05, 0.1));
  again.restore(steps.state());
  EXPECT_EQ(again.time(), steps.time());
  EXPECT_EQ(all_ends(again), all_ends(steps));
}


TEST(TimeSteps, ALaterEndTimeContinuesTheMultiples)
{
  TimeSteps steps(times(0.13, 0.05));
  all_ends(steps);
  TimeSteps again(times(0.21, 0.05));
  again.restore(steps.state());
  EXPECT_FALSE(again.finished());
  EXPECT_EQ(again.time(), 0.13);
  expect_times(all_ends(again), {0.15, 0.2, 0.21});

  // At a multiple, which is that of the longer run to the bit.
  TimeSteps whole(times(0.3, 0.1));
  all_ends(whole);
  EXPECT_EQ(whole.time(), 3 * 0.1);
  TimeSteps longer(times(0.5, 0.1));
  longer.restore(whole.state());
  expect_times(all_ends(longer), {0.4, 0.5});
}


TEST(TimeSteps, AnotherStepContinuesAtItsOwnMultiples)
{
  TimeSteps steps(times(1., 0.1));
  for (unsigned int i = 0; i < 3; ++i)
    steps.accept();
  TimeSteps finer(times(0.5, 0.04));
  finer.restore(steps.state());
  EXPECT_EQ(finer.time(), steps.time());
  expect_times(all_ends(finer), {0.32, 0.36, 0.4, 0.44, 0.48, 0.5});

  // From within a halved step.
  steps.reject();
  steps.accept();
  TimeSteps coarser(times(1., 0.25));
  coarser.restore(steps.state());
  EXPECT_NEAR(coarser.time(), 0.35, 1e-15);
  expect_times(all_ends(coarser), {0.5, 0.75, 1.});

  // An End time that has been passed.
  TimeSteps earlier(times(0.2, 0.1));
  earlier.restore(steps.state());
  EXPECT_TRUE(earlier.finished());
  EXPECT_NEAR(earlier.time(), 0.35, 1e-15);
}


TimeParameters
tolerant(const double end, const double step, const double tolerance)
{
  TimeParameters parameters = times(end, step);
  parameters.tolerance      = tolerance;
  return parameters;
}

/** Runs on while each step misses @p rate times the square of its length.
 *  @return the lengths */
std::vector<double>
lengths(TimeSteps &steps, const double rate, const unsigned int n)
{
  std::vector<double> list;
  for (unsigned int i = 0; i < n && !steps.finished(); ++i)
    {
      steps.adapt(rate * steps.past().length() * steps.past().length());
      list.push_back(steps.next() - steps.time());
      steps.accept();
    }
  return list;
}


TEST(TimeSteps, KnowTheStepThatLedHere)
{
  TimeSteps steps(times(3., 1.));
  EXPECT_FALSE(steps.past().exists());
  steps.accept();
  steps.reject();
  steps.accept();
  EXPECT_EQ(steps.past().begin, 1.);
  EXPECT_EQ(steps.past().end, 1.5);
  EXPECT_EQ(steps.past().middle(), 1.25);
  EXPECT_EQ(steps.past().length(), 0.5);
  // Also in a resumed run with another step.
  TimeSteps resumed(times(3., 0.2));
  resumed.restore(steps.state());
  EXPECT_EQ(resumed.past().begin, 1.);
  EXPECT_EQ(resumed.past().end, 1.5);
}


TEST(TimeSteps, ChooseTheirLengthByTheError)
{
  // Short at first; then longer, one doubling a step, as far as the error
  // allows: 0.01 = 1 dt² at 0.1, so that 1/16 is the longest, with a margin of
  // √2.
  TimeSteps steps(tolerant(4., 1., 0.01));
  expect_times(lengths(steps, 1., 4), {0.0625, 0.0625, 0.0625, 0.0625});
  // Less error: doubled where two halves are one step. A level outlives the end
  // of its interval.
  expect_times(lengths(steps, 0.07, 8),
               {0.125, 0.125, 0.25, 0.25, 0.25, 0.25, 0.25, 0.25});
  // Much more: at once.
  expect_times(lengths(steps, 3., 2), {0.03125, 0.03125});
  // After a cut it begins anew, and does not double at once.
  TimeSteps cut(tolerant(100., 1., 0.01));
  lengths(cut, 1e-9, 40);
  EXPECT_EQ(cut.next() - cut.time(), 1.);
  cut.begin_anew();
  expect_times(lengths(cut, 1e-9, 5), {0.0625, 0.0625, 0.125, 0.25, 0.5});
  // What a step misses goes with the square of its length, also after a cut.
  TimeSteps other(tolerant(100., 1., 0.01));
  lengths(other, 1e-9, 40);
  other.begin_anew();
  expect_times(lengths(other, 0.5, 1), {0.0625});
  // All end at multiples of Step/2^k, and the run at its end.
  TimeSteps whole(tolerant(0.7, 0.2, 1e-3));
  while (!whole.finished())
    lengths(whole, 1., 1);
  EXPECT_EQ(whole.time(), 0.7);
}


TEST(TimeSteps, ToleranceNeverGoesBelowTheSmallestStep)
{
  TimeParameters parameters = times(1., 1., 0.2);
  parameters.tolerance      = 1e-12;
  TimeSteps steps(parameters);
  EXPECT_EQ(steps.next(), 0.25);
  steps.accept();
  steps.adapt(1.);
  EXPECT_EQ(steps.next(), 0.5);
}


TEST(TimeSteps, AResumedRunChoosesTheSame)
{
  TimeSteps  whole(tolerant(4., 0.5, 0.01)), first(tolerant(4., 0.5, 0.01));
  const auto all   = lengths(whole, 0.3, 30);
  auto       parts = lengths(first, 0.3, 7);
  TimeSteps  rest(tolerant(4., 0.5, 0.01));
  rest.restore(first.state());
  for (const double dt : lengths(rest, 0.3, 23))
    parts.push_back(dt);
  EXPECT_EQ(parts, all);
}
