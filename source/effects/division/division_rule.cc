// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/division/division_rule.h>
#include <morula/effects/fate/random.h>

#include <utility>

namespace Morula
{
  template <int dim>
  void
  DivisionRule<dim>::check_cell(const PresentCell<dim> &founder,
                                const double) const
  {
    Tensor<1, dim> direction;
    direction[0] = 1.;
    axis({founder.cell().founder_position(),
          founder.elastic(),
          direction,
          &founder});
  }


  template <int dim>
  DivisionAxes<dim>::DivisionAxes(
    const DivisionParameters                     &keys,
    StateColumns<dim>                            &state,
    const std::uint64_t                           seed,
    Rules                                         rules,
    const std::vector<const DivisionRule<dim> *> &of_type)
    : rules(std::move(rules))
    , follow_rotation(keys.axis_follows_rotation)
    , stay_inside(keys.stay_inside)
    , spread(state.use(keys.axis_spread))
    , least_anisotropy(state.use(keys.least_anisotropy))
    , seed(seed)
    , of_type(of_type)
  {}


  template <int dim>
  Tensor<1, dim>
  DivisionAxes<dim>::direction(const PresentCell<dim> &cell,
                               const double            t,
                               const Tensor<1, dim>   &random,
                               const std::uint64_t     key) const
  {
    const CellView<dim, const double> &view  = cell.cell();
    const double                       kappa = cell.value(spread, t);
    const Tensor<1, dim>               axis  = rule(cell.type())
                                  ->axis({view.founder_position(),
                                          view.elastic_deformation(),
                                          random,
                                          &cell,
                                          t,
                                          cell.value(least_anisotropy, t)});
    return kappa > 0. ?
             Random::direction_around(axis / axis.norm(), kappa, seed, key) :
             axis;
  }


  template <int dim>
  Tensor<1, dim>
  DivisionAxes<dim>::choose(const PresentCell<dim> &cell, const double t) const
  {
    // A rule that speaks of the present configuration gives a direction of the
    // step's beginning. It is pulled back by F, so that it turns with the
    // tissue until the daughters are placed at the end of the step.
    const std::uint64_t            key    = cell.lineage_key();
    const Tensor<1, dim>           random = Random::direction<dim>(seed, key);
    const DivisionRule<dim> *const rule   = this->rule(cell.type());
    if (rule == nullptr)
      return random;
    Tensor<1, dim> axis = direction(cell, t, random, key);
    if (rule->is_present())
      axis = invert(cell.cell().F()) * axis;
    return axis / axis.norm();
  }


  template class DivisionRule<2>;
  template class DivisionRule<3>;
  template class DivisionAxes<2>;
  template class DivisionAxes<3>;
} // namespace Morula
