// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_common_tests_h
#define morula_tests_common_tests_h

// What the tests of nearly all rooms need; those of a room include its room.h.

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <random>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/complaint.h"

/** Defines a test for 2-D and one for 3-D; the body knows the dimension as dim.
 */
#define TEST_2D_3D(suite, name) \
  template <int dim>            \
  static void suite##_##name(); \
  TEST(suite, name##In2D)       \
  {                             \
    suite##_##name<2>();        \
  }                             \
  TEST(suite, name##In3D)       \
  {                             \
    suite##_##name<3>();        \
  }                             \
  template <int dim>            \
  static void suite##_##name()

/** First in a test of what more ranks would only do again. */
#define ONE_RANK_IS_ENOUGH()     \
  do                             \
    {                            \
      if (number_of_ranks() > 1) \
        GTEST_SKIP();            \
  } while (false)

namespace Morula
{
  inline unsigned int
  this_rank(const MPI_Comm comm = MPI_COMM_WORLD)
  {
    return dealii::Utilities::MPI::this_mpi_process(comm);
  }

  inline unsigned int
  number_of_ranks(const MPI_Comm comm = MPI_COMM_WORLD)
  {
    return dealii::Utilities::MPI::n_mpi_processes(comm);
  }

  template <typename Number>
  Number
  sum_over_ranks(const Number &mine, const MPI_Comm comm = MPI_COMM_WORLD)
  {
    return dealii::Utilities::MPI::sum(mine, comm);
  }
} // namespace Morula

#endif
