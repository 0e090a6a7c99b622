// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_run_tables_h
#define morula_simulation_run_tables_h

#include <morula/scene/tissue_model.h>

#include <string>
#include <vector>

namespace Morula
{
  /** A table that grows by rows as the run goes on. */
  struct Table
  {
    std::string              name; // of the file, without ending
    std::vector<std::string> columns;
    // A resumed run may have the table although the run began without it.
    bool may_begin_later = false;
  };

  /** The tables of a run of this scene. */
  template <int dim>
  std::vector<Table>
  tables_of(const TissueModel<dim> &model);
} // namespace Morula

#endif
