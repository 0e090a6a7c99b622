// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_tables_h
#define morula_effects_tables_h

#include <morula/effects/state/present_cell.h>
#include <morula/particles/cell_event.h>

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace Morula
{
  /** Numbers by name. */
  using NamedNumbers = std::map<std::string, double>;

  /**
   * What the effects of a scene add to the tables of a run, and what of them
   * outlives a step besides the columns of cells: filled by Effect::declare(),
   * effect by effect. Only what is declared is written.
   */
  template <int dim>
  class Tables
  {
  public:
    /** A column of statistics.csv. */
    struct Column
    {
      std::string name;
      /** Summed over the cells, if there is one. */
      std::function<double(const PresentCell<dim> &)> of_cell = {};
      /** Counted in the step, if there is one. */
      std::optional<EventKind> counted = {};
      /** Whether the sum is divided by the number of cells. */
      bool is_mean = false;
    };

    /** Adds a column of statistics.csv: a sum over the cells as they are after
     *  the step. */
    void
    add_sum(const std::string                                     &name,
            const std::function<double(const PresentCell<dim> &)> &of_cell)
    {
      columns_.push_back({name, of_cell});
    }

    /** Adds a column of statistics.csv: a mean over the cells likewise; 0
     *  without any. */
    void
    add_mean(const std::string                                     &name,
             const std::function<double(const PresentCell<dim> &)> &of_cell)
    {
      columns_.push_back({name, of_cell, {}, true});
    }

    /** Adds a column of statistics.csv: how many events of a kind the step had.
     */
    void
    add_count(const std::string &name, const EventKind &kind)
    {
      columns_.push_back({name, {}, kind});
    }

    /** Adds a column of statistics.csv that the step itself fills, by name; 0
     *  where it does not. */
    void
    add_number(const std::string &name)
    {
      columns_.push_back({name});
    }

    /** Asks for events.csv. @param with_causes whether it has a column `cause`
     */
    void
    record_events(const bool with_causes = false)
    {
      records_events_ = true;
      with_causes_    = with_causes_ || with_causes;
    }

    /** Keeps a number from step to step, and in snapshots; with a name that
     * ends in '/' also all others whose names begin so. @param at_start its
     * value at t = 0, and where a snapshot does not know it */
    void
    keep_number(const std::string &name, const double at_start)
    {
      kept_[name] = at_start;
    }

    /** Columns of statistics.csv in their order. */
    const std::vector<Column> &
    columns() const
    {
      return columns_;
    }

    bool
    records_events() const
    {
      return records_events_;
    }

    bool
    has_causes() const
    {
      return with_causes_;
    }

    /** The numbers that outlive a step, as they are at t = 0. */
    const NamedNumbers &
    kept() const
    {
      return kept_;
    }

  private:
    std::vector<Column> columns_;
    bool                records_events_ = false;
    bool                with_causes_    = false;
    NamedNumbers        kept_;
  };
} // namespace Morula

#endif
