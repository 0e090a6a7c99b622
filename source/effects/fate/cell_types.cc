// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fate/cell_types.h>
#include <morula/effects/fate/hazard.h>
#include <morula/effects/fate/random.h>
#include <morula/effects/state/present_cell.h>

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace Morula
{
  template <int dim>
  CellTypes<dim>::CellTypes(const CellTypesParameters &parameters,
                            const EffectSetting<dim>  &setting)
    : random_seed(setting.random_seed)
  {
    std::size_t most = 0;
    for (unsigned int type = 0; type < parameters.types.size(); ++type)
      {
        const CellTypeKeys &keys = parameters.types[type];
        where.push_back(keys.where.optional(dim));
        daughters_.push_back(parameters.daughters(type));
        transitions.emplace_back();
        for (unsigned int k = 0; k < keys.transitions.size(); ++k)
          if (!keys.transitions[k].is_default())
            transitions.back().push_back(
              {k < type ? k : k + 1, setting.state.use(keys.transitions[k])});
        most = std::max(most, transitions.back().size());
      }
    if (most == 0)
      return;
    n_changes = setting.columns.template add<unsigned int>(
      {"type_changes",
       "",
       "how often the cell has changed its type",
       0,
       AtDivision::reset});
    for (std::size_t k = 0; k < most; ++k)
      hazards.push_back(setting.columns.template add<double>(
        {"transition_hazard_" + std::to_string(k + 1),
         "",
         "rate of a way out of the type, integrated",
         0.,
         AtDivision::reset}));
    for (std::size_t k = 0; k < most; ++k)
      expected.push_back(
        std::any_of(transitions.begin(),
                    transitions.end(),
                    [k](const std::vector<Transition> &ways) {
                      return k < ways.size() && ways[k].rate.follows_state();
                    }) ?
          setting.columns.template add<double>(
            {"transition_rate_" + std::to_string(k + 1),
             "1/day",
             "rate of a way out of the type that the last step saw; -1: none",
             not_expected,
             AtDivision::reset}) :
          Column<double>());
  }


  template <int dim>
  unsigned int
  CellTypes<dim>::founder_type(const Point<dim> &X) const
  {
    for (unsigned int type = where.size(); type-- > 1;)
      if (where[type] && where[type]->value(X, 0.) > 0.)
        return type;
    return 0;
  }


  template <int dim>
  std::pair<unsigned int, unsigned int>
  CellTypes<dim>::daughters(const unsigned int type) const
  {
    return daughters_[type];
  }


  template <int dim>
  std::optional<typename CellTypes<dim>::Change>
  CellTypes<dim>::next_change(const PresentCell<dim>      &cell,
                              const CellView<dim, double> &after,
                              const double                 t0,
                              const double                 t1) const
  {
    const std::vector<Transition> &ways = transitions[cell.type()];
    std::optional<Change>          change;
    if (ways.empty())
      return change;
    const unsigned int  n   = after.get(n_changes);
    const std::uint64_t key = cell.lineage_key();
    std::vector<Hazard> all;
    for (std::size_t k = 0; k < ways.size(); ++k)
      {
        all.push_back({cell.value(ways[k].rate, 0.5 * (t0 + t1)),
                       after.get(hazards[k]),
                       Random::transition_threshold(random_seed, key, n, k)});
        const double latest = change ? change->time : t1;
        if (const auto time = all[k].event(t0, latest))
          change = Change{*time, ways[k].to};
      }
    const double until = change ? change->time : t1;
    for (std::size_t k = 0; k < ways.size(); ++k)
      after.set(hazards[k], all[k].integral_at(t0, until));
    return change;
  }


  template <int dim>
  void
  CellTypes<dim>::make_good(const PresentCell<dim>      &cell,
                            const CellView<dim, double> &row) const
  {
    const PastStep                &past = cell.reader().past;
    const std::vector<Transition> &ways = transitions[cell.type()];
    for (std::size_t k = 0; k < ways.size(); ++k)
      if (expected[k].exists())
        row.set(hazards[k],
                with_missed(row.get(hazards[k]),
                            cell.value(ways[k].rate, past.middle()),
                            row.get(expected[k]),
                            past.length()));
  }


  template <int dim>
  void
  CellTypes<dim>::expect_rates(const PresentCell<dim>      &cell,
                               const CellView<dim, double> &row,
                               const double                 t,
                               const bool                   is_whole) const
  {
    const std::vector<Transition> &ways = transitions[cell.type()];
    for (std::size_t k = 0; k < expected.size(); ++k)
      if (expected[k].exists())
        row.set(expected[k],
                is_whole && k < ways.size() ? cell.value(ways[k].rate, t) :
                                              not_expected);
  }


  template <int dim>
  void
  CellTypes<dim>::change(const CellView<dim, double> &cell,
                         const StateColumns<dim>     &columns,
                         const unsigned int           to,
                         const double                 time) const
  {
    cell.set(columns.type, to);
    if (columns.type_since.exists())
      cell.set(columns.type_since, time);
    if (n_changes.exists())
      cell.set(n_changes, cell.get(n_changes) + 1);
    for (const Column<double> &hazard : hazards)
      cell.set(hazard, 0.);
  }


  template <int dim>
  void
  CellTypes<dim>::check_cell(const PresentCell<dim> &founder) const
  {
    for (const Transition &way : transitions[founder.type()])
      founder.value(way.rate, 0.);
  }


  template <int dim>
  std::vector<const Expression *>
  CellTypes<dim>::rates(const unsigned int type) const
  {
    std::vector<const Expression *> list;
    for (const Transition &way : transitions[type])
      list.push_back(&way.rate);
    return list;
  }


  template <int dim>
  unsigned int
  CellTypes<dim>::size() const
  {
    return transitions.size();
  }


  template class CellTypes<2>;
  template class CellTypes<3>;
} // namespace Morula
