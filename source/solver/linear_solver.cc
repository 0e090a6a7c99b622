// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/equilibrium.h>
#include <morula/solver/conjugate_gradients.h>
#include <morula/solver/direct_solver.h>
#include <morula/solver/linear_solver.h>

#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/solver_gmres.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

namespace Morula
{
  namespace
  {
    using Vector = LinearSolver::Vector;
    using Matrix = LinearSolver::Matrix;

    // A system that takes more iterations than these goes to a fuller
    // factorisation, to the direct solver, or to a shorter step.
    constexpr unsigned int max_iterations = 2000;

    /** A matrix and what it lacks. */
    struct Sum
    {
      const BlockMatrix           &K;
      const Equilibrium::RankOnes &rank_ones;

      void
      vmult(Vector &y, const Vector &x) const
      {
        K.vmult(y, x);
        add_rank_ones(y, rank_ones, x);
      }
    };

    /** An operator, and then the removal of the null space. */
    template <typename Operator>
    struct Projected
    {
      const Operator            &apply;
      const std::vector<Vector> &null_space;

      void
      vmult(Vector &y, const Vector &x) const
      {
        apply.vmult(y, x);
        remove_parts(y, null_space);
      }
    };

  } // namespace

  /** K x = b; see solve(). */
  struct LinearSolver::System
  {
    const Matrix                &K;
    Vector                      &x;
    const Vector                &b;
    const double                 tolerance;
    unsigned int                &iterations;
    const Equilibrium::RankOnes &rank_ones;
  };

  LinearSolver::LinearSolver(const SolverParameters &parameters,
                             const LinearProblem    &problem,
                             TimerOutput            &timer)
    : is_direct(parameters.linear_solver == "direct")
    , automatic(parameters.linear_solver == "automatic")
    , problem(problem)
    , timer(timer)
    , preconditioner(problem)
    , direct(std::make_unique<DirectSolver>(problem))
  {}

  LinearSolver::~LinearSolver() = default;

  void
  LinearSolver::solve(const Matrix                &K,
                      Vector                      &x,
                      const Vector                &b,
                      const double                 tolerance,
                      unsigned int                &iterations,
                      const bool                   as_before,
                      const Equilibrium::RankOnes &rank_ones)
  {
    // The preconditioner is made from the first matrix of the attempt, and
    // kept: making it costs as much as many iterations. Where the iterative
    // method fails, an automatic solver turns to a factorisation, unless the
    // system is so large that half the step is the better answer.
    curvature_ = 0.;
    if (!as_before)
      direct->forget();
    if (!is_direct && !prepared)
      {
        const TimerOutput::Scope section(timer, "preconditioner");
        preconditioner.make_next(K);
        prepared = true;
      }
    const TimerOutput::Scope section(timer, "linear solver");
    const System             system{
      K, x, b, std::min(tolerance, largest_tolerance), iterations, rank_ones};
    try
      {
        if (is_direct)
          solve_directly(system);
        else if (problem.symmetric)
          solve_symmetric(system);
        else
          solve_unsymmetric(system);
      }
    catch (const StepFailed &failure)
      {
        // The user has asked for an iterative solver, or the direct one has
        // failed itself.
        if (!automatic)
          throw;
        if (b.size() > problem.most_to_factorise)
          throw StepFailed(failure.what() +
                           ("; " + std::to_string(b.size()) +
                            " unknowns are too many to factorise unless "
                            "Solver/Linear solver = direct"));
        solve_directly(system);
      }
  }

  void
  LinearSolver::solve_directly(const System &s)
  {
    // A direct solver's shift stands for the curvature that it has met.
    double shift = 0.;
    direct->solve(s.K, s.x, s.b, s.iterations, shift, s.rank_ones);
    if (direct->has_shifted())
      curvature_ = std::min(curvature_, -shift);
    has_shifted_ = has_shifted_ || direct->has_shifted();
  }

