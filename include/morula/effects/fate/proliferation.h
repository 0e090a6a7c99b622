// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fate_proliferation_h
#define morula_effects_fate_proliferation_h

#include <morula/effects/division/division_rule.h>
#include <morula/effects/fate/cell_cycle.h>
#include <morula/effects/fate/fate.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

namespace Morula
{
  /**
   * The cell cycle as a fate: each cell has a clock in its columns, grows along
   * an axis and divides; doc/theory.md, sections 6.1 to 6.4. Its event is the
   * division, which happens when the step is done: see divide().
   */
  template <int dim>
  class Proliferation : public Fate<dim>, public Divides<dim>
  {
  public:
    using Parameters = CellCycleParameters;

    /** Declares the columns of the clock. @throws InputError */
    Proliferation(const Parameters         &parameters,
                  const EffectSetting<dim> &setting);

    /** Declares the columns of the clock. @param seed of the scene */
    Proliferation(CellCycle<dim>      cycle,
                  CellColumns<dim>   &columns,
                  const std::uint64_t seed);

    const CellCycle<dim> &
    cycle() const
    {
      return cycle_;
    }

    void
    check(const Preview<dim> &scene) const override;

    void
    review(const Preview<dim> &scene, Review &review) const override;

    /** A cell's clock. */
    CycleState<dim>
    clock(const CellView<dim, const double> &cell) const
    {
      // The order is that of the members of CycleState.
      return {cell.get(phase),
              cell.get(event_time),
              cell.get(lineage_key),
              cell.get(division_axis),
              cell.get(growth_pre),
              duration.exists() ? cell.get(duration) : 0.,
              hazard.exists() ? cell.get(hazard) : 0.};
    }

    /** Whether a cell waits in G0, or is held. */
    bool
    is_waiting(const CellView<dim, const double> &cell) const
    {
      return cell.get(phase) == CyclePhase::waiting;
    }

    /** Sets a cell's clock. */
    void
    set_clock(const CellView<dim, double> &cell,
              const CycleState<dim>       &state) const;

    /**
     * Sets the clock of a founder at t = 0.
     * @param founder has its type
     * @param row     the same
     * @param step    of the run (day), with which cells must not divide twice;
     *                0: nobody asks
     * @param phase   in which it begins, if its file says so
     * @throws InputError
     */
    void
    found(const PresentCell<dim>            &founder,
          const CellView<dim, double>       &row,
          const double                       step,
          const std::optional<unsigned int> &phase) const;

    /** Takes the clock through a stretch, and through a division in it, which
     *  daughters() looks up. */
    void
    run_clock(const PresentCell<dim>      &cell,
              const CellView<dim, double> &row,
              const Stretch               &stretch) const
    {
      // Most clocks stand still in a step, so that the phase is all that is
      // read of them.
      if (!cycle_.stands_still(row.get(phase),
                               row.get(event_time),
                               stretch.end))
        set_clock(row,
                  next_clock(cell, clock(row), stretch.begin, stretch.end));
    }

    /** The cycle's part of F_g at @p t (day), which is that of the clock. */
    Tensor<2, dim>
    growth(const CellView<dim, const double> &cell, const double t) const
    {
      return cycle_.growth(clock(cell), cell.founder_position(), t);
    }

    /** Makes F_g = K F_c, F_c the cycle's part, into D K F_c, as if D had come
     *  before all growth. */
    void
    absorb(const Tensor<2, dim>        &D,
           const Tensor<2, dim>        &F_g,
           const CellView<dim, double> &row) const
    {
      // F_g = K F_r becomes D K F_r = K (K⁻¹ D K F_r), doc/theory.md (8.7). F_r
      // is a factor of the growth before the cycle, so the running cycle is
      // part of K.
      CycleState<dim>      state = clock(row);
      const Tensor<2, dim> K     = F_g * invert(state.growth_pre);
      state.growth_pre           = invert(K) * D * F_g;
      set_clock(row, state);
    }

