// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fate_fate_h
#define morula_effects_fate_fate_h

#include <morula/effects/effect.h>
#include <morula/effects/state/present_cell.h>
#include <morula/particles/cell_event.h>

#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace Morula
{
  /** A time in which nothing happens to a cell, but perhaps at its end. */
  struct Stretch
  {
    double begin, end; // day
  };

  template <int dim>
  class DivisionAxes;

  /** What an event leaves of a cell's life in the step. */
  enum class LifeAfter
  {
    goes_on,
    divides, // what comes after the division happens to the daughters
    ends
  };

  /**
   * What befalls cells, at exact times: the cell cycle, death, changes of type,
   * a program's own. live() asks all fates of a cell for their next event and
   * lets the first one happen; of two at the same time that of the later fate.
   *
   * A fate keeps nothing between calls: its integrals and clocks are in columns
   * of the cell. @p cell is always the cell in its state at the beginning of
   * the step, but of its present type, with the fate's columns as they are at
   * the beginning of the stretch; @p row is to be written.
   */
  template <int dim>
  class Fate : public Effect<dim>
  {
  public:
    /** Adds what the last step missed of integrals whose rates follow the
     *  state, doc/theory.md (5.9), to the row of a living cell. */
    virtual void
    make_good(const PresentCell<dim>      &before,
              const CellView<dim, double> &row) const;

    /**
     * Takes the fate's columns to the end of the stretch, or to the fate's next
     * event if that comes before.
     * @return when it comes, day; nothing if it does not
     * @throws InputError for rates without a value
     */
    virtual std::optional<double>
    next(const PresentCell<dim>      &cell,
         const CellView<dim, double> &row,
         const Stretch               &stretch) const = 0;

    /** Takes the columns of @p cell to @p s (day) only: another fate's event
     *  has come, before the end of the stretch of next(). */
    virtual void
    pass(const PresentCell<dim> &,
         const CellView<dim, double> &,
         const Stretch &,
         const double) const
    {}

    /** The event of next() happens at @p s, day. @param events gets what
     *  events.csv shall tell. */
    virtual LifeAfter
    happen(const PresentCell<dim>      &cell,
           const CellView<dim, double> &row,
           const Stretch               &stretch,
           const double                 s,
           std::vector<CellEvent>      &events) const = 0;

    /** Keeps what the next step will compare in make_good().
     *  `t` is the middle of the step, day; `is_whole` says whether nothing has
     *  happened to the cell in it. */
    virtual void
    expect(const PresentCell<dim> & /*before*/,
           const CellView<dim, double> & /*cell*/,
           const double /*t*/,
           const bool /*is_whole*/) const
    {}

    /** The cell's life ends at @p s (day), by this fate or another: sets what a
     *  dead cell has of this one. */
    virtual void
    end_of_life(const PresentCell<dim> &,
                const CellView<dim, double> &,
                const double) const
    {}

    /** Sets what distinguishes a daughter, whose row is her mother's by the
     *  columns' rules, from her mother. `which` is 0 for the one at -n_s, 1
     *  for the other; `birth` its day. */
    virtual void
    inherit(const CellView<dim, double> & /*daughter*/,
            const StateColumns<dim> & /*state*/,
            const unsigned int /*which*/,
            const double /*birth*/) const
    {}

    /** The rates, 1/day, with which the fate befalls cells of a type. */
    virtual std::vector<const Expression *>
    rates(const unsigned int) const
    {
      return {};
    }

    /** @name Fates that divide cells */
    ///@{

    /** Whether cells may divide by this fate at all. Then it sets the columns
     *  of both daughters in inherit(). */
    virtual bool
    divides() const
    {
      return false;
    }

    /** Tells along what cells divide; without it at random. */
    virtual void
    set_axes(std::shared_ptr<const DivisionAxes<dim>>)
    {}

    /** Whether grow() is to be called. */
    virtual bool
    follows_growth() const
    {
      return false;
    }

    /** Tells of a living cell how its grown volume V⁰ det F_g will change in
     *  the step, before its events are looked for.
     *  `ratio` is that at the end over that at the beginning, by the law of
     *  growth. */
    virtual void
    grow(const PresentCell<dim> & /*before*/,
         const CellView<dim, double> & /*cell*/,
         const double /*ratio*/,
         const Stretch & /*step*/) const
    {}

    /** When the cell divides by this fate, if at or before @p t; day; infinity:
     *  it does not. */
    virtual double
    time_of_division(const CellView<dim, const double> &, const double) const
    {
      return std::numeric_limits<double>::infinity();
    }

    /** Unit direction along which the daughters of a cell that divides by this
     *  fate are placed, in the present configuration.
     *  @param type of the cell */
    virtual Tensor<1, dim>
    placement_axis(const CellView<dim, const double> &cell,
                   const unsigned int                 type) const;

    /** Whether daughters stay inside the whole surface, not only inside its
     *  held parts. */
    virtual bool
    stays_inside() const
    {
      return false;
    }

    ///@}

    /** @name Fates that end lives */
    ///@{

    /** Whether lives may end by this fate at all. */
    virtual bool
    is_deadly() const
    {
      return false;
    }

    /** Whether strikes() may tell of cells that are then removed at once. */
    virtual bool
    may_strike() const
    {
      return false;
    }

    /** Whether the fate ends the life of a living cell at once, in its state at
     *  @p t, day. Asked at the beginning of a step, and at its end of cells
     *  that are then removed. @throws InputError */
    virtual bool
    strikes(const PresentCell<dim> &, const double) const
    {
      return false;
    }

    /** Ends the life of a cell that strikes() has told of. */
    virtual void
    strike(const PresentCell<dim> &,
           const CellView<dim, double> &,
           const double,
           std::vector<CellEvent> &) const
    {}

    /** When the cell's life ended by this fate, day; infinity: it did not. */
    virtual double
    time_of_death(const CellView<dim, const double> &cell) const;

    /** The factor by which the stretch of F_g of a cell that died of this fate
     *  changes until @p t, day; may note it in the row. doc/theory.md (6.9) */
    virtual double
    shrink(const CellView<dim, double> &row, const double t) const;

    /** When the dead cell will be removed, day; infinity: never. */
    virtual double
    removal_time(const CellView<dim, const double> &cell) const;

    /** Whether the cell is to be removed at @p t (day) at the latest. */
    virtual bool
    is_due_for_removal(const CellView<dim, const double> &cell,
                       const double                       t) const
    {
      return removal_time(cell) <= t;
    }

    /** Whether the cell shrinks before it is removed, so that its place is that
     *  of the cells around it: doc/theory.md (6.9b). */
    virtual bool
    shrinks(const CellView<dim, const double> &) const
    {
      return false;
    }

    ///@}
  };
} // namespace Morula

#endif
