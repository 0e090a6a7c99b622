// ranks: 1
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "solver/room.h"

#ifdef DEAL_II_WITH_PETSC
// Where deal.II has PETSc, its symmetric blocks, incomplete factorisation and
// conjugate gradients are a second opinion on ours: doc/theory.md, section 5.4.

/** Points of a cubic lattice, m along an edge. */
constexpr int m = 12;

std::array<int, 3>
place(const int point)
{
  return {{point % m, point / m % m, point / (m * m)}};
}

/** Entry (i, j) of springs along the lines to all 26 neighbours, of different
 *  stiffness, and sideways, on a weak foundation. */
double
entry(const unsigned int i, const unsigned int j)
{
  const auto spring = [](const int a, const int b, const int c, const int d) {
    Tensor<1, 3> way;
    for (unsigned int k = 0; k < 3; ++k)
      way[k] = place(a)[k] - place(b)[k];
    const double stiffness =
      2. + std::sin(1. * (a + b)) + std::cos(0.1 * std::abs(a - b));
    return stiffness * (way[c] * way[d] / way.norm_square() + 0.1 * (c == d));
  };
  const int a = i / 3, b = j / 3;
  if (a != b)
    return -spring(a, b, i % 3, j % 3);
  double sum = i == j ? 0.01 : 0.;
  for (int c = 0; c < m * m * m; ++c)
    if (const auto x = place(a), y = place(c);
        c != a && std::abs(x[0] - y[0]) < 2 && std::abs(x[1] - y[1]) < 2 &&
        std::abs(x[2] - y[2]) < 2)
      sum += spring(a, c, i % 3, j % 3);
  return sum;
}

BlockMatrix
springs()
{
  const unsigned int                n = m * m * m;
  std::vector<BlockMatrix::Columns> columns(n);
  for (unsigned int a = 0; a < n; ++a)
    for (int k = 0; k < 27; ++k)
      {
        const std::array<int, 3> x = place(a);
        const int                i = x[0] + k % 3 - 1, j = x[1] + k / 3 % 3 - 1,
                  l = x[2] + k / 9 - 1;
        if (std::min({i, j, l}) >= 0 && std::max({i, j, l}) < m)
          columns[a].push_back(i + m * (j + m * l));
      }
  BlockMatrix K;
  K.reinit(complete_index_set(n), columns, 3, true, MPI_COMM_SELF);
  set(K, entry);
  return K;
}

TEST(PETSc, HasTheSameProductAndAsManyIterations)
{
  // The upper halves of both are rows of blocks; PETSc wants its blocks by
  // columns, which is another one off the diagonal.
  const BlockMatrix K = springs();
  const int         n = m * m * m;
  Mat               A;
  MatCreateSeqSBAIJ(PETSC_COMM_SELF, 3, 3 * n, 3 * n, 14, nullptr, &A);
  MatSetOption(A, MAT_ROW_ORIENTED, PETSC_TRUE);
  for (int row = 0; row < n; ++row)
    {
      const double *block = K.blocks(row);
      for (const PetscInt column : K.columns(row))
        {
          MatSetValuesBlocked(A, 1, &row, 1, &column, block, INSERT_VALUES);
          block += 9;
        }
    }
  MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY);
  MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY);

  BlockMatrix::Vector x(complete_index_set(3 * n), MPI_COMM_SELF), b(x);
  for (int i = 0; i < 3 * n; ++i)
    x(i) = std::sin(1. + i * i);
  K.vmult(b, x);
  Vec theirs_x, theirs_b;
  VecCreateSeqWithArray(PETSC_COMM_SELF, 1, 3 * n, x.begin(), &theirs_x);
  VecCreateSeq(PETSC_COMM_SELF, 3 * n, &theirs_b);
  MatMult(A, theirs_x, theirs_b);
  const double *product;
  VecGetArrayRead(theirs_b, &product);
  for (int i = 0; i < 3 * n; ++i)
    ASSERT_NEAR(b(i), product[i], 1e-12 * b.linfty_norm());
  VecRestoreArrayRead(theirs_b, &product);

  KSP solver;
  PC  factor;
  KSPCreate(PETSC_COMM_SELF, &solver);
  KSPSetOperators(solver, A, A);
  KSPSetType(solver, KSPCG);
  KSPSetNormType(solver, KSP_NORM_UNPRECONDITIONED);
  KSPSetTolerances(solver, 1e-8, 0., PETSC_DEFAULT, 1000);
  KSPGetPC(solver, &factor);
  PCSetType(factor, PCICC);
  VecSet(theirs_x, 0.);
  KSPSolve(solver, theirs_b, theirs_x);
  PetscInt iterations;
  KSPGetIterationNumber(solver, &iterations);

  // Theirs is in x now.
  const BlockCholesky<3> own(
    3 * n,
    [&K](const int row, IncompleteCholesky::Row &result) {
      const auto columns = K.columns(row);
      result.columns.assign(columns.begin(), columns.end());
      result.values.assign(K.blocks(row), K.blocks(row) + 9 * columns.size());
    },
    {});
  ASSERT_TRUE(own.is_positive());
  struct
  {
    void
    vmult(BlockMatrix::Vector &y, const BlockMatrix::Vector &z) const
    {
      y = z;
      factor.solve(y.begin());
    }
    const BlockCholesky<3> &factor;
  } const inverse{own};
  BlockMatrix::Vector           y(x);
  ReductionControl              control(1000, 0., 1e-8);
  SolverCG<BlockMatrix::Vector> ours(control);
  y = 0.;
  ours.solve(K, y, b, inverse);
  EXPECT_LE(control.last_step(), 1.1 * iterations);
  EXPECT_GT(iterations, 5);
  y -= x;
  EXPECT_LT(y.linfty_norm(), 1e-5 * x.linfty_norm());
  KSPDestroy(&solver);
  VecDestroy(&theirs_x);
  VecDestroy(&theirs_b);
  MatDestroy(&A);
}
#else
TEST(PETSc, HasTheSameProductAndAsManyIterations)
{
  GTEST_SKIP() << "deal.II has no PETSc here";
}
#endif
