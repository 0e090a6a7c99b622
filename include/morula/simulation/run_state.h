// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_run_state_h
#define morula_simulation_run_state_h

#include <morula/effects/tables.h>
#include <morula/output/snapshot.h>
#include <morula/particles/tissue.h>
#include <morula/simulation/step_error.h>
#include <morula/simulation/time_steps.h>

#include <optional>

namespace Morula
{
  /** What outlives a step besides the tissue. */
  struct RunState
  {
    types::particle_index next_id          = 0; // of cells
    types::particle_index next_boundary_id = 0; // if the surface is refined
    unsigned int          n_steps          = 0;
    unsigned int          n_rejected       = 0;
    /** Numbers of the effects: Tables::kept(). */
    NamedNumbers kept = {};
    /** The volume that the surface enclosed at t = 0 over that of the cells;
     *  nothing if it was not closed. */
    std::optional<double> enclosed_share = {};
    /** The drag of tissue that goes slowly: slow_steps.h. */
    double drag = 1.;
    /** The estimated error of the steps so far. */
    ErrorInTime error = {};
  };

  /**
   * Everything that outlives a step, for snapshot.h5; the files of the run add
   * their own.
   * @param has_boundary_ids whether ids of boundary points are given
   */
  template <int dim>
  SnapshotData<dim>
  snapshot_of(const Tissue<dim>      &tissue,
              const TimeSteps::State &time_steps,
              const RunState         &state,
              const bool              has_boundary_ids);

  /** Fills the tissue with the points of a snapshot, which are taken out of it.
   *  Collective. @throws InputError where the snapshot lacks anything */
  template <int dim>
  void
  restore_tissue(SnapshotData<dim> &data, Tissue<dim> &tissue);

  /** The place in the sequence of steps. @throws InputError if it is missing */
  template <int dim>
  TimeSteps::State
  saved_time_steps(const SnapshotData<dim> &data);

  /** The run state. @param kept the numbers of the effects at t = 0: what the
   *  snapshot does not know of them is that. @throws InputError likewise */
  template <int dim>
  RunState
  saved_run_state(const SnapshotData<dim> &data,
                  const bool               has_boundary_ids,
                  const NamedNumbers      &kept);
} // namespace Morula

#endif
