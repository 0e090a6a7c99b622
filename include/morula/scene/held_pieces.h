// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_held_pieces_h
#define morula_scene_held_pieces_h

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
  /** What holds a piece of the tissue at t = 0, and which load is left to its
   *  unsupported rigid motions, over all ranks. */
  struct HeldPiece
  {
    std::uint64_t cells = 0;
    /** Centre of its cells' volume, µm. */
    Point<3> center;
    /** Fixed or slip boundary points on it. */
    std::uint64_t held_points = 0;
    /** Whether friction of cells holds it. */
    bool has_friction = false;
    /** Number of rigid motions that nothing holds, doc/theory.md (4.9). */
    unsigned int free_motions = 0;
    /** Sum of its loads at the end of the run on the configuration of t = 0,
     *  kPa µm^(dim-1), and their moment about the centre, kPa µm^dim; in 2-D
     *  the third component. */
    Tensor<1, 3> force, moment;
    /** Whether a part of the loads acts along a free motion. */
    bool is_unbalanced = false;
  };

  /**
   * The pieces that hold cells, largest first. Collective.
   * @throws InputError for expressions without a value at the end of the run
   */
  template <int dim>
  std::vector<HeldPiece>
  held_pieces(const TissueModel<dim>    &model,
              const Founders<dim>       &founders,
              const SurfacePatches<dim> &surface,
              const MPI_Comm             comm);

  /** E.g. "100 cells around (0 0) um: nothing holds it; inertia balances a
   *  force of (1 0) kPa um", one for each of the first pieces. */
  std::vector<std::string>
  texts_of(const Scene &scene, const std::vector<HeldPiece> &pieces);

  /** Adds a warning of loads that nothing balances but inertia, or the weak
   * drag of scenes with obstacles. */
  void
  review_held(const Scene                  &scene,
              const std::vector<HeldPiece> &pieces,
              std::vector<std::string>     &warnings);
} // namespace Morula

#endif
