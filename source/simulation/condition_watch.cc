// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/simulation/condition_watch.h>

#include <deal.II/base/mpi.h>

#include <sstream>

namespace Morula
{
  template <int dim>
  ConditionWatch<dim>::ConditionWatch(const TissueModel<dim> &model,
                                      const Announce         &announce)
    : model(model)
    , announce(announce)
  {}


  template <int dim>
  void
  ConditionWatch<dim>::begin(const Tissue<dim> &tissue)
  {
    if (!has_begun)
      before = count(tissue);
    has_begun = true;
  }


  template <int dim>
  std::map<std::string, std::uint64_t>
  ConditionWatch<dim>::count(const Tissue<dim> &tissue) const
  {
    // Points keep the place and normal by which conditions choose them. The
    // names follow from the scene, so that all ranks add up the same ones.
    // Obstacles act where they touch and hold nothing.
    const BoundaryPoints<dim>           &points = tissue.boundary_points();
    std::map<std::string, std::uint64_t> n;
    const auto add = [&](const std::string &name, const auto &acts_on) {
      std::uint64_t mine = 0;
      for (unsigned int p = 0; p < points.size(); ++p)
        mine += acts_on(points[p].seed_position(), points[p].initial_normal());
      n[name] = Utilities::MPI::sum(mine, tissue.communicator());
    };
    for (const auto &named : model.boundary_conditions.list())
      if (!named.condition->only_pushes())
        add(named.name, [&](const Point<dim> &X, const Tensor<1, dim> &N) {
          return named.condition->acts_on(X, N);
        });
    for (const EffectKeys *const keys : model.scene.keys_in_use())
      for (const ExpressionKey *const where : keys->places())
        add(where->path(), [&](const Point<dim> &X, const Tensor<1, dim> &) {
          return where->expression(dim).value(X, 0.) > 0.;
        });
    return n;
  }


  template <int dim>
  void
  ConditionWatch<dim>::look(const Tissue<dim> &tissue, const double t)
  {
    // Some points may go with their cells, and forces.csv has their number.
    // Once the last one is gone the scene is another one. Where all cells are
    // gone nothing is left to be told of.
    const auto now = count(tissue);
    const bool has_cells =
      Utilities::MPI::sum<std::uint64_t>(tissue.cells().size(),
                                         tissue.communicator()) > 0;
    for (const auto &[name, n] : now)
      if (before[name] > 0 && n == 0 && has_cells)
        {
          std::ostringstream text;
          text << "Warning: from t = " << t << " day on " << name
               << " acts on no boundary point any more, and did on "
               << before[name]
               << " before: the cells near them are gone. What it held, loaded "
                  "or fed goes on without it. Keep these cells alive, or "
                  "choose a place that stays.";
          announce(text.str());
        }
    before = now;
  }


  template class ConditionWatch<2>;
  template class ConditionWatch<3>;
} // namespace Morula