    /** Unit direction along which the daughters of a cell are placed.
     *  @param type of the cell */
    Tensor<1, dim>
    placement_axis(const CellView<dim, const double> &cell,
                   const unsigned int                 type) const override;

    double
    time_of_division(const CellView<dim, const double> &cell,
                     const double                       t) const override
    {
      constexpr double never = std::numeric_limits<double>::infinity();
      if (cell.get(phase) != CyclePhase::growing)
        return never;
      const CycleState<dim> state = clock(cell);
      const CellAt<dim>     at(cell.founder_position());
      return cycle_.divides(state, at, t) ? cycle_.division_time(state, at) :
                                            never;
    }

    void
    inherit(const CellView<dim, double> &daughter,
            const StateColumns<dim>     &columns,
            const unsigned int           which,
            const double                 birth) const override;

    std::optional<double>
    next(const PresentCell<dim>      &cell,
         const CellView<dim, double> &row,
         const Stretch               &stretch) const override
    {
      // Division is not carried out here. Its time says when the cell's own
      // life ends in this step; the daughters are made after the equilibrium.
      run_clock(cell, row, stretch);
      const CycleState<dim> state = clock(row);
      const CellAt<dim>     at(cell, stretch.begin);
      if (!cycle_.divides(state, at, stretch.end))
        return {};
      return std::min(stretch.end, cycle_.division_time(state, at));
    }

    void
    pass(const PresentCell<dim>      &cell,
         const CellView<dim, double> &row,
         const Stretch               &stretch,
         const double                 s) const override
    {
      // The clock of the round's beginning is in `cell`; it is run again, only
      // to the time of the other fate's event.
      set_clock(row, next_clock(cell, clock(cell.cell()), stretch.begin, s));
    }

    LifeAfter
    happen(const PresentCell<dim> &,
           const CellView<dim, double> &,
           const Stretch &,
           const double,
           std::vector<CellEvent> &) const override
    {
      return LifeAfter::divides;
    }

    void
    end_of_life(const PresentCell<dim>      &cell,
                const CellView<dim, double> &row,
                const double                 s) const override
    {
      // A dead cell keeps the size that it has, half-way through its cycle or
      // not, and never divides.
      CycleState<dim> state = clock(row);
      state.growth_pre      = cycle_.growth(state, CellAt<dim>(cell, s), s);
      state.phase           = CyclePhase::never;
      set_clock(row, state);
    }

    /** Keeps J_e at the beginning of the step for the size checkpoint. */
    void
    advance(const PresentCell<dim>      &before,
            const CellView<dim, double> &after,
            const double                 t0,
            const double                 t1) const override;

    void
    check_cell(const PresentCell<dim> &founder,
               const double            step) const override
    {
      if (clock(founder.cell()).phase == CyclePhase::never)
        return;
      if (const auto *const rule = this->rule(founder.type()))
        rule->check_cell(founder, step);
    }

  private:
    /** The rule of a type of cells, or null. */
    const DivisionRule<dim> *
    rule(const unsigned int type) const
    {
      return this->axes ? this->axes->rule(type) : nullptr;
    }

    /** The clock at @p t1 of a cell with the clock @p before at @p t0. */
    CycleState<dim>
    next_clock(const PresentCell<dim> &cell,
               const CycleState<dim>  &before,
               const double            t0,
               const double            t1) const;

    /** If a cycle begins between these clocks, sets its axis by the rule. */
    void
    choose_axis(const CycleState<dim>  &before,
                const PresentCell<dim> &cell,
                const double            t,
                CycleState<dim>        &after) const;

    CellCycle<dim>         cycle_;
    Column<CyclePhase>     phase;
    Column<double>         event_time;
    Column<std::uint64_t>  lineage_key;
    Column<Tensor<1, dim>> division_axis;
    Column<Tensor<2, dim>> growth_pre;
    /** What only some cycles need; see CycleState and ElasticSize. */
    Column<double> duration, hazard, exit_rate, J_e_before;
    std::uint64_t  random_seed;
  };
} // namespace Morula

#endif
