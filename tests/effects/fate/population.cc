// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fate/cell_cycle.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

using namespace dealii;
using namespace Morula;

namespace
{
  constexpr std::uint64_t seed = 11;

  struct Cell
  {
    CycleState<2> state;
    Point<2>      X;
    unsigned int  founder;
    unsigned int  generation;
  };

  /** Elastic volume ratio of a cell at a time. */
  using ElasticVolume = std::function<double(const Cell &, const double)>;

  const ElasticVolume at_rest = [](const Cell &, const double) { return 1.; };

  std::vector<Cell>
  seed_cells(const CellCycle<2> &cycle, const unsigned int n_founders)
  {
    std::vector<Cell> cells;
    for (unsigned int id = 0; id < n_founders; ++id)
      {
        const Point<2> X(id / static_cast<double>(n_founders), 0.);
        cells.push_back({cycle.founder(id, X), X, id, 0});
      }
    return cells;
  }

  /** One step; appends the exact times of the divisions. */
  std::vector<Cell>
  step(const CellCycle<2>      &cycle,
       const std::vector<Cell> &cells,
       const double             t0,
       const double             t1,
       const ElasticVolume     &J_e,
       std::vector<double>     &division_times)
  {
    std::vector<Cell> next;
    for (Cell cell : cells)
      {
        cell.state = cycle.advance(cell.state, cell.X, t0, t1, J_e(cell, t0));
        if (!cycle.divides(cell.state, cell.X, t1))
          {
            next.push_back(cell);
            continue;
          }
        division_times.push_back(cycle.division_time(cell.state, cell.X));
        const auto daughters = cycle.daughters(cell.state);
        ++cell.generation;
        for (const auto &state : {daughters.first, daughters.second})
          {
            cell.state = state;
            next.push_back(cell);
          }
      }
    return next;
  }

  struct Outcome
  {
    std::vector<Cell>   cells;
    std::vector<double> division_times;
  };

  /** Cells by key and sorted division times at the end of a list of steps. */
  Outcome
  run(const CellCycle<2>        &cycle,
      const unsigned int         n_founders,
      const std::vector<double> &step_ends,
      const ElasticVolume       &J_e = at_rest)
  {
    Outcome outcome;
    outcome.cells = seed_cells(cycle, n_founders);
    double t0     = 0.;
    for (const double t1 : step_ends)
      {
        outcome.cells =
          step(cycle, outcome.cells, t0, t1, J_e, outcome.division_times);
        t0 = t1;
      }
    std::sort(outcome.cells.begin(),
              outcome.cells.end(),
              [](const Cell &a, const Cell &b) {
                return a.state.key < b.state.key;
              });
    std::sort(outcome.division_times.begin(), outcome.division_times.end());
    return outcome;
  }

  std::vector<double>
  uniform_steps(const double length, const double end)
  {
    std::vector<double> ends;
    for (unsigned int k = 1; k * length < end - 1e-9; ++k)
      ends.push_back(k * length);
    ends.push_back(end);
    return ends;
  }

  std::vector<double>
  random_steps(const double longest, const double end)
  {
    std::mt19937                           generator(5);
    std::uniform_real_distribution<double> length(0.001, longest);
    std::vector<double>                    ends;
    for (double t = length(generator); t < end; t += length(generator))
      ends.push_back(t);
    ends.push_back(end);
    return ends;
  }

  void
  expect_equal(const Outcome &a, const Outcome &b, const CellCycle<2> &cycle)
  {
    ASSERT_EQ(a.cells.size(), b.cells.size());
    for (unsigned int i = 0; i < a.cells.size(); ++i)
      {
        const Cell &cell = a.cells[i], &same = b.cells[i];
        EXPECT_EQ(cell.state.key, same.state.key);
        EXPECT_EQ(cell.state.phase, same.state.phase);
        EXPECT_EQ(cell.state.event_time, same.state.event_time);
        EXPECT_EQ(cell.state.axis, same.state.axis);
        EXPECT_EQ(cell.generation, same.generation);
        EXPECT_EQ(cycle.growth(cell.state, cell.X, 4.01),
                  cycle.growth(same.state, same.X, 4.01));
      }
    EXPECT_EQ(a.division_times, b.division_times);
  }

  /** P(N >= n) of a Poisson number N with this mean. */
  double
  poisson_tail(const double mean, const unsigned int n)
  {
    double term = std::exp(-mean), below = 0.;
    for (unsigned int k = 0; k < n; ++k)
      {
        below += term;
        term *= mean / (k + 1);
      }
    return 1. - below;
  }

