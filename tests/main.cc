// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/program/ranks.h>

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#include <iostream>
#include <string>

namespace
{
  /** What the other ranks print: failures only, with the rank's number. */
  class FailurePrinter : public testing::EmptyTestEventListener
  {
  public:
    explicit FailurePrinter(const unsigned int rank)
      : rank(rank)
    {}

    void
    OnTestPartResult(const testing::TestPartResult &result) override
    {
      if (result.failed())
        std::cerr << "rank " << rank << ": "
                  << (result.file_name() ? result.file_name() : "unknown file")
                  << ':' << result.line_number() << ": " << result.message()
                  << std::endl;
    }

  private:
    const unsigned int rank;
  };
} // namespace

int
main(int argc, char **argv)
{
  // This takes its options out of argv: PETSc would complain of them.
  testing::InitGoogleTest(&argc, argv);
  Morula::set_up_open_mpi();
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  const unsigned int n_ranks =
    dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  const unsigned int rank =
    dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);

  // An exception on one rank must end the run: the other ranks would wait for
  // it in their next collective call until the test's time is up.
  if (n_ranks > 1)
    GTEST_FLAG_SET(catch_exceptions, false);

  if (rank > 0)
    {
      testing::TestEventListeners &listeners =
        testing::UnitTest::GetInstance()->listeners();
      delete listeners.Release(listeners.default_result_printer());
      listeners.Append(new FailurePrinter(rank));
    }

  // Every rank reports failure if one of them saw it.
  const int failed = RUN_ALL_TESTS();
  return dealii::Utilities::MPI::max(failed, MPI_COMM_WORLD);
}
