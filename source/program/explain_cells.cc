// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/program/explain_parts.h>

#include <iomanip>
#include <string>

namespace Morula
{
  namespace
  {
    /** The variables of an expression that only a present cell has. */
    std::string
    variables_of_cells(const Expression &expression)
    {
      std::string names;
      // The variables of place and time, up to t, come first in the list; all
      // behind them belong to cells.
      for (const Variable variable : expression.used())
        if (variable > Variable::t)
          names += (names.empty() ? "" : ", ") +
                   expression.vocabulary().name_of(variable);
      return names;
    }
  } // namespace


  void
  print_types(std::ostream                             &out,
              const Scene                              &scene,
              const std::vector<types::particle_index> &n_founders)
  {
    const std::vector<std::string> names = scene.type_names();
    if (!names.empty())
      out << "Cell types\n";
    for (unsigned int i = 0; i < names.size(); ++i)
      out << "  " << std::left << std::setw(24) << names[i] << n_founders[i]
          << (n_founders[i] == 1 ? " founder" : " founders") << '\n'
          << scene.cell_types.details_of(i);
  }


  void
  print_cell_expressions(std::ostream &out, const Scene &scene)
  {
    bool first = true;
    for (const AnyKey *key : scene.list())
      {
        const auto *expression = dynamic_cast<const ExpressionKey *>(key);
        if (expression == nullptr || expression->empty() ||
            !expression->is_of_cells())
          continue;
        const std::string variables =
          variables_of_cells(expression->expression(scene.dimension));
        if (variables.empty())
          continue;
        if (first)
          out << "Expressions of the present cell\n";
        first = false;
        out << "  " << key->path() << ", evaluated "
            << description_of(expression->evaluated()) << ": " << variables
            << '\n';
      }
  }
} // namespace Morula
