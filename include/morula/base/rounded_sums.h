// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_rounded_sums_h
#define morula_base_rounded_sums_h

#include <deal.II/base/mpi.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /** Sums over all ranks that do not depend on their number, nor on the order:
   *  of numbers rounded to multiples of 2^-32, whose sums are below 2^31. */
  class RoundedSums
  {
  public:
    RoundedSums(const unsigned int n, const MPI_Comm comm)
      : own(n)
      , comm(comm)
    {}

    void
    add(const unsigned int i, const double value)
    {
      own[i] += std::llround(std::ldexp(value, 32));
    }

    /** Collective. */
    std::vector<double>
    all() const
    {
      std::vector<std::int64_t> sums(own.size());
      Utilities::MPI::sum(own, comm, sums);
      std::vector<double> list;
      for (const std::int64_t sum : sums)
        list.push_back(std::ldexp(double(sum), -32));
      return list;
    }

  private:
    std::vector<std::int64_t> own;
    const MPI_Comm            comm;
  };
} // namespace Morula

#endif
