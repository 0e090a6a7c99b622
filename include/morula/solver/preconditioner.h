// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_preconditioner_h
#define morula_solver_preconditioner_h

#include <morula/base/block_matrix.h>
#include <morula/mechanics/equilibrium.h>
#include <morula/solver/block_cholesky.h>

#include <deal.II/base/index_set.h>
#include <deal.II/lac/diagonal_matrix.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /**
   * A preconditioner for symmetric positive matrices, of which each rank makes
   * a part: an approximate inverse in factors, M⁻¹ = Gᵀ G, doc/theory.md (7.2).
   * A rank's block has its own rows and, in front of them, all that couple with
   * these and belong to lower ranks. In the block's incomplete factor L the
   * rows of L⁻¹ that are the rank's own are its rows of G. If each block had
   * all lower rows, G would be the inverse of the whole matrix's factor; on one
   * rank it is. In additive Schwarz methods, Ifpack's among them, what blocks
   * have in common counts several times, which costs more than twice the
   * iterations on 16 ranks (doc/performance.md, The linear solver). Known as
   * block incomplete inverse Cholesky decomposition, BIIC.
   */
  class OverlappingCholesky
  {
  public:
    using Vector = BlockMatrix::Vector;

    using Parameters = IncompleteCholesky::Parameters;

    /** @param K symmetric; is not used afterwards */
    OverlappingCholesky(const BlockMatrix &K, const Parameters &parameters);

    /** Whether this rank's factorisation is positive. */
    bool
    is_positive() const
    {
      return factor->is_positive();
    }

    /** Neighbours have to do the same. */
    void
    vmult(Vector &y, const Vector &x) const;

  private:
    struct ReceivedRows; // of lower ranks

    ReceivedRows
    receive(const BlockMatrix &K) const;

    void
    factorize(const BlockMatrix  &K,
              const ReceivedRows &received,
              const Parameters   &parameters);

    const IndexSet                      others; // splines of lower ranks
    const std::size_t                   n_own, n_others; // unknowns
    std::optional<Halo>                 halo;            // not on one rank
    std::unique_ptr<IncompleteCholesky> factor;
    mutable std::vector<double>         gathered; // of the block
  };

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
    std::unique_ptr<OverlappingCholesky> factorisation_;
    std::size_t                          n_tried = 0; // or left out
  };

  /** |diag K|, in the layout of @p like. */
  Equilibrium::Vector
  diagonal_magnitude(const Equilibrium::Matrix &K,
                     const Equilibrium::Vector &like);

  /** Jacobi's preconditioner of K + σ |diag K|: the inverse of
   *  (1 + σ) |diag K|; always positive.
   *  @param magnitude |diag K| */
  DiagonalMatrix<Equilibrium::Vector>
  jacobi(const Equilibrium::Vector &magnitude, const double shift);
} // namespace Morula

#endif
