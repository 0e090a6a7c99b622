// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fate_fate_h
#define morula_effects_fate_fate_h

#include <morula/base/expression.h>
#include <morula/effects/effect.h>
#include <morula/effects/state/present_cell.h>
#include <morula/particles/cell_event.h>
#include <morula/particles/cell_state.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace Morula
{
  using namespace dealii;

  template <int dim>
  class PresentCell;

  /**
   * The chance of an event, integrated: the event comes when the integral of
   * its rate reaches a threshold that is exponentially distributed with mean 1.
   * doc/theory.md (6.6), (6.7). The rate is constant from t0 on.
   */
  struct Hazard
  {
    double rate;      // 1/day, >= 0
    double integral;  // at t0
    double threshold; // of the integral

    /** When the event comes, if it does in [t0, t1]; day. It comes at t0 if the
     *  integral has reached the threshold. */
    std::optional<double>
    event(const double t0, const double t1) const;

    /** The integral at @p t. */
    double
    integral_at(const double t0, const double t) const
    {
      return integral + rate * (t - t0);
    }
  };

  /** The rate that a step expects at its end where there is nothing to compare,
   *  as after a birth or a change of type. */
  constexpr double not_expected = -1.;

  /**
   * The integral of a rate that follows the state, with what the last step
   * missed of it: doc/theory.md (5.9). Not negative.
   * @param rate     for the last step's middle, in the present state
   * @param expected the same in the state before; or not_expected
   * @param dt       the last step's length, day
   */
  double
  with_missed(const double integral,
              const double rate,
              const double expected,
              const double dt);

  /** A rate of cells with the columns that it needs: doc/theory.md (6.6). */
  template <int dim>
  struct CellHazard
  {
    /** 1/day, from StateColumns::use(). */
    Expression rate;
    /** The integral of the rate. */
    Column<double> integral;
    /** What the step before saw of a rate that follows the cells' state, (5.9);
     *  does not exist for others. */
    Column<double> expected;
    /** The threshold of a cell with its row of the moment. */
    std::function<double(const PresentCell<dim> &,
                         const CellView<dim, const double> &)>
      threshold = {};
    /** Whether the integral of a cell runs; null: always. */
    std::function<bool(const CellView<dim, const double> &)> runs = {};

    /** The chance of the event in [t0, t1], day, from the integral in @p row
     *  on. @throws InputError for negative rates */
    Hazard
    in(const double                       t0,
       const double                       t1,
       const PresentCell<dim>            &cell,
       const CellView<dim, const double> &row) const
    {
      return {cell.value(rate, 0.5 * (t0 + t1)),
              row.get(integral),
              threshold(cell, row)};
    }

    /** Adds what the last step missed of the integral to the row of a living
     *  cell. */
    void
    make_good(const PresentCell<dim>      &before,
              const CellView<dim, double> &row) const;

    /** Keeps what the next step will compare in make_good(). @param t the
     *  middle of the step, day. @param is_whole whether nothing has happened to
     *  the cell in it */
    void
    expect(const PresentCell<dim>      &before,
           const CellView<dim, double> &row,
           const double                 t,
           const bool                   is_whole) const;
  };

  /** A time in which nothing happens to a cell, but perhaps at its end. */
  struct Stretch
  {
    double begin, end; // day
  };

  /** What an event leaves of a cell's life in the step. */
  enum class LifeAfter
  {
    goes_on,
    divides, // what comes after the division happens to the daughters
    ends
  };

  /**
   * What befalls cells, at exact times: the cell cycle, death, changes of type,
   * a program's own. Fates::live() asks all fates of a cell for their next
   * event and lets the first one happen; of two at the same time that of the
   * later fate. One that divides cells is Divides as well, one that ends lives
   * Dies.
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
    /**
     * Takes the fate's columns to the end of the stretch, or to the fate's next
     * event if that comes before: of its hazards, unless it says otherwise.
     * @return when it comes, day; nothing if it does not
     * @throws InputError for rates without a value
     */
    virtual std::optional<double>
    next(const PresentCell<dim>      &cell,
         const CellView<dim, double> &row,
         const Stretch               &stretch) const;

    /** Takes the columns of @p cell to @p s (day) only: another fate's event
     *  has come, before the end of the stretch of next(). */
    virtual void
    pass(const PresentCell<dim>      &cell,
         const CellView<dim, double> &row,
         const Stretch               &stretch,
         const double                 s) const
    {
      // Integrals are read from `cell`, the row of the round's beginning,
      // because next() has already changed `row`.
      for (const CellHazard<dim> &hazard : hazards(cell.type()))
        row.set(hazard.integral,
                hazard.in(stretch.begin, stretch.end, cell, cell.cell())
                  .integral_at(stretch.begin, s));
    }

    /** The event of next() happens at @p s, day. @param events gets what
     *  events.csv shall tell. */
    virtual LifeAfter
    happen(const PresentCell<dim>      &cell,
           const CellView<dim, double> &row,
           const Stretch               &stretch,
           const double                 s,
           std::vector<CellEvent>      &events) const = 0;

    /** Sets what distinguishes a daughter, whose row is her mother's by the
     *  columns' rules, from her mother. `which` is 0 for the one at -n_s, 1
     *  for the other; `birth` its day. */
    virtual void
    inherit(const CellView<dim, double> & /*daughter*/,
            const StateColumns<dim> & /*state*/,
            const unsigned int /*which*/,
            const double /*birth*/) const
    {}

    /** The cell's life ends at @p s (day), by this fate or another: sets what a
     *  dead cell has of this one. */
    virtual void
    end_of_life(const PresentCell<dim> &,
                const CellView<dim, double> &,
                const double) const
    {}

    /** The hazards of cells of a type by this fate. Their integrals are made
     *  good and compared step by step. */
    const std::vector<CellHazard<dim>> &
    hazards(const unsigned int type) const
    {
      return hazards_of_types.size() == 1 ? hazards_of_types[0] :
                                            hazards_of_types[type];
    }

    /** Evaluates all rates at a founder in its state. */
    void
    check_cell(const PresentCell<dim> &founder,
               const double            step) const override;

  protected:
    /** Which of its hazards brings the event of next(). */
    std::size_t
    first_hazard(const PresentCell<dim> &cell, const Stretch &stretch) const;

    /** By type; a single list is that of all types. */
    std::vector<std::vector<CellHazard<dim>>> hazards_of_types =
      std::vector<std::vector<CellHazard<dim>>>(1);
  };

  template <int dim>
  class DivisionAxes;

  /** A fate that divides cells, and sets the columns of both daughters in
   *  Fate::inherit(). */
  template <int dim>
  class Divides
  {
  public:
    virtual ~Divides() = default;

    /** When the cell divides, if at or before @p t; day; infinity: it does not.
     */
    virtual double
    time_of_division(const CellView<dim, const double> &cell,
                     const double                       t) const = 0;

    /** Unit direction along which the daughters of a cell are placed, in the
     *  present configuration. @param type of the cell */
    virtual Tensor<1, dim>
    placement_axis(const CellView<dim, const double> &cell,
                   const unsigned int                 type) const = 0;

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

    /** Along what cells divide; null: at random. */
    std::shared_ptr<const DivisionAxes<dim>> axes;
  };

  /** A fate that ends lives. */
  template <int dim>
  class Dies
  {
  public:
    virtual ~Dies() = default;

    /** When the cell's life ended by this fate, day; infinity: it did not. */
    virtual double
    time_of_death(const CellView<dim, const double> &cell) const = 0;

    /** When the dead cell will be removed, day; infinity: never. */
    virtual double
    removal_time(const CellView<dim, const double> &cell) const
    {
      return time_of_death(cell);
    }

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

    /** The factor by which the stretch of F_g of a cell that died of this fate
     *  changes until @p t, day; may note it in the row. doc/theory.md (6.9) */
    virtual double
    shrink(const CellView<dim, double> & /*row*/, const double /*t*/) const
    {
      return 1.;
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
    strikes(const PresentCell<dim> & /*cell*/, const double /*t*/) const
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
  };

  template <int dim>
  class TypesAround;

  /** The fates of a scene's cells, in the order in which they are asked. */
  template <int dim>
  struct Fates
  {
    std::vector<std::unique_ptr<const Fate<dim>>> list;
    /** Those of the list that end lives. */
    std::vector<const Dies<dim> *> deadly;
    /** The one by which cells divide, or null. */
    const Divides<dim> *dividing = nullptr;

    /** Adds a fate, behind those before. */
    void
    add(std::unique_ptr<const Fate<dim>> fate);

    /**
     * Lets a cell live through (t0, t1], day, event by event: doc/theory.md,
     * sections 6.8 and 6.9. Its row is then that of t1, or of its death. What
     * would come after a division is left out: it happens to the daughters.
     * @param before the cell at the beginning of the step
     * @param row    its row at @p t0, to be written
     * @param events gets what happens
     * @param around the types of the cells beside it, if they change in the
     *        step; or null
     * @throws InputError for rates without a value, or too many events
     */
    void
    live(const PresentCell<dim>      &before,
         const CellView<dim, double> &row,
         const double                 t0,
         const double                 t1,
         std::vector<CellEvent>      &events,
         const TypesAround<dim>      *around = nullptr) const;

    /** As CellHazard::make_good(), for all hazards. */
    void
    make_good(const PresentCell<dim>      &before,
              const CellView<dim, double> &row) const
    {
      for (const auto &fate : list)
        for (const CellHazard<dim> &hazard : fate->hazards(before.type()))
          hazard.make_good(before, row);
    }

    /** As CellHazard::expect(), for all hazards. */
    void
    expect(const PresentCell<dim>      &before,
           const CellView<dim, double> &row,
           const double                 t,
           const bool                   is_whole) const
    {
      // Columns beyond the hazards of this type say since the cell's birth or
      // the change of its type that nothing is expected.
      for (const auto &fate : list)
        for (const CellHazard<dim> &hazard : fate->hazards(before.type()))
          hazard.expect(before, row, t, is_whole);
    }

    /** Ends the cell's life at @p t (day) if a fate strikes it then. @return
     *  whether it is dead. @throws InputError */
    bool
    is_dead_at(const PresentCell<dim>      &before,
               const CellView<dim, double> &row,
               const double                 t,
               std::vector<CellEvent>      &events) const;

    /** When the cell's life ended, day; infinity: it lives. */
    double
    time_of_death(const CellView<dim, const double> &cell) const
    {
      double time = std::numeric_limits<double>::infinity();
      for (const Dies<dim> *const dies : deadly)
        time = std::min(time, dies->time_of_death(cell));
      return time;
    }

    /** Whether the cell is dead, but still there. */
    bool
    is_dead(const CellView<dim, const double> &cell) const
    {
      return std::isfinite(time_of_death(cell));
    }
  };
} // namespace Morula

#endif
