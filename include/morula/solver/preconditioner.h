// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_preconditioner_h
#define morula_solver_preconditioner_h

#include <morula/mechanics/equilibrium.h>
#include <morula/solver/overlapping_cholesky.h>

#include <memory>

namespace Morula
{
  /**
   * The incomplete Cholesky factorisation of a step's first matrix, kept for
   * the others. Several are tried, one after the other, until one is positive.
   * For an unsymmetric matrix it factorises the symmetric part, which is
   * positive definite if the body is stable. Then the preconditioned operator
   * is the identity and a bounded skew part.
   */
  class Preconditioner
  {
  public:
    using Vector = Equilibrium::Vector;
    using Matrix = Equilibrium::Matrix;

    /** @param problem kept as a reference */
    explicit Preconditioner(const LinearProblem &problem);

    /** Makes the next factorisation that is positive, or none. Collective. */
    void
    make_next(const Matrix &K);

    /** The last factorisation; null: there is none, and Jacobi's preconditioner
     *  has to do. */
    const OverlappingCholesky *
    factorisation() const
    {
      return factorisation_.get();
    }

  private:
    const LinearProblem                 &problem;
    Matrix                               symmetric_part; // of an unsymmetric K
    std::unique_ptr<OverlappingCholesky> factorisation_;
    std::size_t                          n_tried; // or left out
  };

  /** |diag K|, in the layout of @p like. */
  Equilibrium::Vector
  diagonal_magnitude(const Equilibrium::Matrix &K,
                     const Equilibrium::Vector &like);

  /** Jacobi's preconditioner of K + σ |diag K|: the inverse of
   *  (1 + σ) |diag K|; always positive. deal.II's DiagonalMatrix assigns a
   *  vector in each product, for which Epetra compares maps by a reduction. */
  class Jacobi
  {
  public:
    using Vector = Equilibrium::Vector;

    /** @param magnitude |diag K| */
    Jacobi(const Vector &magnitude, const double shift);

    /** No communication. */
    void
    vmult(Vector &y, const Vector &x) const;

  private:
    Vector inverse;
  };
} // namespace Morula

#endif
