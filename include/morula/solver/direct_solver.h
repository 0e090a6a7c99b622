// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_direct_solver_h
#define morula_solver_direct_solver_h

#include <morula/mechanics/equilibrium.h>

#include <deal.II/lac/lapack_full_matrix.h>

#include <memory>
#include <vector>

namespace Morula
{
  /**
   * Shifts σ tried on negative curvature, doc/theory.md (5.4): each at least
   * factor times the one before, and curvature_factor times what the
   * curvature asks for (the direct solver knows no curvature and begins with
   * first). Where a body buckles the curvature is tiny, and a shift much
   * larger than it would let Newton's method leave the straight state by a
   * thousandth an iteration.
   */
  namespace Shifts
  {
    constexpr double first            = 1e-3;
    constexpr double least            = 1e-9;
    constexpr double factor           = 4.;
    constexpr double curvature_factor = 2.;
    constexpr double last             = 300.;
    /** From this shift on the diagonal prevails: Jacobi's preconditioner,
     * which knows the shift, takes fewer iterations than a factorisation that
     * does not. */
    constexpr double for_jacobi = 1.;
  } // namespace Shifts

  /**
   * Solves (K + σ |diag K|) x = b by a factorisation on the first rank, with
   * the smallest tried σ that gives a direction of descent: by CHOLMOD if
   * the matrix is positive, else by UMFPACK. The factor is kept until it is
   * forgotten.
   */
  class DirectSolver
  {
  public:
    using Vector = Equilibrium::Vector;
    using Matrix = Equilibrium::Matrix;

    /** @param problem kept as a reference */
    explicit DirectSolver(const LinearProblem &problem);

    ~DirectSolver();

    /** Forgets the factor, since the next matrix is another one. */
    void
    forget();

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
          const Equilibrium::RankOnes &rank_ones);

    /** Whether the factor is that of a raised diagonal. The least shift, which
     *  supports unsupported motions, does not count. */
    bool
    has_shifted() const
    {
      return shift > least_shift;
    }

  private:
    class Factor;

    void
    factorize(const Matrix &K);

    /**
     * Solves A x = b in the space orthogonal to the null space N, where A, the
     * factored matrix, is nearly singular. The motions that A gives no
     * stiffness are those of the deformed body, and not quite orthogonal to
     * that space: projecting A⁻¹b onto it would leave a large rotation. Solves
     * A x + N μ = b, Nᵀx = 0 instead.
     */
    void
    solve_bordered(const Matrix &K, Vector &x, const Vector &b) const;

    /** Corrects @p x, the solution with the factor, for what K lacks. */
    void
    add_corrections(const Matrix                &K,
                    const Equilibrium::RankOnes &parts,
                    Vector                      &x) const;

    const LinearProblem     &problem;
    const double             least_shift;
    double                   shift;  // the factor's
    std::unique_ptr<Factor>  factor; // none: null
    std::vector<Vector>      solutions_of_null_space;
    LAPACKFullMatrix<double> schur;
  };
} // namespace Morula

#endif
