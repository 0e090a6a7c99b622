// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/effects/division/division_axes.h>
#include <morula/effects/fate/random.h>
#include <morula/effects/state/present_cell.h>

#include <utility>

namespace Morula
{
  template <int dim>
  Tensor<1, dim>
  axis_by_rule(const DivisionRule<dim> &rule,
               const PresentCell<dim>  &cell,
               const double             t,
               const Tensor<1, dim>    &random,
               const AxisDraw          &draw)
  {
    const CellView<dim, const double> &view = cell.cell();
    const Tensor<1, dim> axis = rule.axis({view.founder_position(),
                                           view.elastic_deformation(),
                                           random,
                                           &cell,
                                           t,
                                           draw.least_anisotropy});
    return draw.spread > 0. ? Random::direction_around(axis / axis.norm(),
                                                       draw.spread,
                                                       draw.seed,
                                                       draw.key) :
                              axis;
  }


  template <int dim>
  const DivisionRule<dim> *
  DivisionRules<dim>::rule(const unsigned int type) const
  {
    // Without types of cells there is at most one rule; null stands for the
    // random axis.
    if (!of_type.empty())
      return of_type[type];
    return list.empty() ? nullptr : list.front().get();
  }


  template <int dim>
  DivisionAxes<dim>::DivisionAxes(const DivisionParameters &keys,
                                  StateColumns<dim>        &state,
                                  DivisionRules<dim>        rules,
                                  const std::uint64_t       seed)
    : spread(state.use(keys.axis_spread))
    , least_anisotropy(state.use(keys.least_anisotropy))
    , follows_rotation(keys.axis_follows_rotation)
    , stay_inside_(keys.stay_inside)
    , all(std::move(rules))
    , seed(seed)
  {}


  template <int dim>
  Tensor<1, dim>
  DivisionAxes<dim>::choose(const PresentCell<dim> &cell, const double t) const
  {
    // A rule that speaks of the present configuration gives a direction of the
    // step's beginning. It is pulled back by F, so that it turns with the
    // tissue until the daughters are placed at the end of the step.
    const std::uint64_t            key    = cell.lineage_key();
    const Tensor<1, dim>           random = Random::direction<dim>(seed, key);
    const DivisionRule<dim> *const rule   = all.rule(cell.type());
    if (rule == nullptr)
      return random;
    Tensor<1, dim> axis =
      axis_by_rule(*rule, cell, t, random, draw(cell, t, key));
    if (rule->frame() == AxisFrame::present)
      axis = invert(cell.cell().F()) * axis;
    return axis / axis.norm();
  }


  template <int dim>
  Tensor<1, dim>
  DivisionAxes<dim>::placement(const CellView<dim, const double> &cell,
                               const Tensor<1, dim>              &axis,
                               const unsigned int                 type) const
  {
    const DivisionRule<dim> *const rule = all.rule(type);
    Tensor<1, dim>                 now  = axis;
    if (rule != nullptr && rule->frame() == AxisFrame::present)
      now = cell.F() * axis;
    else if (follows_rotation)
      now = cell.elastic_deformation() * axis;
    return now / now.norm();
  }


  MORULA_INSTANTIATE(axis_by_rule);
  template struct DivisionRules<2>;
  template struct DivisionRules<3>;
  template class DivisionAxes<2>;
  template class DivisionAxes<3>;
} // namespace Morula
