// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/solver/direct_solver.h>
#include <morula/solver/null_space.h>
#include <morula/solver/shifts.h>

#include <deal.II/lac/vector.h>

#include <Amesos.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace Morula
{
  namespace
  {
    /** Makes @p result K + σ |diag K|. */
    void
    shift_diagonal(const Equilibrium::Matrix &K,
                   const double               shift,
                   Equilibrium::Matrix       &result)
    {
      result.copy_from(K);
      for (const auto row : K.locally_owned_range_indices())
        result.add(row, row, shift * std::abs(K.diag_element(row)));
      result.compress(VectorOperation::add);
    }
  } // namespace

  // With unsupported rigid motions K is singular, and a factorisation breaks
  // down. The least shift, 1e-9 of the diagonal, prevents that, and is so small
  // that Newton's method converges as before.
  DirectSolver::DirectSolver(const LinearProblem &problem)
    : problem(problem)
    , least_shift(problem.null_space.empty() ? 0. : 1e-9)
    , shift(least_shift)
  {}

  void
  DirectSolver::forget()
  {
    factor.reset();
    shift = least_shift;
  }

  void
  DirectSolver::factorize(const Matrix &K)
  {
    // One factor serves all solves until the next tangent. A shift goes into a
    // copy, since residuals need K itself. The old factor is freed before the
    // new one is made, as both together would take twice the memory. MUMPS
    // works on all ranks; KLU gathers the matrix on one of them.
    const std::string method =
      Amesos().Query("Amesos_Mumps") ? "Amesos_Mumps" : "Amesos_Klu";
    if (shift > 0.)
      shift_diagonal(K, shift, shifted);
    factor.reset(); // the old one's memory first
    auto made = std::make_unique<TrilinosWrappers::SolverDirect>(
      control, TrilinosWrappers::SolverDirect::AdditionalData(false, method));
    made->initialize(shift > 0. ? shifted : K);

    // The bordered system (see solve_bordered()) needs A⁻¹ N and the small
    // matrix Nᵀ A⁻¹ N, once for each factor.
    const std::vector<Vector> &N = problem.null_space;
    solutions_of_null_space.clear();
    if (!N.empty())
      schur.reinit(N.size());
    for (unsigned int l = 0; l < N.size(); ++l)
      {
        solutions_of_null_space.emplace_back(N[l]);
        made->solve(solutions_of_null_space[l], N[l]);
        for (unsigned int k = 0; k < N.size(); ++k)
          schur(k, l) = N[k] * solutions_of_null_space[l];
      }
    if (!N.empty())
      schur.compute_lu_factorization();
    factor = std::move(made);
  }

  /**
   * Solves A x = b in the space orthogonal to the null space N, where A, the
   * factored matrix, is nearly singular. The motions that A gives no stiffness
   * are those of the deformed body, and not quite orthogonal to that space:
   * projecting A⁻¹b onto it would leave a large rotation. Solves
   * A x + N μ = b, Nᵀx = 0 instead.
   */
  void
  DirectSolver::solve_bordered(const Matrix &K, Vector &x, const Vector &b)
  {
    const std::vector<Vector> &N = problem.null_space;
    if (N.empty())
      {
        factor->solve(x, b);
        return;
      }
    // The parts along the unsupported motions are huge and cancel in the
    // difference, so digits are lost. Three passes of iterative refinement,
    // with residuals of A itself, bring them back.
    const Matrix &A = shift > 0. ? shifted : K;
    x               = 0.;
    Vector r(b), y(b);
    for (unsigned int i = 0; i < 3; ++i)
      {
        // The multipliers μ follow from Nᵀ x = 0: (Nᵀ A⁻¹ N) μ = Nᵀ A⁻¹ r.
        factor->solve(y, r);
        dealii::Vector<double> multipliers(N.size());
        for (unsigned int k = 0; k < N.size(); ++k)
          multipliers[k] = N[k] * y;
        schur.solve(multipliers);
        for (unsigned int l = 0; l < N.size(); ++l)
          y.add(-multipliers[l], solutions_of_null_space[l]);
        x += y;
        remove_parts(x, N);
        A.residual(r, x, b);
        remove_parts(r, N);
      }
  }

  // The system has the matrix K + σ b bᵀ. The formula of Sherman and Morrison
  // corrects x = K⁻¹ r by one more solution, w = K⁻¹ b.
  void
  DirectSolver::add_correction(const Matrix               &K,
                               const Equilibrium::RankOne &part,
                               Vector                     &x)
  {
    Vector b(part.b), w(part.b);
    remove_parts(b, problem.null_space);
    solve_bordered(K, w, b);
    x.add(-part.factor * (b * x) / (1. + part.factor * (b * w)), w);
  }

  void
  DirectSolver::solve(const Matrix               &K,
                      Vector                     &x,
                      const Vector               &b,
                      unsigned int               &iterations,
                      double                     &largest_shift,
                      const Equilibrium::RankOne *rank_one)
  {
    // What acts along unsupported motions is left out, as inertia balances it:
    // doc/theory.md (4.10). A direct solver sees no curvature, so the diagonal
    // is raised, doc/theory.md (5.4), until x is a direction of descent; each
    // trial is a factorisation. An exception of the library means a singular
    // matrix, and is a trial that failed. The factor that worked is kept, with
    // its shift, for later calls.
    Vector balanced(b);
    remove_parts(balanced, problem.null_space);
    while (shift < Shifts::last)
      {
        bool singular = false;
        try
          {
            if (!factor)
              {
                ++iterations;
                factorize(K);
              }
            solve_bordered(K, x, balanced);
            if (rank_one != nullptr)
              add_correction(K, *rank_one, x);
          }
        catch (const ExceptionBase &)
          {
            singular = true;
          }
        // An unsymmetric system has no energy, so any finite solution will do.
        // Of a symmetric one a direction along which the energy rises shows
        // that the tangent is indefinite.
        if (!singular && std::isfinite(x.l2_norm()) &&
            (!problem.symmetric || x * b > 0.))
          return;
        if (!singular && shift > least_shift)
          largest_shift = std::max(largest_shift, shift);
        factor.reset();
        shift = std::max(Shifts::first, shift * Shifts::factor);
      }
    throw StepFailed("the direct solver found no direction of descent");
  }
} // namespace Morula