  /**
   * Expected number of divisions until @p t in generation @p k among the
   * descendants of a founder that starts in G0. Of the 2^k possible cells of
   * that generation, each has divided if the k+1 independent waits of its line
   * sum up to less than t - kT - T/2.
   */
  double
  expected_divisions(const double       t,
                     const unsigned int k,
                     const double       T,
                     const double       rate)
  {
    const double waiting_time = t - (k + 0.5) * T;
    return waiting_time <= 0. ?
             0. :
             std::ldexp(poisson_tail(rate * waiting_time, k + 1), k);
  }

  /** Expected number of cells at @p t: a division adds one. */
  double
  expected_cells(const double t, const double T, const double rate)
  {
    double cells = 1.;
    for (unsigned int k = 0; (k + 0.5) * T < t; ++k)
      cells += expected_divisions(t, k, T, rate);
    return cells;
  }
} // namespace


TEST(Population, StepsDoNotMatter)
{
  CellCycleParameters parameters;
  parameters.duration  = "1 + 0.5 * X";
  parameters.exit_rate = "1 + 3 * X";
  parameters.where     = "X - 0.1";
  const CellCycle<2> cycle(parameters, seed, 1e-12);

  const double  end       = 4.01;
  const Outcome reference = run(cycle, 100, uniform_steps(0.05, end));
  EXPECT_GT(reference.cells.size(), 400u);
  expect_equal(reference, run(cycle, 100, uniform_steps(0.01, end)), cycle);
  expect_equal(reference, run(cycle, 100, uniform_steps(0.5, end)), cycle);
  expect_equal(reference, run(cycle, 100, random_steps(0.5, end)), cycle);
}


// The limit J_th -> 0 is no checkpoint, at any elastic volume.
TEST(Population, TinyCheckpointIsNone)
{
  const ElasticVolume varying = [](const Cell &cell, const double t) {
    return 0.5 + 0.4 * std::sin(20. * t + cell.founder);
  };
  CellCycleParameters parameters;
  const CellCycle<2>  without(parameters, seed, 1e-12);
  parameters.size_checkpoint = "1e-12";
  const CellCycle<2> tiny(parameters, seed, 1e-12);

  const auto    steps     = uniform_steps(0.1, 4.01);
  const Outcome reference = run(without, 200, steps);
  expect_equal(reference, run(without, 200, steps, varying), without);
  expect_equal(reference, run(tiny, 200, steps, varying), tiny);
}


TEST(Population, CheckpointStopsSmallCells)
{
  CellCycleParameters parameters;
  parameters.size_checkpoint = "0.9";
  const CellCycle<2> cycle(parameters, seed, 1e-12);

  // The upper half of the founders is held until t = 2.
  const ElasticVolume J_e = [](const Cell &cell, const double t) {
    return cell.X[0] >= 0.5 && t < 1.95 ? 0.9 : 1.;
  };
  const auto        steps = uniform_steps(0.1, 4.01);
  const Outcome     with  = run(cycle, 200, steps, J_e);
  const Outcome     free  = run(cycle, 200, steps);
  std::vector<Cell> lower_with, lower_free;
  const auto        lower = [](const Cell &c) { return c.founder < 100; };
  std::copy_if(with.cells.begin(),
               with.cells.end(),
               std::back_inserter(lower_with),
               lower);
  std::copy_if(free.cells.begin(),
               free.cells.end(),
               std::back_inserter(lower_free),
               lower);
  expect_equal({lower_with, {}}, {lower_free, {}}, cycle);

  // Most of the others were let go together, at the start of a step.
  EXPECT_GT(std::count_if(with.division_times.begin(),
                          with.division_times.end(),
                          [](const double t) {
                            return std::abs(t - 2.5) < 1e-12;
                          }),
            70);
  EXPECT_LT(with.cells.size(), free.cells.size());
}


