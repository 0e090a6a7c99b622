// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/solver/linear_solver.h>

#include <deal.II/base/mpi.h>
#include <deal.II/lac/diagonal_matrix.h>
#include <deal.II/lac/lapack_full_matrix.h>
#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/solver_gmres.h>
#include <deal.II/lac/trilinos_solver.h>
#include <deal.II/lac/vector.h>

#include <Amesos.h>
#include <EpetraExt_MatrixMatrix.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace Morula
{
  namespace
  {
    using Vector = LinearSolver::Vector;
    using Matrix = LinearSolver::Matrix;

    constexpr unsigned int max_iterations = 2000;

    /**
     * Incomplete factorisations, tried one after the other until one is
     * positive and of use. Fewer entries make them faster; the raised diagonal
     * keeps them positive, and usable for the later tangents of the step
     * (doc/performance.md, The linear solver). Free bodies do without the last
     * one: it excites motions that hardly anything resists, such as the
     * twist of a row of cells, by a thousand times what Jacobi does.
     */
    struct Attempt
    {
      double fill, relative_diagonal;
    };
    constexpr Attempt     attempts[]        = {{0.6, 1.02},
                                               {1., 1.02},
                                               {1., 1.1},
                                               {1., 1.5}};
    constexpr std::size_t n_of_free_bodies  = 3;
    constexpr double      absolute_diagonal = 2e-5; // of the stiffness scale

    /** Shifts tried on negative curvature, doc/theory.md (5.4): each at least
     *  shift_factor times the one before, and curvature_factor times what the
     *  curvature asks for (the direct solver knows no curvature and begins with
     *  first_shift). Where a body buckles the curvature is tiny, and a shift
     *  much larger than it would let Newton's method leave the straight state
     *  by a thousandth an iteration. */
    constexpr double first_shift      = 1e-3;
    constexpr double least_shift      = 1e-9;
    constexpr double shift_factor     = 4.;
    constexpr double curvature_factor = 2.;
    constexpr double last_shift       = 300.;

    enum class Outcome
    {
      converged,
      negative_curvature,
      indefinite_preconditioner,
      stalled
    };

    /**
     * Preconditioned conjugate gradients for K + σ |diag K| that stop where
     * they meet negative curvature. deal.II's SolverCG and Trilinos' AztecOO
     * and Belos do not look at the curvature: they iterate on for thousands of
     * steps on an indefinite tangent, or return a direction that is none of
     * descent.
     * @param needed on negative curvature the shift, on all of K, with which
     *        that direction would have had none
     */
    template <typename Preconditioner, typename Projection>
    Outcome
    conjugate_gradients(const Matrix         &K,
                        const double          shift,
                        const Vector         &diagonal,
                        const Preconditioner &P,
                        const Projection     &project,
                        Vector               &x,
                        const Vector         &b,
                        const double          tolerance,
                        unsigned int         &iterations,
                        double               &needed)
    {
      Vector r(b), z(b), p(b), Kp(b), shifted(b);
      x = 0.;
      project(r);
      P.vmult(z, r);
      project(z);
      p                   = z;
      double       rz     = r * z;
      const double target = tolerance * r.l2_norm();
      for (unsigned int i = 0; i < max_iterations; ++i)
        {
          if (!(rz > 0.))
            return Outcome::indefinite_preconditioner;
          K.vmult(Kp, p);
          if (shift > 0.)
            {
              shifted = p;
              shifted.scale(diagonal);
              Kp.add(shift, shifted);
            }
          project(Kp);
          ++iterations;
          const double curvature = p * Kp;
          if (!(curvature > 0.))
            {
              shifted = p;
              shifted.scale(diagonal);
              needed = shift - curvature / (p * shifted);
              return Outcome::negative_curvature;
            }
          const double alpha = rz / curvature;
          x.add(alpha, p);
          r.add(-alpha, Kp);
          if (r.l2_norm() <= target)
            return Outcome::converged;
          P.vmult(z, r);
          project(z);
          const double rz_new = r * z;
          p.sadd(rz_new / rz, z);
          rz = rz_new;
        }
      return Outcome::stalled;
    }

    /** An operator followed by a projection. */
    template <typename Operator, typename Projection>
    struct Projected
    {
      const Operator   &apply;
      const Projection &project;

      void
      vmult(Vector &y, const Vector &x) const
      {
        apply.vmult(y, x);
        project(y);
      }
    };

    /** Makes @p result (K + Kᵀ)/2. */
    void
    symmetrize(const Matrix &K, Matrix &result)
    {
      Epetra_CrsMatrix *sum   = nullptr; // made by the next line
      const int         error = EpetraExt::MatrixMatrix::Add(
        K.trilinos_matrix(), false, 0.5, K.trilinos_matrix(), true, 0.5, sum);
      const std::unique_ptr<Epetra_CrsMatrix> owner(sum);
      AssertThrow(error == 0 && sum->FillComplete() == 0, ExcInternalError());
      result.reinit(*sum);
    }

    /** |diag K|. */
    Vector
    diagonal_magnitude(const Matrix &K, const Vector &layout)
    {
      Vector diagonal(layout);
      for (const auto row : diagonal.locally_owned_elements())
        diagonal(row) = std::abs(K.diag_element(row));
      diagonal.compress(VectorOperation::insert);
      return diagonal;
    }

    /** The inverse of (1 + shift) |diag K|; always positive. */
    DiagonalMatrix<Vector>
    jacobi_preconditioner(const Vector &magnitude, const double shift)
    {
      Vector inverse(magnitude);
      for (const auto row : inverse.locally_owned_elements())
        inverse(row) =
          magnitude(row) > 0. ? 1. / ((1. + shift) * magnitude(row)) : 1.;
      inverse.compress(VectorOperation::insert);
      DiagonalMatrix<Vector> result;
      result.reinit(inverse);
      return result;
    }
  } // namespace

  LinearSolver::LinearSolver(const SolverParameters &parameters,
                             const Equilibrium      &problem,
                             TimerOutput            &timer)
    : direct(parameters.linear_solver == "direct")
    , automatic(parameters.linear_solver == "automatic")
    , problem(problem)
    , symmetric(problem.is_conservative())
    , timer(timer)
  {}

  LinearSolver::~LinearSolver() = default;

  double
  LinearSolver::largest_shift() const
  {
    return largest_shift_;
  }

  void
  LinearSolver::project(Vector &x) const
  {
    for (const Vector &direction : problem.null_space())
      x.add(-(x * direction), direction);
  }

  void
  LinearSolver::make_preconditioner(const Matrix &K)
  {
    // Of an unsymmetric tangent it is that of the symmetric part: positive
    // definite where the body is stable, so that the preconditioned operator is
    // the identity and a bounded skew part.
    if (!symmetric)
      symmetrize(K, symmetric_part);
    preconditioner.reset();
    const std::size_t n_usable =
      problem.null_space().empty() ? std::size(attempts) : n_of_free_bodies;
    for (; !preconditioner && n_attempts < n_usable; ++n_attempts)
      {
        OverlappingCholesky::Parameters parameters;
        parameters.fill              = attempts[n_attempts].fill;
        parameters.relative_diagonal = attempts[n_attempts].relative_diagonal;
        parameters.absolute_diagonal =
          absolute_diagonal * problem.stiffness_scale();
        std::unique_ptr<OverlappingCholesky> made;
        try
          {
            made =
              std::make_unique<OverlappingCholesky>(symmetric ? K :
                                                                symmetric_part,
                                                    problem.coupled_dofs(),
                                                    parameters);
          }
        catch (const ExceptionBase &)
          {}                                               // a zero pivot
        const bool failed = !made || !made->is_positive(); // on this rank
        if (!Utilities::MPI::logical_or(failed, K.get_mpi_communicator()))
          preconditioner = std::move(made);
      }
  }

  void
  LinearSolver::solve(const Matrix &K,
                      Vector       &x,
                      const Vector &b,
                      const double  tolerance,
                      unsigned int &iterations)
  {
    if (!direct && !prepared)
      {
        const TimerOutput::Scope section(timer, "preconditioner");
        make_preconditioner(K);
        prepared = true;
      }
    const TimerOutput::Scope section(timer, "linear solver");
    try
      {
        if (direct)
          solve_direct(K, x, b, iterations);
        else if (symmetric)
          solve_symmetric(K, x, b, tolerance, iterations);
        else
          solve_unsymmetric(K, x, b, tolerance, iterations);
      }
    catch (const StepFailed &)
      {
        if (!automatic)
          throw;
        solve_direct(K, x, b, iterations);
      }
  }

  void
  LinearSolver::solve_symmetric(const Matrix &K,
                                Vector       &x,
                                const Vector &b,
                                const double  tolerance,
                                unsigned int &iterations)
  {
    const Vector magnitude = diagonal_magnitude(K, b);
    double       shift = 0., needed = 0.;
    while (shift < last_shift)
      {
        const auto iterate = [&](const auto &P) {
          return conjugate_gradients(
            K,
            shift,
            magnitude,
            P,
            [this](Vector &y) { project(y); },
            x,
            b,
            tolerance,
            iterations,
            needed);
        };
        const Outcome outcome =
          preconditioner ? iterate(*preconditioner) :
                           iterate(jacobi_preconditioner(magnitude, shift));
        largest_shift_ = std::max(largest_shift_, shift);
        if (outcome == Outcome::converged)
          return;
        if (outcome == Outcome::negative_curvature)
          shift = std::max(
            {least_shift, curvature_factor * needed, shift_factor * shift});
        else if (preconditioner)
          make_preconditioner(K); // that one was of no use: another, or none
        else
          break;
      }
    throw StepFailed("the conjugate gradient method did not converge");
  }

  void
  LinearSolver::solve_unsymmetric(const Matrix &K,
                                  Vector       &x,
                                  const Vector &b,
                                  const double  tolerance,
                                  unsigned int &iterations)
  {
    Vector balanced(b);
    project(balanced);
    SolverControl control(max_iterations, tolerance * balanced.l2_norm());
    // Preconditioned from the right: else the tolerance would be one for the
    // preconditioned residual, which can be far from the residual.
    SolverGMRES<Vector> gmres(control,
                              SolverGMRES<Vector>::AdditionalData(100, true));
    x = 0.;
    try
      {
        const auto remove = [this](Vector &y) { project(y); };
        const Projected<Matrix, decltype(remove)> A{K, remove};
        const auto                                solve = [&](const auto &P) {
          const Projected<std::decay_t<decltype(P)>, decltype(remove)>
            projected{P, remove};
          gmres.solve(A, x, balanced, projected);
        };
        if (preconditioner)
          solve(*preconditioner);
        else
          solve(jacobi_preconditioner(diagonal_magnitude(K, b), 0.));
        project(x);
      }
    catch (const SolverControl::NoConvergence &)
      {
        iterations += control.last_step();
        throw StepFailed("GMRES did not converge");
      }
    iterations += control.last_step();
  }

  void
  LinearSolver::solve_direct(const Matrix &K,
                             Vector       &x,
                             const Vector &b,
                             unsigned int &iterations)
  {
    const std::string method =
      Amesos().Query("Amesos_Mumps") ? "Amesos_Mumps" : "Amesos_Klu";
    Vector balanced(b);
    project(balanced);
    Matrix shifted;
    // With unsupported rigid motions K is singular. So small a shift costs
    // Newton's method nothing.
    const double least = problem.null_space().empty() ? 0. : 1e-9;
    double       shift = least;
    while (shift < last_shift)
      {
        if (shift > 0.)
          {
            shifted.copy_from(K);
            for (const auto row : K.locally_owned_range_indices())
              shifted.add(row, row, shift * std::abs(K.diag_element(row)));
            shifted.compress(VectorOperation::add);
          }
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
            solve_bordered(A, solver, x, balanced);
          }
        catch (const ExceptionBase &)
          {
            singular = true;
          }
        // Not a direction of descent: the tangent is indefinite there.
        if (!singular && std::isfinite(x.l2_norm()) &&
            (!symmetric || x * b > 0.))
          return;
        if (!singular && shift > least)
          largest_shift_ = std::max(largest_shift_, shift);
        shift = std::max(first_shift, shift * shift_factor);
      }
    throw StepFailed("the direct solver found no direction of descent");
  }

  void
  LinearSolver::solve_bordered(const Matrix                   &A,
                               TrilinosWrappers::SolverDirect &solver,
                               Vector                         &x,
                               const Vector                   &b) const
  {
    const std::vector<Vector> &N = problem.null_space();
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
        project(x);
        A.residual(r, x, b);
        project(r);
      }
  }
} // namespace Morula
