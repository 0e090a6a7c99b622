// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fate_death_h
#define morula_effects_fate_death_h

#include <morula/base/expression_key.h>
#include <morula/effects/fate/end_at_rate.h>
#include <morula/effects/fate/random.h>

namespace Morula
{
  /** Section "Death". */
  struct DeathParameters : public EffectKeys
  {
    ExpressionKey rate{
      {this, "Death/Rate"},
      "0",
      "Rate at which cells die, an expression of their state; not "
      "negative. Units: 1/day.",
      Evaluated::step,
      not_negative("1/day", "0 lets cells live.")};

    /** > 0: at once */
    ExpressionKey when{
      {this, "Death/When"},
      "0",
      "Cells for which this is > 0 at the beginning of a step die then, "
      "those with Shrinking time = 0 at the end of one: an expression of "
      "their state. E.g. abs(X) < 20 && t >= 1, for a cut.",
      Evaluated::step};

    ExpressionKey shrinking_time{
      {this, "Death/Shrinking time"},
      "0.36",
      "How long a dead cell shrinks, linearly in its volume, until it is "
      "removed; not negative. 0: it is removed at once, as in a cut. An "
      "expression of the cell's state. Units: day.",
      Evaluated::event,
      not_negative("day", "0 removes cells at once.")};

    /** of that at death */
    ExpressionKey final_volume{
      {this, "Death/Final volume"},
      "0.05",
      "Part of its volume at death that a cell has when it is removed; > 0 "
      "and at most 1. An expression of the cell's state.",
      Evaluated::event,
      {[](const double part) { return part > 0. && part <= 1.; },
       "a number > 0 and at most 1",
       "It is the part of the cell's volume that is left."}};

    ExpressionKey keep_debris{
      {this, "Death/Keep debris"},
      "false",
      "Where this is true, dead cells stay at their final volume. "
      "false, true, or an expression of the cell's state, which is "
      "true if it is > 0.",
      Evaluated::event};

    bool
    is_on() const override;

    EffectFacts
    facts() const override
    {
      return {&rate};
    }


    /** Refuses dead cells that shrink with the stiffness of whole ones. */
    void
    check(const SceneKeys &scene, Review &review) const override;

    std::string
    details() const override;
  };

  /**
   * How cells die: at a rate (1/day), or at once if a condition holds at the
   * beginning of a step. A dead cell neither grows nor divides nor changes its
   * type; its volume falls linearly from that at death to a final fraction, and
   * then the cell is removed, or stays as debris: doc/theory.md, section 6.9.
   * Keeps its state in columns of the cells.
   */
  template <int dim>
  class Death : public EndAtRate<dim>
  {
  public:
    using Parameters = DeathParameters;

    /** Declares the columns. @throws InputError */
    Death(const Parameters &parameters, const EffectSetting<dim> &setting);

    /** Whether the cell is dead, but still there. */
    bool
    is_dead(const CellView<dim, const double> &cell) const
    {
      return this->has_ended(cell);
    }

    /** Whether the condition kills a living cell, at time @p t (day).
     *  @throws InputError */
    bool
    strikes(const PresentCell<dim> &cell, const double t) const override;

    void
    strike(const PresentCell<dim>      &cell,
           const CellView<dim, double> &row,
           const double                 t,
           std::vector<CellEvent>      &events) const override;

    LifeAfter
    happen(const PresentCell<dim>      &cell,
           const CellView<dim, double> &row,
           const Stretch               &stretch,
           const double                 s,
           std::vector<CellEvent>      &events) const override;

    bool
    may_strike() const override;

    double
    shrink(const CellView<dim, double> &row, const double t) const override;

    double
    removal_time(const CellView<dim, const double> &cell) const override;

    bool
    is_due_for_removal(const CellView<dim, const double> &cell,
                       const double                       t) const override
    {
      return removal_time(cell) <= t + slack;
    }

    bool
    shrinks(const CellView<dim, const double> &cell) const override
    {
      return is_dead(cell) && cell.get(duration) > 0.;
    }

    void
    declare(Tables<dim> &tables) const override;

    void
    check_cell(const PresentCell<dim> &founder,
               const double            step) const override;

    void
    review(const Preview<dim> &scene, Review &review) const override;

  private:
    double
    threshold(const std::uint64_t seed, const std::uint64_t key) const override
    {
      return Random::death_threshold(seed, key);
    }

    /** Lets the cell die at @p t (day). Shrinking time, final volume and
     * whether debris stays are evaluated now. @throws InputError */
    void
    kill(const PresentCell<dim>      &cell,
         const CellView<dim, double> &row,
         const double                 t) const;

    Expression           when, shrinking_time, final_volume;
    Expression           keep_debris;
    bool                 has_condition;
    double               slack;
    Column<double>       remaining; // s
    Column<double>       duration;  // T_s
    Column<double>       least;     // s_end
    Column<unsigned int> stays;
  };
} // namespace Morula

#endif
