// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/solver/preconditioner.h>

#include <deal.II/base/mpi.h>

#include <EpetraExt_MatrixMatrix.h>

#include <cmath>
#include <iterator>

namespace Morula
{
  namespace
  {
    /**
     * Incomplete factorisations in the order in which they are tried. Fewer
     * blocks make them faster; the raised diagonal keeps them positive, and
     * usable for the later tangents of the step (doc/performance.md, The linear
     * solver). The first one is for a single component: coefficients of
     * splines that are far from each other hardly matter there. Free bodies do
     * without the last one: it excites motions that hardly anything resists,
     * such as the twist of a row of cells, by a thousand times what Jacobi
     * does.
     */
    struct Attempt
    {
      double fill, relative_diagonal;
    };
    constexpr Attempt attempts[] = {
      {0.5, 1.02}, {1.25, 1.02}, {1.5, 1.02}, {2., 1.02}, {2., 1.1}, {2., 1.5}};
    constexpr std::size_t first_of_vectors  = 1;
    constexpr std::size_t n_of_free_bodies  = 5;
    constexpr double      absolute_diagonal = 2e-5; // of a typical entry

    /** Makes @p result (K + Kᵀ)/2. */
    void
    symmetrize(const Equilibrium::Matrix &K, Equilibrium::Matrix &result)
    {
      Epetra_CrsMatrix *sum   = nullptr; // made by the next line
      const int         error = EpetraExt::MatrixMatrix::Add(
        K.trilinos_matrix(), false, 0.5, K.trilinos_matrix(), true, 0.5, sum);
      const std::unique_ptr<Epetra_CrsMatrix> owner(sum);
      AssertThrow(error == 0 && sum->FillComplete() == 0, ExcInternalError());
      result.reinit(*sum);
    }
  } // namespace

  Preconditioner::Preconditioner(const LinearProblem &problem)
    : problem(problem)
    , n_tried(problem.n_components > 1 ? first_of_vectors : 0)
  {}

  void
  Preconditioner::make_next(const Matrix &K)
  {
    if (!problem.symmetric)
      symmetrize(K, symmetric_part);
    const Matrix &A = problem.symmetric ? K : symmetric_part;
    factorisation_.reset();
    // Free bodies leave the last factorisation out (see attempts).
    const std::size_t n_usable =
      problem.null_space.empty() ? std::size(attempts) : n_of_free_bodies;
    for (; !factorisation_ && n_tried < n_usable; ++n_tried)
      {
        OverlappingCholesky::Parameters parameters;
        parameters.fill              = attempts[n_tried].fill;
        parameters.relative_diagonal = attempts[n_tried].relative_diagonal;
        parameters.absolute_diagonal =
          absolute_diagonal * problem.typical_entry;
        auto made = std::make_unique<OverlappingCholesky>(A,
                                                          problem.n_components,
                                                          parameters);
        // Each rank knows of its own block only. All of them use the
        // factorisation, or none does.
        const bool failed = !made->is_positive(); // on this rank
        if (!Utilities::MPI::logical_or(failed, K.get_mpi_communicator()))
          factorisation_ = std::move(made);
      }
  }

  Equilibrium::Vector
  diagonal_magnitude(const Equilibrium::Matrix &K,
                     const Equilibrium::Vector &like)
  {
    Equilibrium::Vector diagonal(like);
    for (const auto row : diagonal.locally_owned_elements())
      diagonal(row) = std::abs(K.diag_element(row));
    diagonal.compress(VectorOperation::insert);
    return diagonal;
  }

  Jacobi::Jacobi(const Vector &magnitude, const double shift)
    : inverse(magnitude)
  {
    for (const auto row : inverse.locally_owned_elements())
      inverse(row) =
        magnitude(row) > 0. ? 1. / ((1. + shift) * magnitude(row)) : 1.;
    inverse.compress(VectorOperation::insert);
  }

  void
  Jacobi::vmult(Vector &y, const Vector &x) const
  {
    // An entrywise product; it does not communicate.
    y.trilinos_vector().Multiply(1.,
                                 inverse.trilinos_vector(),
                                 x.trilinos_vector(),
                                 0.);
  }
} // namespace Morula
