// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_state_neighbour_variable_h
#define morula_effects_state_neighbour_variable_h

#include <morula/base/expression.h>

#include <optional>
#include <string>
#include <vector>

namespace Morula
{
  /** A variable of expressions that tells of a cell's neighbours:
   *  doc/theory.md, section 12.1. */
  struct NeighbourVariable
  {
    /** What it tells. */
    enum Kind
    {
      count,         // neighbours
      count_of_type, // neighbours_NAME
      share_of_type, // touching_NAME
      unlike,        // share of the surface that touches other types
      free,          // share that is free surface
      around,        // around_VAR, a mean over the neighbours
      slope          // slope_NAME, length of a field's gradient
    };

    /** Its name in scenes. */
    std::string name;
    Kind        kind;
    /** Number of the type, or of the field. */
    unsigned int number = 0;
    /** Of which it is the mean. */
    Variable variable = Variable::t;
  };

  /** The variable of this name, if it is one. @param types names of the cells'
   *  types @param fields names of the fields */
  std::optional<NeighbourVariable>
  neighbour_variable(const std::string              &name,
                     const std::vector<std::string> &types,
                     const std::vector<std::string> &fields);

  /** Whether a name begins as that of such a variable does, so that it must be
   *  meant to be one. */
  bool
  tells_of_neighbours(const std::string &name);
} // namespace Morula

#endif
