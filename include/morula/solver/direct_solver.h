// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_direct_solver_h
#define morula_solver_direct_solver_h

#include <morula/mechanics/equilibrium.h>

#include <deal.II/lac/lapack_full_matrix.h>
#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/trilinos_solver.h>

#include <memory>
#include <vector>

namespace Morula
{
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
    explicit DirectSolver(const LinearProblem &problem);

    /** Forgets the factor, since the next matrix is another one. */
    void
    forget();

    /**
     * @param K the matrix of the last call, unless forget() was called since
     * @param iterations in/out: the factorisations are added
     * @param largest_shift in/out: raised to the largest σ at which the tangent
     *                      was still indefinite
     * @param rank_one what K lacks, or null
     * @throws StepFailed on all ranks together
     */
    void
    solve(const Matrix               &K,
          Vector                     &x,
          const Vector               &b,
          unsigned int               &iterations,
          double                     &largest_shift,
          const Equilibrium::RankOne *rank_one = nullptr);

    /** Whether the factor is that of a raised diagonal. The least shift, which
     *  supports unsupported motions, does not count. */
    bool
    has_shifted() const
    {
      return shift > least_shift;
    }

  private:
    void
    factorize(const Matrix &K);

    void
    solve_bordered(const Matrix &K, Vector &x, const Vector &b);

    /** Corrects @p x, the solution with the factor, for what K lacks. */
    void
    add_correction(const Matrix               &K,
                   const Equilibrium::RankOne &part,
                   Vector                     &x);

    const LinearProblem                            &problem;
    const double                                    least_shift;
    double                                          shift; // the factor's
    Matrix                                          shifted;
    SolverControl                                   control{1, 0.};
    std::unique_ptr<TrilinosWrappers::SolverDirect> factor; // none: null
    std::vector<Vector>                             solutions_of_null_space;
    LAPACKFullMatrix<double>                        schur;
  };
} // namespace Morula

#endif
