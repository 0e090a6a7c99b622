// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/send_records.h>
#include <morula/solver/direct_solver.h>
#include <morula/solver/preconditioner.h>

#include <deal.II/base/mpi.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparse_direct.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/sparsity_pattern.h>
#include <deal.II/lac/vector.h>

#include <cholmod.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

namespace Morula
{
  namespace
  {
    /** An entry of a matrix; of a symmetric one from the diagonal on. */
    struct MatrixEntry
    {
      SuiteSparse_long row, column;
      double           value;
    };

    /** The entries of K + σ |diag K| in this rank's rows. */
    std::vector<MatrixEntry>
    entries_of(const BlockMatrix &K, const double shift)
    {
      std::vector<MatrixEntry> entries;
      const unsigned int       n = K.n_components();
      for (unsigned int k = 0; k < K.own().n_elements(); ++k)
        {
          const auto    row   = K.spline_of(k);
          const double *value = K.blocks(k);
          for (const int c : K.columns(k))
            {
              // Of the blocks that own rows and those of other ranks both have,
              // and of those on the diagonal, a symmetric matrix gives the
              // upper one.
              const auto column = K.spline_of(c);
              for (unsigned int i = 0; i < n; ++i)
                for (unsigned int j = 0; j < n; ++j, ++value)
                  {
                    const SuiteSparse_long r = n * row + i, s = n * column + j;
                    if (!K.is_symmetric() || r <= s)
                      entries.push_back(
                        {r,
                         s,
                         *value + (r == s ? shift * std::abs(*value) : 0.)});
                  }
            }
        }
      return entries;
    }

    /** The factors L Lᵀ of a symmetric matrix. */
    class Cholesky
    {
    public:
      Cholesky(const std::size_t size, const std::vector<MatrixEntry> &entries)
      {
        // A pivot that is not positive ends the factorisation, and shows in the
        // number of columns that are done.
        cholmod_l_start(&common);
        common.print                      = 0;
        common.quick_return_if_not_posdef = true;
        const int        upper            = 1;
        cholmod_triplet *triplets         = cholmod_l_allocate_triplet(
          size, size, entries.size(), upper, CHOLMOD_REAL, &common);
        for (std::size_t e = 0; e < entries.size(); ++e)
          {
            static_cast<SuiteSparse_long *>(triplets->i)[e] = entries[e].row;
            static_cast<SuiteSparse_long *>(triplets->j)[e] = entries[e].column;
            static_cast<double *>(triplets->x)[e]           = entries[e].value;
          }
        triplets->nnz     = entries.size();
        cholmod_sparse *A = cholmod_l_triplet_to_sparse(triplets, 0, &common);
        cholmod_l_free_triplet(&triplets, &common);
        factor = cholmod_l_analyze(A, &common);
        cholmod_l_factorize(A, factor, &common);
        cholmod_l_free_sparse(&A, &common);
      }

      Cholesky(const Cholesky &) = delete;

      ~Cholesky()
      {
        cholmod_l_free_factor(&factor, &common);
        cholmod_l_finish(&common);
      }

      bool
      is_positive() const
      {
        return common.status == CHOLMOD_OK && factor->minor == factor->n;
      }

      void
      solve(dealii::Vector<double> &x)
      {
        cholmod_dense *b = cholmod_l_allocate_dense(
          x.size(), 1, x.size(), CHOLMOD_REAL, &common);
        std::copy(x.begin(), x.end(), static_cast<double *>(b->x));
        cholmod_dense *y = cholmod_l_solve(CHOLMOD_A, factor, b, &common);
        std::copy_n(static_cast<const double *>(y->x), x.size(), x.begin());
        cholmod_l_free_dense(&b, &common);
        cholmod_l_free_dense(&y, &common);
      }

    private:
      cholmod_common  common;
      cholmod_factor *factor;
    };

    /** The factors L U of any matrix; null: it is singular. */
    std::unique_ptr<SparseDirectUMFPACK>
    make_lu(const std::size_t               size,
            const bool                      symmetric,
            const std::vector<MatrixEntry> &entries)
    {
      const auto for_each = [&](const auto &action) {
        for (const MatrixEntry &entry : entries)
          {
            action(entry.row, entry.column, entry.value);
            if (symmetric && entry.row != entry.column)
              action(entry.column, entry.row, entry.value);
          }
      };
      DynamicSparsityPattern pattern(size, size);
      for_each([&](const auto row, const auto column, const double) {
        pattern.add(row, column);
      });
      SparsityPattern compressed;
      compressed.copy_from(pattern);
      SparseMatrix<double> A(compressed);
      for_each([&](const auto row, const auto column, const double value) {
        A.add(row, column, value);
      });
      auto result = std::make_unique<SparseDirectUMFPACK>();
      try
        {
          result->factorize(A);
        }
      catch (const ExceptionBase &)
        {
          return nullptr;
        }
      return result;
    }
  } // namespace

