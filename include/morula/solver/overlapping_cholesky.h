// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_overlapping_cholesky_h
#define morula_solver_overlapping_cholesky_h

#include <morula/base/halo.h>
#include <morula/solver/block_cholesky.h>

#include <deal.II/base/index_set.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_vector.h>

#include <Epetra_CrsMatrix.h>

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
    using Vector = TrilinosWrappers::MPI::Vector;
    using Matrix = TrilinosWrappers::SparseMatrix;

    using Parameters = IncompleteCholesky::Parameters;

    /**
     * @param K is not used afterwards
     * @param n_components unknowns of a spline, 1 to 3: these follow each
     *        other, on the same rank
     */
    OverlappingCholesky(const Matrix      &K,
                        const unsigned int n_components,
                        const Parameters  &parameters);

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
    /** Rows of lower ranks, from the diagonal on: all that a symmetric block
     *  needs of them, as precise as its factor. */
    struct ReceivedRows
    {
      std::vector<std::size_t> begins;
      std::vector<int>         columns; // in the block
      std::vector<float>       values;
    };

    /** Number of a row in this rank's block, -1 if it is not there: own ones
     *  come last. */
    int
    number_of(const types::global_dof_index row) const;

    ReceivedRows
    receive(const Epetra_CrsMatrix &K, const unsigned int n_components) const;

    void
    factorize(const Epetra_CrsMatrix &K,
              const ReceivedRows     &received,
              const unsigned int      n_components,
              const Parameters       &parameters);

    const IndexSet                      own;
    const IndexSet                      others; // rows of lower ranks
    std::optional<Halo>                 halo;   // not on one rank
    std::unique_ptr<IncompleteCholesky> factor;
    mutable std::vector<double>         gathered; // of the block
  };
} // namespace Morula

#endif
