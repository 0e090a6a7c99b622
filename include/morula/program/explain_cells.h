// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_program_explain_cells_h
#define morula_program_explain_cells_h

#include <morula/scene/scene.h>

#include <deal.II/particles/property_pool.h>

#include <ostream>
#include <vector>

namespace Morula
{
  /** Prints the types of cells, and for each type the keys that it sets
   *  differently. Prints nothing without types. @param n_founders by type, on
   *  all ranks */
  void
  print_types(std::ostream                             &out,
              const Scene                              &scene,
              const std::vector<types::particle_index> &n_founders);

  /** Prints which expressions use variables of the present cell, which
   *  variables these are, and when they are evaluated. Prints nothing if there
   *  are none. */
  void
  print_cell_expressions(std::ostream &out, const Scene &scene);
} // namespace Morula

#endif
