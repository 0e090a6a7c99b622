// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/effects/fate/cell_types.h>
#include <morula/effects/fate/random.h>
#include <morula/effects/tables.h>

#include <algorithm>

namespace Morula
{
  namespace
  {
    /**
     * The types of cells, and how cells change their type. Each way out of a
     * type is a hazard with a rate (1/day), an expression of the cell's state
     * at the beginning of the step, integrated since the cell got its type:
     * doc/theory.md, section 6.8. So events have exact times, and if the rates
     * do not depend on steps, neither do the events.
     */
    template <int dim>
    class CellTypes : public Fate<dim>
    {
    public:
      CellTypes(const CellTypesParameters &parameters,
                const EffectSetting<dim>  &setting)
        : names(parameters.name_list())
      {
        // First the ways out of each type are collected: only rates that the
        // scene sets, with the number of the type to which they lead. Then the
        // columns are declared. A cell has one type at a time, so ways are
        // numbered within its type and all types share the columns: as many as
        // the type with the most ways needs.
        const std::size_t n_types = parameters.types.size();
        std::size_t       most    = 0;
        this->hazards_of_types.resize(n_types);
        targets.resize(n_types);
        for (unsigned int type = 0; type < n_types; ++type)
          {
            const CellTypeKeys &keys = parameters.types[type];
            daughters.push_back(parameters.daughters(type));
            for (unsigned int k = 0; k < keys.transitions.size(); ++k)
              if (!keys.transitions[k].is_default())
                {
                  // The list of a type leaves the type itself out.
                  targets[type].push_back(k < type ? k : k + 1);
                  this->hazards_of_types[type].push_back(
                    {setting.state.use(keys.transitions[k], false), {}, {}});
                }
            most = std::max(most, targets[type].size());
          }
        if (most > 0)
          add_columns(setting, most);
      }

      LifeAfter
      happen(const PresentCell<dim>      &cell,
             const CellView<dim, double> &row,
             const Stretch               &stretch,
             const double                 s,
             std::vector<CellEvent>      &events) const override
      {
        // A new type has other ways out, so all integrals begin anew, and the
        // count of changes gives it new thresholds.
        const unsigned int to =
          targets[cell.type()][this->first_hazard(cell, stretch)];
        const StateColumns<dim> &columns = cell.reader().columns;
        events.push_back(
          {s, cell.id(), CellEvent::transition, cell.type(), to});
        row.set(columns.type, to);
        if (columns.type_since.exists())
          row.set(columns.type_since, s);
        row.set(n_changes, row.get(n_changes) + 1);
        for (const Column<double> &integral : integrals)
          row.set(integral, 0.);
        return LifeAfter::goes_on;
      }

      void
      inherit(const CellView<dim, double> &daughter,
              const StateColumns<dim>     &columns,
              const unsigned int           which,
              const double                 birth) const override
      {
        // A daughter of her mother's type keeps the time since when she has it;
        // one of another type gets it at birth.
        const unsigned int type = daughter.get(columns.type);
        const unsigned int own =
          which == 0 ? daughters[type].first : daughters[type].second;
        if (own == type)
          return;
        daughter.set(columns.type, own);
        if (columns.type_since.exists())
          daughter.set(columns.type_since, birth);
      }

      void
      declare(Tables<dim> &tables) const override
      {
        tables.record_events();
        for (unsigned int type = 0; type < names.size(); ++type)
          tables.add_sum("cells_" + names[type],
                         [type](const PresentCell<dim> &cell) {
                           return cell.type() == type ? 1. : 0.;
                         });
      }

    private:
      /** Declares the columns of the ways, and gives them to the hazards.
       *  @param most number of ways out of the type with the most */
      void
      add_columns(const EffectSetting<dim> &setting, const std::size_t most)
      {
        CellColumns<dim> &columns = setting.columns;
        const auto        add     = [&columns](const auto &...column) {
          return columns.template add<double>({column..., AtDivision::reset});
        };
        n_changes = columns.template add<unsigned int>(
          {"type_changes",
           "",
           "how often the cell has changed its type",
           0,
           AtDivision::reset});
        for (std::size_t k = 0; k < most; ++k)
          integrals.push_back(add("transition_hazard_" + std::to_string(k + 1),
                                  "",
                                  "rate of a way out of the type, integrated",
                                  0.));
        for (std::size_t k = 0; k < most; ++k)
          {
            Column<double> expected;
            if (std::any_of(this->hazards_of_types.begin(),
                            this->hazards_of_types.end(),
                            [k](const auto &ways) {
                              return k < ways.size() &&
                                     ways[k].rate.follows_state();
                            }))
              expected =
                add("transition_rate_" + std::to_string(k + 1),
                    "1/day",
                    "rate of a way out of the type that the last step saw; -1: "
                    "none",
                    not_expected);
            const auto threshold =
              [k,
               seed      = setting.random_seed,
               n_changes = n_changes](const PresentCell<dim>            &cell,
                                      const CellView<dim, const double> &row) {
                return Random::transition_threshold(seed,
                                                    cell.lineage_key(),
                                                    row.get(n_changes),
                                                    k);
              };
            for (auto &ways : this->hazards_of_types)
              if (k < ways.size())
                ways[k] = {ways[k].rate, integrals[k], expected, threshold};
          }
      }

      std::vector<std::string>                           names;
      std::vector<std::pair<unsigned int, unsigned int>> daughters;
      /** To which type the ways out of a type lead. */
      std::vector<std::vector<unsigned int>> targets;
      Column<unsigned int>                   n_changes;
      /** Of the rates, by the number of the way. */
      std::vector<Column<double>> integrals;
    };
  } // namespace


  template <int dim>
  std::unique_ptr<Fate<dim>>
  make_cell_types(const CellTypesParameters &parameters,
                  const EffectSetting<dim>  &setting)
  {
    return std::make_unique<CellTypes<dim>>(parameters, setting);
  }


  template <int dim>
  unsigned int
  CellTypesParameters::founder_type(const Point<dim> &X) const
  {
    // The last type whose condition holds counts, so the search goes backwards.
    // Type 0 is that of all others and is not asked.
    for (unsigned int i = types.size(); i-- > 1;)
      if (!types[i].where.empty() &&
          types[i].where.expression(dim).value(X, 0.) > 0.)
        return i;
    return 0;
  }


  MORULA_INSTANTIATE(make_cell_types);
  template unsigned int
  CellTypesParameters::founder_type(const Point<2> &) const;
  template unsigned int
  CellTypesParameters::founder_type(const Point<3> &) const;
} // namespace Morula
