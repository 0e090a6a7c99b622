// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_mechanics_linear_problem_h
#define morula_tests_mechanics_linear_problem_h

#include <morula/mechanics/equilibrium.h>

#include <deal.II/base/conditional_ostream.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/timer.h>

#include <functional>
#include <limits>
#include <vector>

#include "common/coupled_rows.h"

namespace Morula
{
  /** A timer that prints nothing. */
  class QuietTimer
  {
  public:
    operator TimerOutput &()
    {
      return timer;
    }

  private:
    ConditionalOStream stream{std::cout, false};
    TimerOutput timer{stream, TimerOutput::never, TimerOutput::wall_times};
  };

  /**
   * @p n unknowns, distributed in equal parts. What depends on the problem are
   * functions of numbers of unknowns; each unknown couples to its neighbours by
   * number.
   */
  class ChainProblem : public Equilibrium
  {
  public:
    /** K_ij for |i - j| <= 1, at u. */
    std::function<
      double(unsigned int, unsigned int, const std::vector<double> &)>
      stiffness;
    /** R_i at u. */
    std::function<double(unsigned int, const std::vector<double> &)> force;
    /** Energy at u. */
    std::function<double(const std::vector<double> &)> energy =
      [](const std::vector<double> &) { return 0.; };
    /** What the solvers are told besides. */
    LinearProblem linear;
    NewtonScales  scales;

    /** What Newton's method asked for. */
    std::vector<GrowthAt>       tangents;
    mutable std::vector<double> residual_norms;

    explicit ChainProblem(const unsigned int n)
      : n(n)
    {
      const unsigned int n_ranks =
        Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
      const unsigned int rank =
        Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
      owned = IndexSet(n);
      owned.add_range(n * rank / n_ranks, n * (rank + 1) / n_ranks);
      zero_.reinit(owned, MPI_COMM_WORLD);
    }

    Vector
    zero() const
    {
      return zero_;
    }

    Evaluation
    residual(const Vector &u, Vector &R) const override
    {
      const auto   values = gathered(u);
      const double e      = energy(values);
      if (!std::isfinite(e))
        return evaluation(e, 0.);
      R = zero();
      for (const auto i : owned)
        R(i) = force(i, values);
      residual_norms.push_back(R.l2_norm());
      return evaluation(e, std::abs(e));
    }

    double
    residual_magnitude(const Vector &) const override
    {
      return 1e-14 / std::numeric_limits<double>::epsilon();
    }

    const Matrix &
    tangent(const Vector &u, const GrowthAt growth) override
    {
      tangents.push_back(growth);
      const auto                        values = gathered(u);
      std::vector<BlockMatrix::Columns> columns;
      for (const auto row : owned)
        {
          columns.push_back({row});
          if (row > 0)
            columns.back().push_back(row - 1);
          if (row + 1 < n)
            columns.back().push_back(row + 1);
        }
      K.reinit(owned, columns, 1, linear.symmetric, MPI_COMM_WORLD);
      set(K,
          [&](const auto i, const auto j) { return stiffness(i, j, values); });
      return K;
    }

    /** All entries of a vector, on all ranks. */
    std::vector<double>
    gathered(const Vector &u) const
    {
      std::vector<double> values(n, 0.);
      for (const auto i : owned)
        values[i] = u(i);
      Utilities::MPI::sum(values, MPI_COMM_WORLD, values);
      return values;
    }

    Vector
    vector_of(const std::vector<double> &values) const
    {
      Vector vector = zero();
      for (const auto i : owned)
        vector(i) = values[i];
      return vector;
    }

    const unsigned int n;
    IndexSet           owned;

  private:
    static Evaluation
    evaluation(const double energy, const double magnitude)
    {
      Evaluation result;
      result.energy           = energy;
      result.energy_magnitude = magnitude;
      return result;
    }

    Matrix K;
    Vector zero_; // copies share its partition
  };


  /** @p n unknowns, all alike and uncoupled. */
  inline ChainProblem
  alike(const unsigned int                   n,
        const std::function<double(double)> &energy,
        const std::function<double(double)> &force,
        const std::function<double(double)> &stiffness)
  {
    ChainProblem problem(n);
    problem.energy = [=](const std::vector<double> &u) {
      double sum = 0.;
      for (const double x : u)
        sum += energy(x);
      return sum;
    };
    problem.force = [=](const unsigned int i, const std::vector<double> &u) {
      return force(u[i]);
    };
    problem.stiffness = [=](const unsigned int         i,
                            const unsigned int         j,
                            const std::vector<double> &u) {
      return i == j ? stiffness(u[i]) : 0.;
    };
    return problem;
  }
} // namespace Morula

#endif
