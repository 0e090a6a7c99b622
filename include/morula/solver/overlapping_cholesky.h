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

#include <memory>
#include <optional>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /**
   * A preconditioner for symmetric positive matrices: the sum of incomplete
   * Cholesky factorisations of overlapping blocks, one a rank; on one rank the
   * factorisation of the matrix. Ifpack has overlapping blocks (and deal.II's
   * PreconditionIC uses these), but overlaps whole layers of the matrix's
   * graph, which is several times the work that is needed here, and drops a
   * block's contributions outside the rank's own rows, which is not symmetric
   * (doc/performance.md, Two ranks).
   */
  class OverlappingCholesky
  {
  public:
    using Vector = TrilinosWrappers::MPI::Vector;
    using Matrix = TrilinosWrappers::SparseMatrix;

    using Parameters = IncompleteCholesky::Parameters;

    /**
     * @param K is not used afterwards
     * @param others rows of this rank's block besides its own
     * @param n_components unknowns of a spline, 1 to 3: these follow each
     *        other, and go to the same ranks and blocks
     */
    OverlappingCholesky(const Matrix      &K,
                        const IndexSet    &others,
                        const unsigned int n_components,
                        const Parameters  &parameters);

    /** Whether this rank's factorisation is positive. */
    bool
    is_positive() const;

    /** Neighbours have to do the same. */
    void
    vmult(Vector &y, const Vector &x) const;

  private:
    void
    factorize(const Epetra_CrsMatrix &K,
              const Epetra_CrsMatrix &received,
              const unsigned int      n_components,
              const Parameters       &parameters);

    const IndexSet                      own;
    const IndexSet                      others; // without the own ones
    std::optional<Halo>                 halo;   // not on one rank
    std::unique_ptr<IncompleteCholesky> factor;
    mutable std::vector<double>         gathered; // of the block
  };
} // namespace Morula

#endif
