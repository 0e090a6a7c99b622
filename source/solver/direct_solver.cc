// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/solver/direct_solver.h>
#include <morula/solver/null_space.h>
#include <morula/solver/shifts.h>

#include <deal.II/lac/lapack_full_matrix.h>
#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/trilinos_solver.h>
#include <deal.II/lac/vector.h>

#include <Amesos.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace Morula
{
  namespace
  {
    using Vector = Equilibrium::Vector;
    using Matrix = Equilibrium::Matrix;

    /**
     * Solves A x = b in the space orthogonal to the null space N, where A,
     * factored by @p solver, is nearly singular. The motions that A gives no
     * stiffness are those of the deformed body, and not quite orthogonal to
     * that space: projecting A⁻¹b onto it would leave a large rotation. Solves
     * A x + N μ = b, Nᵀx = 0 instead.
     */
    void
    solve_bordered(const Matrix                   &A,
                   TrilinosWrappers::SolverDirect &solver,
                   const std::vector<Vector>      &N,
                   Vector                         &x,
                   const Vector                   &b)
    {
      if (N.empty())
        {
          solver.solve(x, b);
          return;
        }
      std::vector<Vector>      W;
      LAPACKFullMatrix<double> schur(N.size());
      for (unsigned int l = 0; l < N.size(); ++l)
        {
          W.emplace_back(b);
          solver.solve(W[l], N[l]);
          for (unsigned int k = 0; k < N.size(); ++k)
            schur(k, l) = N[k] * W[l];
        }
      schur.compute_lu_factorization();

      // The parts along the unsupported motions are huge and cancel: refine.
      x = 0.;
      Vector r(b), y(b);
      for (unsigned int i = 0; i < 3; ++i)
        {
          solver.solve(y, r);
          dealii::Vector<double> multipliers(N.size());
          for (unsigned int k = 0; k < N.size(); ++k)
            multipliers[k] = N[k] * y;
          schur.solve(multipliers);
          for (unsigned int l = 0; l < N.size(); ++l)
            y.add(-multipliers[l], W[l]);
          x += y;
          remove_parts(x, N);
          A.residual(r, x, b);
          remove_parts(r, N);
        }
    }

    /** Makes @p result K + σ |diag K|. */
    void
    shift_diagonal(const Matrix &K, const double shift, Matrix &result)
    {
      result.copy_from(K);
      for (const auto row : K.locally_owned_range_indices())
        result.add(row, row, shift * std::abs(K.diag_element(row)));
      result.compress(VectorOperation::add);
    }
  } // namespace

  void
  solve_direct(const Matrix        &K,
               const LinearProblem &problem,
               Vector              &x,
               const Vector        &b,
               unsigned int        &iterations,
               double              &largest_shift)
  {
    const std::string method =
      Amesos().Query("Amesos_Mumps") ? "Amesos_Mumps" : "Amesos_Klu";
    Vector balanced(b);
    remove_parts(balanced, problem.null_space);
    Matrix shifted;
    // With unsupported rigid motions K is singular. So small a shift costs
    // Newton's method nothing.
    const double least = problem.null_space.empty() ? 0. : 1e-9;
    double       shift = least;
    while (shift < Shifts::last)
      {
        if (shift > 0.)
          shift_diagonal(K, shift, shifted);
        SolverControl                  control(1, 0.);
        TrilinosWrappers::SolverDirect solver(
          control,
          TrilinosWrappers::SolverDirect::AdditionalData(false, method));
        ++iterations;
        bool singular = false;
        try
          {
            const Matrix &A = shift > 0. ? shifted : K;
            solver.initialize(A);
            solve_bordered(A, solver, problem.null_space, x, balanced);
          }
        catch (const ExceptionBase &)
          {
            singular = true;
          }
        // Not a direction of descent: the tangent is indefinite there.
        if (!singular && std::isfinite(x.l2_norm()) &&
            (!problem.symmetric || x * b > 0.))
          return;
        if (!singular && shift > least)
          largest_shift = std::max(largest_shift, shift);
        shift = std::max(Shifts::first, shift * Shifts::factor);
      }
    throw StepFailed("the direct solver found no direction of descent");
  }
} // namespace Morula
