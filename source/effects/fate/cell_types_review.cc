// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/effects/fate/cell_type_parameters.h>
#include <morula/effects/scene_keys.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

namespace Morula
{
  namespace
  {
    /** The types that founders have or that their descendants can get.
     *  @param n_founders of all ranks, by type */
    std::set<unsigned int>
    types_reached(const CellTypesParameters                &parameters,
                  const std::vector<types::particle_index> &n_founders,
                  const bool                                cells_divide)
    {
      // A type is reached by transitions from a type that is reached, and by
      // divisions. Whether its cells divide is not asked.
      const auto            &types = parameters.types;
      std::set<unsigned int> reached, open;
      for (unsigned int i = 0; i < types.size(); ++i)
        if (n_founders[i] > 0)
          open.insert(i);
      while (!open.empty())
        {
          const unsigned int i = *open.begin();
          open.erase(open.begin());
          reached.insert(i);
          std::set<std::string> names;
          for (const ExpressionKey &to : types[i].transitions)
            if (to.is_changed())
              names.insert(to.path().substr(to.path().rfind(" ") + 1));
          if (cells_divide)
            {
              const auto [one, other] = parameters.daughters(i);
              names.insert({types[one].name, types[other].name});
            }
          for (unsigned int j = 0; j < types.size(); ++j)
            if (names.count(types[j].name) > 0 && reached.count(j) == 0)
              open.insert(j);
        }
      return reached;
    }

    /** Founders of the first type at which its own Where does not hold: those
     *  that no other type takes are of the first one. Collective. */
    template <int dim>
    void
    review_first_type(const CellTypesParameters &parameters,
                      const Preview<dim>        &scene,
                      Review                    &review)
    {
      const auto          &types = parameters.types;
      const ExpressionKey &where = types.front().where;
      if (where.empty())
        return;
      types::particle_index n = 0;
      for (const Point<dim> &X : scene.founders)
        n += std::none_of(types.begin(), types.end(), [&](const auto &type) {
          return !type.where.empty() &&
                 type.where.expression(dim).value(X, 0.) > 0.;
        });
      if (n = Utilities::MPI::sum(n, scene.comm); n > 0)
        review.warn(where.path(),
                    where.text(),
                    "it does not hold at " + std::to_string(n) +
                      " founders for which no other type's Where holds: they "
                      "are of this type all the same, as it is the first.",
                    "Name the type of the others first in " +
                      parameters.names.path() + ", or remove this key.");
    }
  } // namespace


  template <int dim>
  void
  review_types(const CellTypesParameters &parameters,
               const Preview<dim>        &scene,
               const bool                 of_file,
               Review                    &review)
  {
    // The numbers of founders are those of all ranks, so that all warn alike.
    // Types of a file do not follow from Where.
    const auto                        &types = parameters.types;
    std::vector<types::particle_index> n_founders(types.size(), 0);
    for (const unsigned int type : scene.types)
      ++n_founders[type];
    Utilities::MPI::sum(n_founders, scene.comm, n_founders);
    const bool cells_divide = scene.keys.cells_divide();
    const auto reached = types_reached(parameters, n_founders, cells_divide);
    for (unsigned int i = 0; i < types.size(); ++i)
      {
        if (reached.count(i) == 0)
          review.warn(parameters.names.path(),
                      types[i].name,
                      "no founder is of this type, and no transition or "
                      "division leads to it.",
                      "Say where it is by Where, or remove it.");
        if (!types[i].daughters->empty() && !cells_divide)
          review.warn(types[i].daughters.path(),
                      types[i].daughters.value(),
                      "no cell divides.",
                      "Set Proliferation/Law, or remove this key.");
      }
    if (!types.empty() && !of_file)
      review_first_type(parameters, scene, review);
  }


  MORULA_INSTANTIATE(review_types);
} // namespace Morula
