// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/effect.h>
#include <morula/effects/fate/cell_types.h>
#include <morula/effects/fate/random.h>
#include <morula/effects/state/present_cell.h>
#include <morula/effects/tables.h>

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace Morula
{
  template <int dim>
  CellTypes<dim>::CellTypes(const CellTypesParameters &parameters,
                            const EffectSetting<dim>  &setting)
    : names(parameters.name_list())
    , random_seed(setting.random_seed)
  {
    // First the ways out of each type are collected: only rates that the scene
    // sets, with the number of the type to which they lead. Then the columns
    // are declared. A cell has one type at a time, so ways are numbered within
    // its type and all types share the columns: as many as the type with the
    // most ways needs.
    std::vector<std::vector<std::pair<unsigned int, Expression>>> ways;
    std::size_t                                                   most = 0;
    transitions.resize(parameters.types.size());
    for (unsigned int type = 0; type < parameters.types.size(); ++type)
      {
        const CellTypeKeys &keys = parameters.types[type];
        where.push_back(keys.where.optional(dim));
        daughters_.push_back(parameters.daughters(type));
        ways.emplace_back();
        for (unsigned int k = 0; k < keys.transitions.size(); ++k)
          if (!keys.transitions[k].is_default())
            // The list of a type leaves the type itself out, hence the shift.
            ways.back().emplace_back(k < type ? k : k + 1,
                                     setting.state.use(keys.transitions[k]));
        most = std::max(most, ways.back().size());
      }
    if (most == 0)
      return;
    CellColumns<dim> &columns = setting.columns;
    n_changes =
      columns.template add<unsigned int>({"type_changes",
                                          "",
                                          "how often the cell has changed its "
                                          "type",
                                          0,
                                          AtDivision::reset});
    for (std::size_t k = 0; k < most; ++k)
      hazards.push_back(columns.template add<double>(
        {"transition_hazard_" + std::to_string(k + 1),
         "",
         "rate of a way out of the type, integrated",
         0.,
         AtDivision::reset}));
    for (std::size_t k = 0; k < most; ++k)
      expected.push_back(
        std::any_of(ways.begin(),
                    ways.end(),
                    [k](const auto &of_type) {
                      return k < of_type.size() &&
                             of_type[k].second.follows_state();
                    }) ?
          columns.template add<double>(
            {"transition_rate_" + std::to_string(k + 1),
             "1/day",
             "rate of a way out of the type that the last step saw; -1: none",
             not_expected,
             AtDivision::reset}) :
          Column<double>());
    for (unsigned int type = 0; type < ways.size(); ++type)
      for (std::size_t k = 0; k < ways[type].size(); ++k)
        transitions[type].push_back(
          {ways[type][k].first,
           CellHazard<dim>(ways[type][k].second, hazards[k], expected[k])});
  }


  template <int dim>
  unsigned int
  CellTypes<dim>::founder_type(const Point<dim> &X) const
  {
    // The last type whose condition holds counts, so the search goes backwards.
    // Type 0 is that of all others and is not asked.
    for (unsigned int type = where.size(); type-- > 1;)
      if (where[type] && where[type]->value(X, 0.) > 0.)
        return type;
    return 0;
  }


  template <int dim>
  typename CellTypes<dim>::Outlook
  CellTypes<dim>::outlook(const PresentCell<dim>            &cell,
                          const CellView<dim, const double> &row,
                          const Stretch                     &stretch) const
  {
    // This finds which way out comes first in the stretch, doc/theory.md (6.6)
    // and (6.7). Rates are read from the cell's state of the step's beginning,
    // with the time of the stretch's middle. Each way is asked only for an
    // event before the earliest so far. Thresholds follow from the lineage key
    // and the number of changes, so asking again gives the same answer.
    const std::vector<Transition> &ways = transitions[cell.type()];
    Outlook                        outlook;
    if (ways.empty())
      return outlook;
    const unsigned int  n   = row.get(n_changes);
    const std::uint64_t key = cell.lineage_key();
    for (std::size_t k = 0; k < ways.size(); ++k)
      {
        outlook.ways.push_back(ways[k].hazard.in(
          stretch,
          cell,
          row,
          Random::transition_threshold(random_seed, key, n, k)));
        const double latest = outlook.time.value_or(stretch.end);
        if (const auto time = outlook.ways[k].event(stretch.begin, latest))
          {
            outlook.time = time;
            outlook.to   = ways[k].to;
          }
      }
    return outlook;
  }


  template <int dim>
  void
  CellTypes<dim>::integrate(const Outlook               &outlook,
                            const Stretch               &stretch,
                            const double                 s,
                            const CellView<dim, double> &row) const
  {
    // All ways are integrated until the same time, that of the event or the
    // end.
    for (std::size_t k = 0; k < outlook.ways.size(); ++k)
      row.set(hazards[k], outlook.ways[k].integral_at(stretch.begin, s));
  }


  template <int dim>
  std::optional<double>
  CellTypes<dim>::next(const PresentCell<dim>      &cell,
                       const CellView<dim, double> &row,
                       const Stretch               &stretch) const
  {
    // The integrals are written as if this event happened. If another fate
    // comes first, pass() sets them again.
    const Outlook outlook = this->outlook(cell, row, stretch);
    integrate(outlook, stretch, outlook.time.value_or(stretch.end), row);
    return outlook.time;
  }


  template <int dim>
  void
  CellTypes<dim>::pass(const PresentCell<dim>      &cell,
                       const CellView<dim, double> &row,
                       const Stretch               &stretch,
                       const double                 s) const
  {
    // Integrals are read from `cell`, the row of the round's beginning, because
    // next() has already changed `row`.
    integrate(outlook(cell, cell.cell(), stretch), stretch, s, row);
  }


  template <int dim>
  LifeAfter
  CellTypes<dim>::happen(const PresentCell<dim>      &cell,
                         const CellView<dim, double> &row,
                         const Stretch               &stretch,
                         const double                 s,
                         std::vector<CellEvent>      &events) const
  {
    // A new type has other ways out, so all integrals begin anew, and the count
    // of changes gives it new thresholds.
    const unsigned int       to      = *outlook(cell, cell.cell(), stretch).to;
    const StateColumns<dim> &columns = cell.reader().columns;
    events.push_back({s, cell.id(), CellEvent::transition, cell.type(), to});
    row.set(columns.type, to);
    if (columns.type_since.exists())
      row.set(columns.type_since, s);
    row.set(n_changes, row.get(n_changes) + 1);
    for (const Column<double> &hazard : hazards)
      row.set(hazard, 0.);
    return LifeAfter::goes_on;
  }


  template <int dim>
  void
  CellTypes<dim>::inherit(const CellView<dim, double> &daughter,
                          const StateColumns<dim>     &columns,
                          const unsigned int           which,
                          const double                 birth) const
  {
    // A daughter of her mother's type keeps the time since when she has it; one
    // of another type gets it at birth.
    const unsigned int type = daughter.get(columns.type);
    const unsigned int own =
      which == 0 ? daughters_[type].first : daughters_[type].second;
    if (own == type)
      return;
    daughter.set(columns.type, own);
    if (columns.type_since.exists())
      daughter.set(columns.type_since, birth);
  }


  template <int dim>
  void
  CellTypes<dim>::make_good(const PresentCell<dim>      &cell,
                            const CellView<dim, double> &row) const
  {
    for (const Transition &way : transitions[cell.type()])
      way.hazard.make_good(cell, row);
  }


  template <int dim>
  void
  CellTypes<dim>::expect(const PresentCell<dim>      &cell,
                         const CellView<dim, double> &row,
                         const double                 t,
                         const bool                   is_whole) const
  {
    // Columns beyond the ways of this type say that nothing is expected.
    const std::vector<Transition> &ways = transitions[cell.type()];
    for (std::size_t k = 0; k < expected.size(); ++k)
      if (k < ways.size())
        ways[k].hazard.expect(cell, row, t, is_whole);
      else if (expected[k].exists())
        row.set(expected[k], not_expected);
  }


  template <int dim>
  void
  CellTypes<dim>::declare(Tables<dim> &tables) const
  {
    tables.record_events();
    for (unsigned int type = 0; type < names.size(); ++type)
      tables.add_sum("cells_" + names[type],
                     [type](const PresentCell<dim> &cell) {
                       return cell.type() == type ? 1. : 0.;
                     });
  }


  template <int dim>
  void
  CellTypes<dim>::check_cell(const PresentCell<dim> &founder,
                             const double) const
  {
    for (const Transition &way : transitions[founder.type()])
      founder.value(way.hazard.rate(), 0.);
  }


  template <int dim>
  std::vector<const Expression *>
  CellTypes<dim>::rates(const unsigned int type) const
  {
    std::vector<const Expression *> list;
    for (const Transition &way : transitions[type])
      list.push_back(&way.hazard.rate());
    return list;
  }


  template <int dim>
  void
  CellTypes<dim>::review(const Preview<dim> &scene, Review &review) const
  {
    for (unsigned int type = 0; type < size(); ++type)
      for (const Expression *const rate : rates(type))
        review_rate(*rate, "no cell changes its type by it.", scene, review);
  }


  template class CellTypes<2>;
  template class CellTypes<3>;
} // namespace Morula
