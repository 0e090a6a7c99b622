// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_patch_lists_h
#define morula_seeding_patch_lists_h

#include <morula/seeding/filling.h>
#include <morula/seeding/seeding.h>

#include <mpi.h>

#include <optional>
#include <vector>

namespace Morula
{
  /** The cells of all ranks, on rank 0, body by body: those of one body if
   *  founders do not know theirs. Collective. */
  template <int dim>
  std::vector<AllCells<dim>>
  cells_of_bodies(const Founders<dim> &founders, const MPI_Comm comm);

  /** Adds the patches of one body to those of all. @param body its number, if
   *  bodies are told apart */
  template <int dim>
  void
  append_patches(const SurfacePatches<dim>         &more,
                 const std::optional<unsigned int> &body,
                 SurfacePatches<dim>               &all);

  /** This rank's share of the patches that rank 0 has. Collective. */
  template <int dim>
  SurfacePatches<dim>
  shares_of(const SurfacePatches<dim> &all, const MPI_Comm comm);
} // namespace Morula

#endif
