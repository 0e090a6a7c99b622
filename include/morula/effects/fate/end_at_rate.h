// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fate_end_at_rate_h
#define morula_effects_fate_end_at_rate_h

#include <morula/base/expression_key.h>
#include <morula/effects/fate/fate.h>
#include <morula/effects/tables.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>

namespace Morula
{
  /** A fate that ends lives at a rate. A cell has one threshold for its whole
   *  life: a change of its type changes the rate and keeps the integral,
   *  doc/theory.md, section 6.9. */
  template <int dim>
  class EndAtRate : public Fate<dim>, public Dies<dim>
  {
  public:
    double
    time_of_death(const CellView<dim, const double> &cell) const override
    {
      return has_ended(cell) ? cell.get(time) :
                               std::numeric_limits<double>::infinity();
    }

    void
    declare(Tables<dim> &tables) const override
    {
      // The numbers of pieces are known to the run only; here the column is
      // announced. The first of such fates announces it all.
      tables.record_events(true);
      const auto &columns = tables.columns();
      if (std::any_of(columns.begin(), columns.end(), [](const auto &column) {
            return column.name == "deaths";
          }))
        return;
      tables.add_count("deaths", CellEvent::death);
      tables.add_count("removed", CellEvent::removal);
      tables.add_number("connected_tissues");
    }

  protected:
    using Threshold = double (*)(const std::uint64_t seed,
                                 const std::uint64_t key);

    /** Declares the columns NAME_hazard, NAME_rate and NAME_time: no hazard
     *  for a rate that is always zero.
     *  @param meaning   of NAME_time
     *  @param in_tables whether it is written to the tables of cells
     *  @throws InputError */
    EndAtRate(const ExpressionKey      &rate_key,
              const EffectSetting<dim> &setting,
              const Threshold           threshold,
              const std::string        &name,
              const std::string        &meaning,
              const bool                in_tables)
    {
      // The rate is announced first, as it decides which columns the state
      // has. A rate that does not follow the state misses nothing.
      const Expression  rate = setting.state.use(rate_key);
      const std::string what = "rate of " + name;
      const auto add = [&columns = setting.columns](const auto &...column) {
        return columns.template add<double>({column...});
      };
      constexpr AtDivision reset = AtDivision::reset;
      setting.columns.need_growth();
      if (!rate.is_always(0.))
        {
          const auto integral =
            add(name + "_hazard", "", what + ", integrated", 0., reset);
          const auto expected =
            rate.follows_state() ?
              add(name + "_rate",
                  "1/day",
                  what + " that the last step saw; -1: none",
                  not_expected,
                  reset) :
              Column<double>();
          this->hazards_of_types[0].push_back(
            {rate,
             integral,
             expected,
             [threshold,
              seed = setting.random_seed](const PresentCell<dim> &cell,
                                          const CellView<dim, const double> &) {
               return threshold(seed, cell.lineage_key());
             }});
        }
      time = add(name + "_time", "day", meaning, never, reset, in_tables);
    }

    /** Ends the life at @p t, day. @param at_once by a condition that held,
     *  not by the rate */
    void
    end(const PresentCell<dim>      &cell,
        const CellView<dim, double> &row,
        const double                 t,
        std::vector<CellEvent>      &events,
        const char *const            cause,
        const bool                   at_once = false) const
    {
      row.set(time, t);
      events.push_back({t,
                        cell.id(),
                        CellEvent::death,
                        cell.type(),
                        cell.type(),
                        cause,
                        at_once});
    }

    /** Whether the life has ended by this fate. */
    bool
    has_ended(const CellView<dim, const double> &cell) const
    {
      return cell.get(time) != never;
    }

  private:
    /** The time of a cell that lives. No life ends before t = 0. */
    static constexpr double never = -1.;

    Column<double> time; // day
  };
} // namespace Morula

#endif
