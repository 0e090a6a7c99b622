// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_applied_h
#define morula_scene_applied_h

#include <morula/scene/tissue_model.h>
#include <morula/seeding/seeding.h>

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <mpi.h>

#include <cstdint>
#include <string>
#include <vector>

namespace Morula
{
  /** What a condition acts on at t = 0, over all ranks. */
  struct AppliedCondition
  {
    /** Name of the condition in the catalogue. */
    std::string name;
    /** Boundary points on which it acts, those excepted on which another one
     *  wins, and their area, µm^(dim-1). */
    std::uint64_t points = 0;
    double        area   = 0.;
    /** Those that its expression chooses, also where another one wins. */
    std::uint64_t chosen = 0;
    /** Corners of the box around these points, µm. */
    Point<3> lower, upper;
    /** Whether it is a load whose size is known before the run. */
    bool has_force = false;
    /** Sum of its forces at the end of the run on the surface of t = 0, and of
     *  their magnitudes, kPa µm^(dim-1). */
    Tensor<1, 3> force;
    double       magnitude = 0.;
    /** Whether it is a load that is zero at the end of every step. */
    bool is_idle = false;
    /** See BoundaryCondition. */
    bool is_tension = false;
  };

  /**
   * What the conditions on the surface, obstacles excepted, act on: the program
   * says what it applies before it does. Collective.
   * @throws InputError for expressions without a value at the end of the run
   */
  template <int dim>
  std::vector<AppliedCondition>
  applied_conditions(const TissueModel<dim>    &model,
                     const SurfacePatches<dim> &surface,
                     const MPI_Comm             comm);

  /** The components of a vector in the scene's dimension, e.g. "(1 0)". What is
   *  not larger than @p zero is printed as 0: sums that cancel leave rounding.
   */
  std::string
  vector_text(const Scene &scene, const Tensor<1, 3> &v, const double zero);

  /** E.g. "20 boundary points, 100 um, from (50 -48) to (50 48) um; force (2 0)
   *  kPa um at t = 1 day". */
  std::string
  text_of(const Scene &scene, const AppliedCondition &applied);

  /** The law, its constants, and what its energy is counted per. */
  std::string
  material_text(const Scene &scene);

  /** The lines of a run's log: one for the material, one for each condition. */
  std::vector<std::string>
  applied_texts(const Scene                         &scene,
                const std::vector<AppliedCondition> &applied);

  /** Adds warnings of conditions on few points or none and without a load. */
  void
  review_applied(const Scene                         &scene,
                 const std::vector<AppliedCondition> &applied,
                 std::vector<std::string>            &warnings);
} // namespace Morula

#endif