  void
  LinearSolver::solve_symmetric(const System &s)
  {
    // Each pass solves with one shift and one preconditioner. Negative
    // curvature asks for a larger shift, doc/theory.md (5.4); that the
    // iteration stalls asks for the next, fuller factorisation, and for Jacobi
    // after the last. From a shift of 1 on Jacobi, which contains the shift, is
    // the better preconditioner. It ends where even Jacobi stalls, or where the
    // shift has no sensible size any more.
    double shift = 0., needed = 0.;
    while (shift < Shifts::last)
      {
        const ShiftedSystem system{s.K, problem.null_space, shift, s.rank_ones};
        const auto          iterate = [&](const auto &P) {
          return conjugate_gradients(system,
                                     P,
                                     s.x,
                                     s.b,
                                     s.tolerance,
                                     max_iterations,
                                     s.iterations,
                                     needed);
        };
        const OverlappingCholesky *const factorisation =
          shift < Shifts::for_jacobi ? preconditioner.factorisation() : nullptr;
        const CgOutcome outcome =
          factorisation != nullptr ?
            iterate(*factorisation) :
            iterate(jacobi(diagonal_magnitude(s.K, s.b), shift));
        has_shifted_ = has_shifted_ || shift > 0.;
        if (outcome == CgOutcome::converged)
          return;
        if (outcome == CgOutcome::negative_curvature)
          curvature_ = std::min(curvature_, -needed);
        if (outcome == CgOutcome::negative_curvature)
          shift = std::max({Shifts::least,
                            Shifts::curvature_factor * needed,
                            Shifts::factor * shift});
        else if (factorisation != nullptr)
          preconditioner.make_next(s.K); // that one was of no use
        else
          break;
      }
    throw StepFailed("the conjugate gradient method did not converge");
  }

  void
  LinearSolver::solve_unsymmetric(const System &s)
  {
    // The system is solved in the space orthogonal to the unsupported motions:
    // right-hand side, matrix and preconditioner are projected, and the
    // solution in the end. The preconditioner is that of the symmetric part,
    // doc/theory.md, section 5.4. NoConvergence is that of deal.II's control;
    // its iterations count as well.
    Vector balanced(s.b);
    remove_parts(balanced, problem.null_space);
    SolverControl control(max_iterations, s.tolerance * balanced.l2_norm());
    // The preconditioner acts from the right, so that the tolerance is one for
    // the residual. From the left it would be one for the preconditioned
    // residual, which can be far from it. The flexible form adds up the
    // preconditioned vectors themselves: in single precision these differ from
    // a linear map's by more than a tight tolerance allows.
    // Restarting after 100 vectors bounds the memory.
    SolverFGMRES<Vector> gmres(control,
                               SolverFGMRES<Vector>::AdditionalData(100));
    s.x = 0.;
    try
      {
        const Sum            sum{s.K, s.rank_ones};
        const Projected<Sum> A{sum, problem.null_space};
        const auto           iterate = [&](const auto &P) {
          const Projected<std::decay_t<decltype(P)>> projected{
            P, problem.null_space};
          gmres.solve(A, s.x, balanced, projected);
        };
        if (preconditioner.factorisation() != nullptr)
          iterate(*preconditioner.factorisation());
        else
          iterate(jacobi(diagonal_magnitude(s.K, s.b), 0.));
        remove_parts(s.x, problem.null_space);
      }
    catch (const SolverControl::NoConvergence &)
      {
        s.iterations += control.last_step();
        throw StepFailed("GMRES did not converge");
      }
    s.iterations += control.last_step();
  }


  MakeLinearSolver
  make_linear_solvers(const SolverParameters &parameters)
  {
    struct SilentSolver
    {
      SilentSolver(const SolverParameters &parameters,
                   const LinearProblem    &problem)
        : timer(std::cout, TimerOutput::never, TimerOutput::wall_times)
        , solver(parameters, problem, timer)
      {}

      TimerOutput  timer;
      LinearSolver solver;
    };
    return [&parameters](const LinearProblem &problem) -> SolveLinear {
      // The function that is returned may be copied, while the solver with its
      // preconditioner may not. So copies share one solver.
      const auto own = std::make_shared<SilentSolver>(parameters, problem);
      return [own](const Equilibrium::Matrix &A,
                   Equilibrium::Vector       &x,
                   const Equilibrium::Vector &b,
                   const double               tolerance) {
        unsigned int iterations = 0;
        own->solver.solve(A, x, b, tolerance, iterations);
        // A solver that had to shift the matrix has solved another problem.
        return !own->solver.has_shifted();
      };
    };
  }
} // namespace Morula
