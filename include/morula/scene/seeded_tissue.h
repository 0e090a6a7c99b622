// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_seeded_tissue_h
#define morula_scene_seeded_tissue_h

#include <morula/scene/applied.h>
#include <morula/scene/checks.h>
#include <morula/scene/held_pieces.h>
#include <morula/scene/tissue_model.h>
#include <morula/seeding/seeding.h>

#include <mpi.h>

#include <string>
#include <vector>

namespace Morula
{
  /** The tissue of a scene at t = 0, on this rank, and what the checks of the
   *  scene have found there. */
  template <int dim>
  struct SeededTissue
  {
    Founders<dim>       founders;
    SurfacePatches<dim> surface;
    /** Founders that proliferate, over all ranks. */
    types::particle_index n_proliferating = 0;
    ConditionCounts       counts;
    /** See applied_conditions(). */
    std::vector<AppliedCondition> applied;
    /** What bodies are that interact, by their numbers. */
    std::vector<BodyMeasures> measures;
    /** Of how many bodies and pieces tissue from a file is, and which closed
     *  surfaces its mesh has; empty otherwise. */
    std::string bodies, mesh;

    /** How far the tissue is cut at t = 0; empty if it is not. */
    std::string cuts;
    /** See held_pieces(). */
    std::vector<HeldPiece> pieces;
    /** See scene_warnings(). */
    std::vector<std::string> warnings;
  };

  /** E.g. "2 bodies in 1 piece of the grid". Collective. */
  template <int dim>
  std::string
  bodies_text(const Scene             &scene,
              const SeededTissue<dim> &tissue,
              const MPI_Comm           comm);

  /** Whether the tissue of a scene has boundary points. */
  template <int dim>
  bool
  has_surface(const TissueModel<dim> &model);

  /**
   * Seeds the tissue, with a surface around cells from a file if Tissue/Points
   * surface or a boundary condition asks for one, and lets all effects check
   * it. This is the longest work before the first step, so --explain and the
   * run share its result. Collective, and all throw together.
   * @throws InputError for a scene that cannot be run
   */
  template <int dim>
  SeededTissue<dim>
  seed_tissue(const TissueModel<dim> &model, const MPI_Comm comm);
} // namespace Morula

#endif
