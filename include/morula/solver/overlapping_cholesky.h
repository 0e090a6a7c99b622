// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_overlapping_cholesky_h
#define morula_solver_overlapping_cholesky_h

#include <deal.II/base/index_set.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_vector.h>

#include <Epetra_CrsMatrix.h>
#include <Epetra_Import.h>
#include <Epetra_MpiComm.h>
#include <Epetra_Vector.h>
#include <Ifpack_IC.h>

#include <memory>

namespace Morula
{
  using namespace dealii;

  /**
   * A preconditioner for symmetric positive matrices: the sum of incomplete
   * Cholesky factorisations (Ifpack's) of overlapping blocks, one a rank; on
   * one rank the factorisation of the matrix. Ifpack has overlapping blocks as
   * well (and deal.II's PreconditionIC uses these), but overlaps whole layers
   * of the matrix's graph, which is several times the work that is needed here,
   * and drops a block's contributions outside the rank's own rows, which is not
   * symmetric (doc/performance.md, Two ranks).
   */
  class OverlappingCholesky
  {
  public:
    using Vector = TrilinosWrappers::MPI::Vector;
    using Matrix = TrilinosWrappers::SparseMatrix;

    /** What decides about the factor. */
    struct Parameters
    {
      /** Entries of the factor over those of the matrix's triangle; the
       *  largest of each column are kept. */
      double fill = 1.;
      /** The diagonal is multiplied by the one and raised by the other. */
      double relative_diagonal = 1.;
      double absolute_diagonal = 0.;
    };

    /**
     * @param K must stay as it is while this object is used
     * @param others rows of this rank's block besides its own
     * @throws ExceptionBase on a zero pivot, perhaps on this rank alone
     */
    OverlappingCholesky(const Matrix     &K,
                        const IndexSet   &others,
                        const Parameters &parameters);

    /** Whether this rank's factorisation is positive. */
    bool
    is_positive() const;

    /** Collective. */
    void
    vmult(Vector &y, const Vector &x) const;

  private:
    /** The upper triangle of this rank's block. */
    std::unique_ptr<Epetra_CrsMatrix>
    block_of(const Epetra_CrsMatrix &K) const;

    void
    factorize(const Epetra_CrsMatrix &A, const Parameters &parameters);

    Epetra_Map                        rows; // of this rank's block
    Epetra_Import                     import;
    Epetra_MpiComm                    self;
    Epetra_Map                        local; // the same, numbered from 0
    std::unique_ptr<Epetra_CrsMatrix> block; // none on one rank
    std::unique_ptr<Ifpack_IC>        factor;
    mutable Epetra_Vector             gathered;
  };
} // namespace Morula

#endif
