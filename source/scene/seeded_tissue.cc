// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/scene/seeded_tissue.h>
#include <morula/scene/size.h>
#include <morula/scene/warnings.h>

namespace Morula
{
  template <int dim>
  SeededTissue<dim>
  seed_tissue(const Scene &scene, const MPI_Comm comm)
  {
    SeededTissue<dim> tissue;
    tissue.founders =
      seed_founders(scene.tissue, comm, seeding_limits<dim>(scene, comm));
    tissue.surface = seed_surface<dim>(scene.tissue, comm);
    tissue.n_proliferating =
      check_at_cells(scene, tissue.founders.positions, comm);
    tissue.counts   = check_at_surface(scene, tissue.surface, comm);
    tissue.warnings = scene_warnings(
      scene, tissue.founders, tissue.surface, tissue.counts, comm);
    return tissue;
  }


  template SeededTissue<2>
  seed_tissue(const Scene &, const MPI_Comm);
  template SeededTissue<3>
  seed_tissue(const Scene &, const MPI_Comm);
} // namespace Morula
