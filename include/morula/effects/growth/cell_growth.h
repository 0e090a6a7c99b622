// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_growth_cell_growth_h
#define morula_effects_growth_cell_growth_h

#include <morula/effects/division/division_rule.h>
#include <morula/effects/fate/cell_cycle.h>
#include <morula/effects/growth/growth_law.h>
#include <morula/particles/tissue.h>

#include <memory>
#include <optional>
#include <vector>

namespace Morula
{
  /** F_g of all cells of a rank over one step, in the order of
   *  Tissue::cells(). */
  template <int dim>
  struct GrowthOfStep
  {
    bool                        present = false; // else the lists are empty
    std::vector<Tensor<2, dim>> previous;        // at t
    std::vector<Tensor<2, dim>> current;         // at t + dt
  };

  /**
   * All that makes cells grow: the growth law, the cell cycle, or both: F_g is
   * the law's part times the cycle's. Knows nothing of the mechanics.
   */
  template <int dim>
  class CellGrowth
  {
  public:
    /**
     * @param law   or null
     * @param rule  of the cycle's axes; null: those that the cycle draws
     */
    CellGrowth(std::unique_ptr<const GrowthLaw<dim>>    law,
               std::optional<CellCycle<dim>>            cycle,
               std::unique_ptr<const DivisionRule<dim>> rule = nullptr);

    /** Whether anything grows. */
    bool
    present() const;

    /** The cell cycle, or null. */
    const CellCycle<dim> *
    cycle() const;

    /** The columns of cells that grow so. */
    const CellColumns<dim> &
    columns() const;

    /** A cell's clock. Only with a cycle. */
    CycleState<dim>
    clock(const CellView<dim, const double> &cell) const;

    /** Sets a cell's clock. Only with a cycle. */
    void
    set_clock(const CellView<dim, double> &cell,
              const CycleState<dim>       &state) const;

    /** Sets a founder's columns, at t = 0. */
    void
    initialize(const types::particle_index  id,
               const CellView<dim, double> &cell) const;

    /** The trial growth over (t0, t1]. */
    GrowthOfStep<dim>
    of_step(const Tissue<dim> &tissue, const double t0, const double t1) const;

    /**
     * Commits the growth of one cell whose F is still that at t0.
     * @param F_g the cell's GrowthOfStep::current
     */
    void
    commit(const CellView<dim, double> &cell,
           const double                 t0,
           const double                 t1,
           const Tensor<2, dim>        &F_g) const;

  private:
    /** The clock at t1 of a cell in its state at t0, as in
     *  CellCycle::advance(). */
    CycleState<dim>
    advance(const CellView<dim, const double> &cell,
            const double                       t0,
            const double                       t1) const;

    /** Gives a cycle that begins between these states the rule's axis. */
    void
    choose_axis(const CycleState<dim> &before,
                const Point<dim>      &X,
                const Tensor<2, dim>  &F_e,
                CycleState<dim>       &after) const;

    /** F_g at t1 of a cell in its state at t0. */
    Tensor<2, dim>
    growth(const CellView<dim, const double> &cell,
           const double                       t0,
           const double                       t1) const;

    std::unique_ptr<const GrowthLaw<dim>>    law;
    std::optional<CellCycle<dim>>            cycle_;
    std::unique_ptr<const DivisionRule<dim>> rule;
    CellColumns<dim>                         columns_;
    std::optional<CycleColumns<dim>>         cycle_columns;
  };
} // namespace Morula

#endif
