// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_program_explain_h
#define morula_program_explain_h

#include <morula/scene/scene.h>

#include <mpi.h>

#include <iosfwd>

namespace Morula
{
  /**
   * Seeds the tissue, makes all checks, and prints on rank 0 what the scene
   * will simulate: numbers of cells and boundary points, effects that are on
   * and off, the columns of a cell, the expected cells and memory, estimates of
   * unknowns and time, and the warnings. Simulates nothing and writes no file.
   * Collective.
   * @param json print it as a JSON object, with all keys as used
   * @throws InputError
   */
  void
  explain(const Scene   &scene,
          std::ostream  &out,
          const MPI_Comm comm,
          const bool     json = false);
} // namespace Morula

#endif