  /** The factors of K + σ |diag K|, on the first rank. */
  class DirectSolver::Factor
  {
  public:
    /** Collective. */
    Factor(const Matrix &K, const double shift)
      : comm(K.communicator())
    {
      // The rows of all ranks travel to the first one, which alone has factors.
      // Whether there are any is told to all. Those of a matrix that is not
      // positive take longer.
      const std::vector<MatrixEntry> entries =
        in_one(send_records<MatrixEntry>({{0, entries_of(K, shift)}}, comm));
      bool failed = false;
      if (Utilities::MPI::this_mpi_process(comm) == 0)
        {
          const std::size_t size = K.own().size() * K.n_components();
          if (K.is_symmetric())
            cholesky = std::make_unique<Cholesky>(size, entries);
          if (!cholesky || !cholesky->is_positive())
            {
              cholesky.reset();
              lu     = make_lu(size, K.is_symmetric(), entries);
              failed = lu == nullptr;
            }
        }
      usable = !Utilities::MPI::logical_or(failed, comm);
    }

    /** Whether there are factors; there are none of a singular matrix. */
    bool
    is_usable() const
    {
      return usable;
    }

    /** Collective. */
    void
    solve(Vector &x, const Vector &b)
    {
      // The parts of b go to the first rank, and those of x come back.
      auto parts =
        send_records<double>({{0, std::vector<double>(b.begin(), b.end())}},
                             comm);
      if (!parts.empty())
        {
          dealii::Vector<double> all(b.size());
          auto                   next = all.begin();
          for (const auto &[rank, part] : parts)
            next = std::copy(part.begin(), part.end(), next);
          if (cholesky)
            cholesky->solve(all);
          else
            lu->solve(all);
          next = all.begin();
          for (auto &[rank, part] : parts)
            {
              std::copy_n(next, part.size(), part.begin());
              next += part.size();
            }
        }
      for (const auto &[rank, part] : send_records(parts, comm))
        std::copy(part.begin(), part.end(), x.begin());
    }

  private:
    const MPI_Comm                       comm;
    std::unique_ptr<Cholesky>            cholesky;
    std::unique_ptr<SparseDirectUMFPACK> lu;
    bool                                 usable;
  };

  DirectSolver::DirectSolver(const LinearProblem &problem)
    : problem(problem)
    , least_shift(problem.null_space.empty() ? 0. : 1e-9)
    , shift(least_shift)
  {
    // With unsupported rigid motions K is singular, and a factorisation breaks
    // down. The least shift, 1e-9 of the diagonal, prevents that, and is so
    // small that Newton's method converges as before.
  }

  DirectSolver::~DirectSolver() = default;

  void
  DirectSolver::forget()
  {
    factor.reset();
    shift = least_shift;
  }

  void
  DirectSolver::solve(const Matrix                &K,
                      Vector                      &x,
                      const Vector                &b,
                      unsigned int                &iterations,
                      double                      &largest_shift,
                      const Equilibrium::RankOnes &rank_ones)
  {
    // What acts along unsupported motions is left out, as inertia balances it:
    // doc/theory.md (4.10). The diagonal is raised, doc/theory.md (5.4), until
    // x is a direction of descent; each trial is a factorisation. The factor
    // that worked is kept, with its shift, for later calls.
    Vector balanced(b);
    remove_parts(balanced, problem.null_space);
    while (shift < Shifts::last)
      {
        if (!factor)
          {
            ++iterations;
            factorize(K);
          }
        if (factor->is_usable())
          {
            solve_bordered(K, x, balanced);
            add_corrections(K, rank_ones, x);
            // An unsymmetric system has no energy, so any finite solution will
            // do. Of a symmetric one a direction along which the energy rises
            // shows that the tangent is indefinite.
            if (std::isfinite(x.l2_norm()) &&
                (!problem.symmetric || x * b > 0.))
              return;
          }
        if (shift > least_shift)
          largest_shift = std::max(largest_shift, shift);
        factor.reset();
        shift = std::max(Shifts::first, shift * Shifts::factor);
      }
    throw StepFailed("the direct solver found no direction of descent");
  }

  void
  DirectSolver::factorize(const Matrix &K)
  {
    // One factor serves all solves until the next tangent. The bordered system
    // (see solve_bordered()) needs A⁻¹ N and the small matrix Nᵀ A⁻¹ N, once
    // for each factor.
    factor.reset(); // the old one's memory first
    factor                       = std::make_unique<Factor>(K, shift);
    const std::vector<Vector> &N = problem.null_space;
    solutions_of_null_space.clear();
    if (N.empty() || !factor->is_usable())
      return;
    schur.reinit(N.size());
    for (unsigned int l = 0; l < N.size(); ++l)
      {
        solutions_of_null_space.emplace_back(N[l]);
        factor->solve(solutions_of_null_space[l], N[l]);
        for (unsigned int k = 0; k < N.size(); ++k)
          schur(k, l) = N[k] * solutions_of_null_space[l];
      }
    schur.compute_lu_factorization();
  }

  void
  DirectSolver::solve_bordered(const Matrix &K,
                               Vector       &x,
                               const Vector &b) const
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
    const Vector raised = diagonal_magnitude(K, b);
    x                   = 0.;
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
        K.vmult(r, x);
        for (unsigned int k = 0; k < r.locally_owned_size(); ++k)
          r.local_element(k) +=
            shift * raised.local_element(k) * x.local_element(k);
        r.sadd(-1., 1., b);
        remove_parts(r, N);
      }
  }

  void
  DirectSolver::add_corrections(const Matrix                &K,
                                const Equilibrium::RankOnes &parts,
                                Vector                      &x) const
  {
    // The system has the matrix K + σ b bᵀ. The formula of Sherman and Morrison
    // corrects x = K⁻¹ r by one more solution, w = K⁻¹ b. Of several parts each
    // w is that of K with the parts before.
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
} // namespace Morula