// The closed form against the renewal equation for the number of cells from
// one that enters G0, integrated by the trapezoidal rule (error of order h^2):
// M(t) = exp(-(t-T/2)) + 2 int_0^{t-T/2} exp(-w) A(t-T/2-w) dw, where a
// daughter counts A(s) = 1 for s < T/2, then M(s-T/2); T = 1, rate 1.
TEST(Population, ExpectationSolvesTheRenewalEquation)
{
  const double        h    = 0.005;
  const unsigned int  half = 100, n = 801;
  std::vector<double> M(n, 1.), A(n, 1.);
  for (unsigned int i = 0; i < n; ++i)
    {
      if (i >= half)
        {
          const unsigned int m = i - half;
          M[i]                 = std::exp(-(m * h));
          for (unsigned int j = 0; j <= m; ++j)
            M[i] +=
              (j == 0 || j == m ? 1. : 2.) * h * std::exp(-(j * h)) * A[m - j];
          if (m == 0)
            M[i] = 1.;
        }
      if (i + half < n)
        A[i + half] = M[i];
      EXPECT_NEAR(M[i], expected_cells(i * h, 1., 1.), 1e-4);
    }
}


// The root of 2 exp(-rT) Lambda/(Lambda + r) = 1.
TEST(Population, ExpectationGrowsAtTheRootsRate)
{
  double r = 0.;
  for (double bit = 0.5; bit > 1e-15; bit *= 0.5)
    if (2. * std::exp(-(r + bit)) / (1. + r + bit) > 1.)
      r += bit;
  EXPECT_NEAR(r, 0.3748, 5e-5);
  EXPECT_NEAR(std::log(expected_cells(21., 1., 1.) /
                       expected_cells(20., 1., 1.)),
              r,
              2e-5);
}


// Mean numbers against the exact expectation, within four standard errors of
// the sample (founders are independent).
TEST(Population, NumbersMatchTheExpectation)
{
  struct Case
  {
    double T, rate, step;
  };
  for (const Case &c : {Case{1., 1., 0.1}, Case{0.6, 2.5, 0.25}})
    {
      CellCycleParameters parameters;
      parameters.duration  = std::to_string(c.T);
      parameters.exit_rate = std::to_string(c.rate);
      const CellCycle<2> cycle(parameters, seed, 1e-12);

      const unsigned int  n     = 8000;
      std::vector<Cell>   cells = seed_cells(cycle, n);
      std::vector<double> division_times;
      for (unsigned int k = 1; k * c.step < 4.01 * c.T; ++k)
        {
          const double t = k * c.step;
          cells = step(cycle, cells, t - c.step, t, at_rest, division_times);

          std::vector<unsigned int> clone_sizes(n);
          for (const Cell &cell : cells)
            ++clone_sizes[cell.founder];
          const double mean     = cells.size() / static_cast<double>(n);
          double       variance = 0.;
          for (const unsigned int size : clone_sizes)
            variance += (size - mean) * (size - mean) / n;
          EXPECT_NEAR(mean,
                      expected_cells(t, c.T, c.rate),
                      4. * std::sqrt(variance / n) + 1e-12)
            << "at t = " << t;
          EXPECT_EQ(division_times.size(), cells.size() - n);
        }

      // Generations at the end, with the binomial-like error of counts.
      const double t = std::floor(4.01 * c.T / c.step) * c.step;
      for (unsigned int k = 0; k < 4; ++k)
        {
          const auto count =
            std::count_if(cells.begin(), cells.end(), [k](const Cell &cell) {
              return cell.generation == k;
            });
          const double expected =
            (k == 0 ? 1. : 2. * expected_divisions(t, k - 1, c.T, c.rate)) -
            expected_divisions(t, k, c.T, c.rate);
          EXPECT_NEAR(count / double(n),
                      expected,
                      4. *
                        std::sqrt(std::ldexp(std::max(expected, 1e-4), k) / n))
            << "generation " << k;
        }
    }
}


// At the end of each cycle F_g has doubled: with V0 halved at each division,
// a founder's cells in G0 have its volume again.
TEST(Population, VolumeBookkeeping)
{
  const CellCycle<2> cycle(CellCycleParameters(), seed, 1e-12);
  const Outcome      outcome = run(cycle, 300, uniform_steps(0.1, 5.));

  unsigned int deepest = 0;
  for (const Cell &cell : outcome.cells)
    {
      const double initial_volume =
        std::ldexp(1., -static_cast<int>(cell.generation));
      const double grown =
        initial_volume * determinant(cycle.growth(cell.state, cell.X, 5.));
      deepest = std::max(deepest, cell.generation);
      if (cell.state.phase == CyclePhase::waiting)
        EXPECT_NEAR(grown, 1., 1e-13);
      else
        {
          const double theta = 6. - cell.state.event_time;
          EXPECT_NEAR(grown,
                      cell.state.phase == CyclePhase::growing ? theta :
                                                                theta / 2.,
                      1e-13);
        }
    }
  EXPECT_GE(deepest, 4u);
}
