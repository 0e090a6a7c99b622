// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fate_death_h
#define morula_effects_fate_death_h

#include <morula/base/expression_key.h>
#include <morula/effects/effect.h>
#include <morula/effects/fate/hazard.h>

#include <optional>

namespace Morula
{
  template <int dim>
  class PresentCell;

  /** Section "Death". */
  struct DeathParameters : public EffectKeys
  {
    DeathParameters();

    ExpressionKey rate;           // 1/day
    ExpressionKey when;           // > 0: at once
    ExpressionKey shrinking_time; // day
    ExpressionKey final_volume;   // of that at death
    ExpressionKey keep_debris;

    bool
    is_on() const override;

    /** Whether cells shrink before they are removed, or stay as debris: then
     *  dead cells are in the balance of momentum. */
    bool
    shrinks() const;

    using Keys::list;
    KeyList
    list() override;
  };

  /**
   * How cells die: at a rate (1/day), or at once if a condition holds at the
   * beginning of a step. A dead cell neither grows nor divides nor changes its
   * type; its volume falls linearly from that at death to a final fraction, and
   * then the cell is removed, or stays as debris: doc/theory.md, section 6.9.
   * Keeps its state in columns of the cells.
   */
  template <int dim>
  class Death : public Effect<dim>
  {
  public:
    using Parameters = DeathParameters;

    /** Declares the columns. @throws InputError */
    Death(const Parameters &parameters, const EffectSetting<dim> &setting);

    /** Whether the cell is dead, but still there. */
    bool
    is_dead(const CellView<dim, const double> &cell) const;

    /** When the cell died, day; infinity: it lives. */
    double
    time(const CellView<dim, const double> &cell) const;

    /** Whether the condition kills a living cell, at time @p t (day).
     *  @throws InputError */
    bool
    condition_holds(const PresentCell<dim> &cell, const double t) const;

    /**
     * The chance of death in (t0, t1]; none without a rate.
     * @param cell in its state
     * @param row  keeps the integral
     * @throws InputError for negative rates
     */
    std::optional<Hazard>
    hazard(const PresentCell<dim>            &cell,
           const CellView<dim, const double> &row,
           const double                       t0,
           const double                       t1) const;

    /** Adds what the last step missed of the rate's integral, if the rate
     *  follows the state: doc/theory.md (5.9). */
    void
    make_good(const PresentCell<dim>      &cell,
              const CellView<dim, double> &row) const;

    /** Keeps the rate for the time @p t (day), the middle of the step, if the
     *  next step is to compare it: if the cell has @p is_whole lived the step
     *  without an event. */
    void
    expect_rate(const PresentCell<dim>      &cell,
                const CellView<dim, double> &row,
                const double                 t,
                const bool                   is_whole) const;

    /** Keeps the integral of the rate. Only with a hazard. */
    void
    set_integral(const CellView<dim, double> &row, const double value) const;

    /**
     * Lets the cell die at @p t (day). Shrinking time, final volume and whether
     * debris stays are evaluated now.
     * @throws InputError
     */
    void
    kill(const PresentCell<dim>      &cell,
         const CellView<dim, double> &row,
         const double                 t) const;

    /** Lets a dead cell shrink until @p t (day). Returns the factor by which
     *  the stretch of F_g changes, and stores it. */
    double
    shrink(const CellView<dim, double> &row, const double t) const;

    /** When the cell will be removed, day; infinity: never, as far as is known.
     */
    double
    removal_time(const CellView<dim, const double> &cell) const;

    /** Whether the condition may remove cells at once. */
    bool
    may_remove_at_once() const;

    /** The rate with which living cells die, 1/day. */
    const Expression &
    rate() const;

    /** Whether a dead cell shrinks over time before it is removed. */
    bool
    shrinks(const CellView<dim, const double> &cell) const;

    /** Whether it is removed at @p t (day) at the latest. */
    bool
    is_due_for_removal(const CellView<dim, const double> &cell,
                       const double                       t) const;

    void
    check_cell(const PresentCell<dim> &founder,
               const double            step) const override;

  private:
    Expression           rate_, when, shrinking_time, final_volume;
    Expression           keep_debris;
    bool                 has_rate, has_condition;
    std::uint64_t        random_seed;
    double               slack;
    Column<double>       integral;
    Column<double>       expected; // if the rate follows the state
    Column<double>       time_;
    Column<double>       remaining; // s
    Column<double>       duration;  // T_s
    Column<double>       least;     // s_end
    Column<unsigned int> stays;
  };
} // namespace Morula

#endif
