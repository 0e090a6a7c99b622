// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// A step effect: counts the days that all cells have lived, a number that
// outlives a step.

#ifndef own_effects_census_h
#define own_effects_census_h

#include <morula/effects/step_effect.h>

#include <deal.II/base/mpi.h>

namespace Own
{
  using namespace Morula;

  struct CensusKeys : public EffectKeys
  {
    Key<bool> take{{this, "Take"}, false, "Whether a census is taken."};

    bool
    is_on() const override
    {
      return take;
    }
  };

  template <int dim>
  class Census : public StepEffect<dim>
  {
  public:
    using Parameters = CensusKeys;

    explicit Census(const Parameters &) {}

    void
    declare(Tables<dim> &tables) const override
    {
      tables.add_number("cell_days");
      tables.keep_number("cell_days", 0.);
    }

    void
    after(Tissue<dim> &tissue, const MomentOfRun<dim> &moment) const override
    {
      moment.kept["cell_days"] +=
        moment.dt * Utilities::MPI::sum<double>(tissue.cells().size(),
                                                tissue.communicator());
      moment.of_step["cell_days"] = moment.kept["cell_days"];
    }
  };
} // namespace Own

#endif
