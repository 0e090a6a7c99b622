// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fate_proliferation_h
#define morula_effects_fate_proliferation_h

#include <morula/effects/division/division_rule.h>
#include <morula/effects/fate/cell_cycle.h>
#include <morula/effects/fate/fate.h>

#include <cstdint>
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
    clock(const CellView<dim, const double> &cell) const;

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

    /** Chooses the axis of a founder anew that is in a cycle at t = 0, when the
     *  steady fields are known. */
    void
    choose_first_axis(const PresentCell<dim>      &founder,
                      const CellView<dim, double> &row) const;

    /** Takes the clock through a stretch, and through a division in it, which
     *  daughters() looks up. @return the clock at its end */
    CycleState<dim>
    run_clock(const PresentCell<dim>      &cell,
              const CellView<dim, double> &row,
              const Stretch               &stretch) const;

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
           const CellView<dim, double> &row) const;

    /** Unit direction along which the daughters of a cell are placed.
     *  @param type of the cell */
    Tensor<1, dim>
    placement_axis(const CellView<dim, const double> &cell,
                   const unsigned int                 type) const override;

    double
    time_of_division(const CellView<dim, const double> &cell,
                     const double                       t) const override;

    void
    inherit(const CellView<dim, double> &daughter,
            const StateColumns<dim>     &columns,
            const unsigned int           which,
            const double                 birth) const override;

    std::optional<double>
    next(const PresentCell<dim>      &cell,
         const CellView<dim, double> &row,
         const Stretch               &stretch) const override;

    void
    pass(const PresentCell<dim>      &cell,
         const CellView<dim, double> &row,
         const Stretch               &stretch,
         const double                 s) const override;

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
                const double                 s) const override;

    /** Keeps J_e at the beginning of the step for the size checkpoint. */
    void
    advance(const PresentCell<dim>      &before,
            const CellView<dim, double> &after,
            const double                 t0,
            const double                 t1) const override;

    void
    check_cell(const PresentCell<dim> &founder,
               const double            step) const override;

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
    /** The keys, in a scene. */
    std::optional<Parameters> parameters;
  };
} // namespace Morula

#endif
