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
      const HaloProduct           &K;
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

  /**
   * Solves (K + σ |diag K|) x = b with MUMPS, or KLU where Trilinos lacks it,
   * with the smallest tried σ that gives a direction of descent. The factor is
   * kept until it is forgotten.
   */
  class DirectSolver
  {
  public:
    using Vector = Equilibrium::Vector;
    using Matrix = Equilibrium::Matrix;

    /** @param problem kept as a reference */
    explicit DirectSolver(const LinearProblem &problem)
      : problem(problem)
      , least_shift(problem.null_space.empty() ? 0. : 1e-9)
      , shift(least_shift)
    {
      // With unsupported rigid motions K is singular, and a factorisation
      // breaks down. The least shift, 1e-9 of the diagonal, prevents that, and
      // is so small that Newton's method converges as before.
    }

    /** Forgets the factor, since the next matrix is another one. */
    void
    forget()
    {
      factor.reset();
      shift = least_shift;
    }

    /**
     * @param K the matrix of the last call, unless forget() was called since
     * @param iterations in/out: the factorisations are added
     * @param largest_shift in/out: raised to the largest σ at which the tangent
     *                      was still indefinite
     * @param rank_ones what K lacks
     * @throws StepFailed on all ranks together
     */
    void
    solve(const Matrix                &K,
          Vector                      &x,
          const Vector                &b,
          unsigned int                &iterations,
          double                      &largest_shift,
          const Equilibrium::RankOnes &rank_ones)
    {
      // What acts along unsupported motions is left out, as inertia balances
      // it: doc/theory.md (4.10). A direct solver sees no curvature, so the
      // diagonal is raised, doc/theory.md (5.4), until x is a direction of
      // descent; each trial is a factorisation. An exception of the library
      // means a singular matrix, and is a trial that failed. The factor that
      // worked is kept, with its shift, for later calls.
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
              add_corrections(K, rank_ones, x);
            }
          catch (const ExceptionBase &)
            {
              singular = true;
            }
          // An unsymmetric system has no energy, so any finite solution will
          // do. Of a symmetric one a direction along which the energy rises
          // shows that the tangent is indefinite.
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

    /** Whether the factor is that of a raised diagonal. The least shift, which
     *  supports unsupported motions, does not count. */
    bool
    has_shifted() const
    {
      return shift > least_shift;
    }

  private:
    void
    factorize(const Matrix &K)
    {
      // One factor serves all solves until the next tangent. A shift goes into
      // a copy, since residuals need K itself. The old factor is freed before
      // the new one is made, as both together would take twice the memory.
      // MUMPS works on all ranks; KLU gathers the matrix on one of them.
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
     * factored matrix, is nearly singular. The motions that A gives no
     * stiffness are those of the deformed body, and not quite orthogonal to
     * that space: projecting A⁻¹b onto it would leave a large rotation. Solves
     * A x + N μ = b, Nᵀx = 0 instead.
     */

    void
    solve_bordered(const Matrix &K, Vector &x, const Vector &b)
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

    /** Corrects @p x, the solution with the factor, for what K lacks. */
    void
    add_corrections(const Matrix                &K,
                    const Equilibrium::RankOnes &parts,
                    Vector                      &x)
    {
      // The system has the matrix K + σ b bᵀ. The formula of Sherman and
      // Morrison corrects x = K⁻¹ r by one more solution, w = K⁻¹ b. Of several
      // parts each w is that of K with the parts before.
      std::vector<Vector> b, w;
      const auto          correct = [&](Vector &y) {
        for (std::size_t k = 0; k < w.size(); ++k)
          y.add(-parts[k].factor * (b[k] * y) /
                  (1. + parts[k].factor * (b[k] * w[k])),
                w[k]);
      };
      for (const Equilibrium::RankOne &part : parts)
        {
          Vector next(part.b);
          b.push_back(part.b);
          remove_parts(b.back(), problem.null_space);
          solve_bordered(K, next, b.back());
          correct(next);
          w.push_back(next);
        }
      correct(x);
    }

    const LinearProblem                            &problem;
    const double                                    least_shift;
    double                                          shift; // the factor's
    Matrix                                          shifted;
    SolverControl                                   control{1, 0.};
    std::unique_ptr<TrilinosWrappers::SolverDirect> factor; // none: null
    std::vector<Vector>                             solutions_of_null_space;
    LAPACKFullMatrix<double>                        schur;
  };


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
    if (!is_direct && !(product && product->is_of(K)))
      product.emplace(K, problem.n_components, problem.symmetric);
    else if (!is_direct && !as_before)
      product->read();
    const System system{K, x, b, tolerance, iterations, rank_ones};
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
        const ShiftedSystem system{*product,
                                   problem.null_space,
                                   shift,
                                   s.rank_ones};
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
            iterate(Jacobi(diagonal_magnitude(s.K, s.b), shift));
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
        const Sum            sum{*product, s.rank_ones};
        const Projected<Sum> A{sum, problem.null_space};
        const auto           iterate = [&](const auto &P) {
          const Projected<std::decay_t<decltype(P)>> projected{
            P, problem.null_space};
          gmres.solve(A, s.x, balanced, projected);
        };
        if (preconditioner.factorisation() != nullptr)
          iterate(*preconditioner.factorisation());
        else
          iterate(Jacobi(diagonal_magnitude(s.K, s.b), 0.));
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
