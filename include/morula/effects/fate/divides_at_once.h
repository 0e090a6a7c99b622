// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fate_divides_at_once_h
#define morula_effects_fate_divides_at_once_h

#include <morula/effects/division/division_rule.h>
#include <morula/effects/fate/fate.h>
#include <morula/effects/fate/random.h>

#include <limits>

namespace Morula
{
  /** A fate that divides cells in one event, without a clock: V⁰ halves, F and
   *  F_g stay, so that no stress changes. The axis is chosen in the event. */
  template <int dim>
  class DividesAtOnce : public Fate<dim>, public Divides<dim>
  {
  public:
    LifeAfter
    happen(const PresentCell<dim>      &cell,
           const CellView<dim, double> &row,
           const Stretch &,
           const double s,
           std::vector<CellEvent> &) const override
    {
      row.set(time, s);
      row.set(axis,
              this->axes ?
                this->axes->choose(cell, s) :
                Random::direction<dim>(random_seed, cell.lineage_key()));
      return LifeAfter::divides;
    }

    double
    time_of_division(const CellView<dim, const double> &cell,
                     const double) const override
    {
      const double t = cell.get(time);
      return t == undivided ? std::numeric_limits<double>::infinity() : t;
    }

    Tensor<1, dim>
    placement_axis(const CellView<dim, const double> &cell,
                   const unsigned int                 type) const override
    {
      return this->axes ? this->axes->placement(cell, cell.get(axis), type) :
                          cell.get(axis);
    }

    void
    inherit(const CellView<dim, double> &daughter,
            const StateColumns<dim> &,
            const unsigned int which,
            const double) const override
    {
      // The key and the type in the row are still the mother's: the fate of
      // types is the last.
      const Column<std::uint64_t> &key = daughter.columns().lineage_key;
      daughter.set(key,
                   Random::daughter_key(random_seed, daughter.get(key), which));
    }

    void
    check_cell(const PresentCell<dim> &founder,
               const double            step) const override
    {
      Fate<dim>::check_cell(founder, step);
      if (this->axes)
        if (const auto *const rule = this->axes->rule(founder.type()))
          rule->check_cell(founder, step);
    }

  protected:
    explicit DividesAtOnce(const EffectSetting<dim> &setting)
      : random_seed(setting.random_seed)
    {
      // With parent and generation a cell's box is that of F_e, doc/theory.md
      // (2.2b): F alone says nothing of the shape of cells that grow and
      // divide.
      CellColumns<dim> &columns = setting.columns;
      columns.need_growth();
      columns.need_lineage();
      columns.need_lineage_key();
      columns.need_shape();
    }

    /** Declares the columns of the event. */
    void
    declare_event(CellColumns<dim> &columns)
    {
      time = columns.template add<double>({"division_time",
                                           "day",
                                           "when the cell divides; -1: not yet",
                                           undivided,
                                           AtDivision::reset});
      axis = columns.template add<Tensor<1, dim>>(
        {"division_axis", "", "axis along which the cell divides"});
    }

    const std::uint64_t random_seed;

  private:
    /** The column of the time has this value while a cell does not divide. */
    static constexpr double undivided = -1.;

    Column<double>         time; // day
    Column<Tensor<1, dim>> axis;
  };
} // namespace Morula

#endif
