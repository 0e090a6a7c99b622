// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/scene/first_cells.h>
#include <morula/scene/free_growth.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Morula
{
  namespace
  {
    /** Of a law, for all cells of a rank: some hundredths of a second. */
    constexpr double most_evaluations = 2e4;
    /** Rates are taken at the beginning of a step: an error of some percent. */
    constexpr double most_steps = 64.;
  } // namespace


  template <int dim>
  std::optional<FreeGrowth>
  free_growth(const Scene               &scene,
              const Founders<dim>       &founders,
              const SurfacePatches<dim> &surface,
              const MPI_Comm             comm)
  {
    if (!scene.has_growth())
      return {};
    FreeGrowth growth;
    growth.known_before =
      effects_of<dim>(scene).development.law->is_known_before();
    growth.least = std::numeric_limits<double>::infinity();
    growth.most  = 0.;
    const FirstCells<dim> cells(scene, founders, surface, comm);
    const double          end = scene.time.end_time;
    const unsigned int    n_steps =
      std::min(most_steps, std::ceil(end / scene.time.step));
    const std::size_t every = std::max<std::size_t>(
      1, std::ceil(n_steps * founders.positions.size() / most_evaluations));
    double n = 0., sum = 0.;
    for (std::size_t i = 0; i < founders.positions.size(); i += every)
      {
        double ratio = 1.;
        // If there is no value, the run says so when it gets there.
        try
          {
            ratio = cells.development().free_growth(cells.row(i),
                                                    founders.first_id + i,
                                                    end,
                                                    n_steps);
          }
        catch (const InputError &)
          {}
        ++n;
        sum += ratio;
        growth.least = std::min(growth.least, ratio);
        growth.most  = std::max(growth.most, ratio);
      }
    growth.mean = Utilities::MPI::sum(sum, comm) / Utilities::MPI::sum(n, comm);
    growth.least = Utilities::MPI::min(growth.least, comm);
    growth.most  = Utilities::MPI::max(growth.most, comm);
    return growth;
  }


#define INSTANTIATE(dim)                                                      \
  template std::optional<FreeGrowth> free_growth(const Scene &,               \
                                                 const Founders<dim> &,       \
                                                 const SurfacePatches<dim> &, \
                                                 const MPI_Comm);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
