// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_founding_h
#define morula_simulation_founding_h

#include <morula/output/rows.h>
#include <morula/scene/scene.h>
#include <morula/scene/seeded_tissue.h>
#include <morula/scene/tissue_model.h>

#include <string>
#include <vector>

namespace Morula
{
  /** The points that this rank makes at t = 0, with all columns that effects
   *  need. They may lie in grid cells of other ranks. */
  template <int dim>
  struct FirstPoints
  {
    PointList<dim> cells, boundary_points;
    /** The founders' rows in lineage.csv. */
    std::vector<Birth<dim>> births;
  };

  /** Gives founders and patches the state in which they begin. Collective.
   *  @throws InputError on all ranks if an effect cannot handle a founder */
  template <int dim>
  FirstPoints<dim>
  found(const TissueModel<dim>  &model,
        const SeededTissue<dim> &seeded,
        const MPI_Comm           comm);

  /**
   * Refuses to resume from a snapshot of another scene. Only Time/End time,
   * Time/Step, Time/Stop at cells, and the sections Solver and Output may
   * differ. The directory's name may differ too, since it may have been moved.
   * @param parameters the snapshot's scene, as the text of a .prm file
   * @throws InputError with the key and both values
   */
  void
  check_resumable(const Scene &scene, const std::string &parameters);
} // namespace Morula

#endif
