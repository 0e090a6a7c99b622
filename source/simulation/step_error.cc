// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/simulation/step_error.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace Morula
{
  void
  ErrorInTime::add(const double mu)
  {
    // This is the sum in doc/theory.md (5.10).
    changes += std::abs(mu - last) / 6.;
    last = mu;
  }


  template <int dim>
  double
  mean_over_tissue(const Tissue<dim>                               &tissue,
                   const std::function<double(const unsigned int)> &number,
                   const double                                     scale)
  {
    // Sums of integers do not depend on their order, and so not on the number
    // of ranks. With units of 2^-30 typical volumes and at most 2^10 of these a
    // cell, 2^23 cells of the largest size do not overflow 64 bits.
    constexpr double units  = 1u << 30;
    constexpr double most   = 1024.;
    std::int64_t     all[2] = {0, 0};
    const auto      &cells  = tissue.cells();
    for (unsigned int p = 0; p < cells.size(); ++p)
      {
        const double volume = std::min(cells.volume(p) / scale, most);
        all[0] += std::llround(units * volume * std::clamp(number(p), 0., 1.));
        all[1] += std::llround(units * volume);
      }
    const MPI_Comm     comm  = tissue.communicator();
    const std::int64_t part  = Utilities::MPI::sum(all[0], comm);
    const std::int64_t whole = Utilities::MPI::sum(all[1], comm);
    return whole > 0 ? double(part) / double(whole) : 0.;
  }


  MORULA_INSTANTIATE(mean_over_tissue);
} // namespace Morula
