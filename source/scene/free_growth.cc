// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/base/instantiate.h>
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
    /** So many evaluations of a law take some hundredths of a second. They are
     *  shared by all cells of a rank. */
    constexpr double most_evaluations = 2e4;
    /** Rates are taken at the beginning of a step. With 64 steps that is an
     * error of some percent, which is enough for an estimate. */
    constexpr double most_steps = 64.;
  } // namespace


  template <int dim>
  std::optional<FreeGrowth>
  free_growth(const Scene               &scene,
              const Founders<dim>       &founders,
              const SurfacePatches<dim> &surface,
              const MPI_Comm             comm)
  {
    // Some founders of this rank, at equal distances in their list, are taken
    // through the run free of stress. Sums and extremes are then those of all
    // ranks: collective, also for a rank without founders.
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
    const auto &fates = cells.development().fates();
    const bool  divides =
      std::any_of(fates.begin(), fates.end(), [](const auto &fate) {
        return fate->follows_growth();
      });
    double n = 0., sum = 0., n_cells = 0.;
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
        double n_of_founder = 0.;
        if (divides)
          {
            n_of_founder                   = 1.;
            std::vector<double>    row     = cells.row(i);
            const PresentCell<dim> founder = cells.cell(row, i);
            for (const auto &fate : fates)
              n_of_founder *= fate->expected_cells(founder, ratio);
          }
        n_cells += n_of_founder;
        growth.least = std::min(growth.least, ratio);
        growth.most  = std::max(growth.most, ratio);
      }
    growth.mean = Utilities::MPI::sum(sum, comm) / Utilities::MPI::sum(n, comm);
    growth.cells =
      Utilities::MPI::sum(n_cells, comm) / Utilities::MPI::sum(n, comm);
    growth.least = Utilities::MPI::min(growth.least, comm);
    growth.most  = Utilities::MPI::max(growth.most, comm);
    return growth;
  }


  MORULA_INSTANTIATE(free_growth);
} // namespace Morula
