// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fate_cell_cycle_h
#define morula_effects_fate_cell_cycle_h

#include <morula/base/expression_key.h>
#include <morula/effects/effect.h>
#include <morula/effects/state/state_columns.h>
#include <morula/particles/cell_state.h>

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/particles/property_pool.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace Morula
{
  using namespace dealii;

  template <int dim>
  class PresentCell;

  /** Section "Proliferation/Cell cycle", but for DivisionParameters. */
  struct CellCycleParameters : public EffectKeys
  {
    /** of all types that have none of their own */
    static inline const std::string of_founder =
      " An expression of X, Y, Z (um), evaluated at the founder's initial "
      "position and inherited by all its descendants.";

    Key<std::string> law{{this, "Proliferation/Law"},
                         "none",
                         "How cells grow and divide.",
                         {"none|cell cycle"}};

    Key<std::string> start{
      {this, "Proliferation/Cell cycle/Start"},
      "waiting",
      "State at t = 0: 'waiting': all cells in G0, with exponentially "
      "distributed waits; 'together': all cells enter S at t = 0.",
      {"waiting|together"}};

    ExpressionKey duration{{this, "Proliferation/Cell cycle/Duration"},
                           "1",
                           "T_cycle: total duration of S, G2, M and G1. "
                           "Positive, and at least twice Time/Step." +
                             of_founder + " Units: day.",
                           Evaluated::event,
                           positive("day",
                                    "Choose the duration of a cycle in days.")};

    ExpressionKey exit_rate{
      {this, "Proliferation/Cell cycle/G0 exit rate"},
      "1",
      "Lambda: rate of the exponentially distributed "
      "wait in G0. Not negative; 0: cells never leave G0." +
        of_founder + " Units: 1/day.",
      Evaluated::event,
      not_negative("1/day", "0 lets cells wait forever.")};

    /** J_th */
    ExpressionKey size_checkpoint{
      {this, "Proliferation/Cell cycle/Size checkpoint"},
      "0",
      "J_th: a cell enters S only while its elastic volume ratio J_e is above "
      "this value. Not negative; 0: no checkpoint." +
        of_founder,
      Evaluated::event,
      not_negative("(a ratio of volumes)", "0 means no checkpoint.")};

    ExpressionKey where{{this, "Proliferation/Cell cycle/Where"},
                        "1",
                        "Founders for which this is > 0 proliferate." +
                          of_founder,
                        Evaluated::founder};

    bool
    is_on() const override
    {
      return law != "none" || is_law_of_types;
    }

    EffectFacts
    facts() const override
    {
      EffectFacts facts;
      facts.switch_key    = &law;
      facts.divides_cells = true;
      facts.grows_cells   = true;
      facts.founders_key  = &where;
      facts.topic         = "proliferation";
      return facts;
    }

    void
    see(const SceneKeys                    &scene,
        const std::vector<ExpressionKey *> &of_cells) override;

  private:
    bool is_law_of_types = false; // of some
  };

  /** A cell's place in its cycle. S and G2 differ by the clock alone. */
  enum class CyclePhase
  {
    waiting = 0, // G0, or held at the size checkpoint
    growing = 1, // S and G2: from the onset to the division
    divided = 4, // G1: from the division to the end of the cycle
    never   = 9  // does not proliferate
  };

  /** The clock of one cell. */
  template <int dim>
  struct CycleState
  {
    CyclePhase     phase      = CyclePhase::never;
    double         event_time = 0.; // day: end of the G0 wait, or onset of S
    std::uint64_t  key        = 0;  // of the random numbers, from the lineage
    Tensor<1, dim> axis;            // n_s of the running cycle
    Tensor<2, dim> growth_pre;      // F_g,cycle before the onset of S
    /** T of the running cycle, day, if cells store it; else 0. */
    double duration = 0.;
    /** The rate of leaving G0, integrated since the wait began, if cells store
     *  it. */
    double hazard = 0.;
  };

  /** J_e of a cell at the beginning of a step, and how it came to it, for the
   *  size checkpoint. */
  struct ElasticSize
  {
    /** A size without slope and time says that there was no step before. */
    ElasticSize(const double J_e,
                const double slope = 0.,
                const double since = std::numeric_limits<double>::infinity())
      : J_e(J_e)
      , slope(slope)
      , since(since)
    {}

    double J_e;
    /** The slope of J_e in the last step, 1/day. */
    double slope;
    /** The time at which that step began, day. */
    double since;
  };

  /** Whether the value depends on more than the founder's place. */
  inline bool
  depends_on_more_than_place(const Expression &expression)
  {
    return expression.depends_on_state() || expression.depends_on_time();
  }

  /** Evaluates the expressions of a cell cycle, at a founder's place or for a
   *  present cell. */
  template <int dim>
  class CellAt
  {
  public:
    /** At a founder's place, for expressions of X, Y, Z alone. */
    CellAt(const Point<dim> &X)
      : X(X)
    {}

    /** A cell with its state, at time @p t (day). It must outlive this. */
    CellAt(const PresentCell<dim> &cell, const double t);

    /** The value of an expression. @throws InputError */
    double
    value(const Expression &expression) const
    {
      return value(expression, t);
    }

    /** The value at another time @p when, day, in the same state. @throws
     *  InputError */
    double
    value(const Expression &expression, const double when) const;

  private:
    Point<dim>              X;
    const PresentCell<dim> *cell = nullptr;
    double                  t    = 0.;
  };

  /**
   * The cell cycle of section 2.3 of the paper: an exponential wait in G0, then
   * S, G2, M, G1 of fixed total duration T with unidirectional growth (15) and
   * division at T/2, and the size checkpoint of section 3.2. It is a pure
   * function of a cell's state and keeps nothing.
   *
   * All events have exact times, for any length of the steps. A wait that ends
   * at t_e in (t0, t1] starts S then if J_e, which goes on as in the step
   * before, is above J_th; otherwise the cell is held. A held cell starts S
   * when J_e has crossed J_th, a time in the step before that is found at t0:
   * doc/theory.md (6.3g). As J_th goes to zero this becomes no checkpoint. Each
   * cell draws at most one wait and one axis, from its own key.
   *
   * Expressions are evaluated at the founder's initial position, or for the
   * present cell if they depend on its state: every call gets @p at for that. T
   * is fixed at the onset of S. A rate of leaving G0 that depends on the state
   * or t is integrated over the steps, at their middle; the cell leaves when
   * the integral reaches a number that is exponentially distributed with mean
   * 1: the same draw as that of a constant rate.
   */
  template <int dim>
  class CellCycle
  {
  public:
    /**
     * @param seed  random seed of the scene
     * @param slack times closer than this count as equal, day
     * @throws InputError
     */
    CellCycle(const CellCycleParameters &parameters,
              const std::uint64_t        seed,
              const double               slack);

    /** A cycle whose expressions may depend on the cells' state. */
    CellCycle(const CellCycleParameters &parameters,
              const std::uint64_t        seed,
              const double               slack,
              StateColumns<dim>         &state);

    /** Whether every cell stores its own T, since T depends on its state. */
    bool
    has_own_duration() const
    {
      return own_duration;
    }

    /** Whether the rate of leaving G0 depends on the cell's state. */
    bool
    has_own_hazard() const
    {
      return own_hazard;
    }

    /** The rate of leaving G0, 1/day. */
    const Expression &
    rate_of_exit() const
    {
      return exit_rate;
    }

    /** Refuses numbers of a founder in its state at t = 0: see check().
     *  @throws InputError */
    void
    check_cell(const CellAt<dim> &founder, const double step) const
    {
      if (founder.value(where) > 0.)
        check_step(checked_duration(founder, true), step);
    }

    /**
     * Refuses a time step too long for the cycle (above T/2 for the smallest T
     * of those of these founders that proliferate: a cell could divide twice in
     * a step), and values against the keys' rules. Not collective: ranks that
     * pass different founders may disagree. @throws InputError
     */
    void
    check(const std::vector<Point<dim>> &founders, const double step) const
    {
      check_step(shortest(founders), step);
    }

    /** The smallest T of those of these founders that proliferate, as far as
     *  place tells it, day; infinity: it tells none. @throws InputError */
    double
    shortest(const std::vector<Point<dim>> &founders) const
    {
      double T = std::numeric_limits<double>::infinity();
      for (const Point<dim> &X : founders)
        if (where.value(X, 0.) > 0.)
          T = std::min(T, checked_duration(X, false));
      return T;
    }

    /**
     * State at t = 0 of founder number @p id at @p X. With Start = together, a
     * cell that does not pass the size checkpoint at rest (J_th >= 1) is held.
     */
    CycleState<dim>
    founder(const types::particle_index id, const CellAt<dim> &at) const;

    /**
     * State at t = 0 of founder number @p id in a given phase, with the numbers
     * of phase_number() except M, which is a moment. How far it has come in S,
     * G2 or G1 is drawn, uniformly: doc/theory.md (6.2a). Call begin_growth()
     * when its axis is chosen.
     */
    CycleState<dim>
    founder_in_phase(const types::particle_index id,
                     const CellAt<dim>          &at,
                     const unsigned int          phase) const;

    /** Sets F_g,pre of a founder such that F_g = I at t = 0, wherever it stands
     *  in its cycle. */
    void
    begin_growth(CycleState<dim> &state, const CellAt<dim> &at) const
    {
      // The cell has at t = 0 the volume of the file and is at rest, so F_g is
      // I. Hence the growth before the cycle is the inverse of what the cycle
      // has done until then, doc/theory.md (6.2a).
      state.growth_pre = unit_symmetric_tensor<dim>();
      state.growth_pre = invert(growth(state, at, 0.));
    }

    /** Whether advance() to @p t1 (day) leaves a clock as it is whatever else
     *  is in it. */
    bool
    stands_still(const CyclePhase phase,
                 const double     event_time,
                 const double     t1) const
    {
      return phase == CyclePhase::growing || phase == CyclePhase::never ||
             (phase == CyclePhase::waiting && !has_own_hazard() &&
              event_time > t1 + slack);
    }

    /**
     * The state at @p t1 of a cell that is in @p state at @p t0 and does not
     * divide in between: a cell whose division falls into (t0, t1] stays
     * `growing`; divides() tells, and daughters() follows.
     * @param size J_e at @p t0, for the size checkpoint
     */
    CycleState<dim>
    advance(CycleState<dim>    state,
            const CellAt<dim> &at,
            const double       t0,
            const double       t1,
            const ElasticSize &size) const;

    /** Whether a cell in (advanced) @p state divides at or before @p t1. */
    bool
    divides(const CycleState<dim> &state,
            const CellAt<dim>     &at,
            const double           t1) const
    {
      // The slack admits rounding: a division at t1 belongs to this step.
      return state.phase == CyclePhase::growing &&
             division_time(state, at) <= t1 + slack;
    }

    /** Exact time of the division of a `growing` cell, day. */
    double
    division_time(const CycleState<dim> &state, const CellAt<dim> &at) const
    {
      Assert(state.phase == CyclePhase::growing, ExcInternalError());
      return state.event_time + 0.5 * cycle_duration(state, at);
    }

    /**
     * F_g of the cycle at @p t, doc/theory.md (6.2), equation (15) of the
     * paper: (I + (θ-1) n_s⊗n_s) F_g,pre, θ = 1 + (t - t_S)/T, the same before
     * and after the division. @p t is within the cycle.
     */
    Tensor<2, dim>
    growth(const CycleState<dim> &state,
           const CellAt<dim>     &at,
           const double           t) const;

    /** The daughters' states, -n_s daughter first. */
    std::pair<CycleState<dim>, CycleState<dim>>
    daughters(const CycleState<dim> &mother) const;

    /** Whether there is a size checkpoint at all. */
    bool
    has_checkpoint() const
    {
      return !size_checkpoint.is_always(0.);
    }

    /** Whether the cell waits at @p t only because of the size checkpoint. */
    bool
    is_held(const CycleState<dim> &state,
            const CellAt<dim>     &at,
            const double           t,
            const double           J_e) const
    {
      return state.phase == CyclePhase::waiting &&
             state.event_time <= t + slack && !passes_checkpoint(at, J_e, t);
    }

    /**
     * Phase number of cells-NNNN.csv: 0 G0 or held; by the time since the onset
     * 1 S [0, T/4), 2 G2 [T/4, T/2), 3 M at T/2, 4 G1 (T/2, T]; 9 never.
     */
    unsigned int
    phase_number(const CycleState<dim> &state,
                 const CellAt<dim>     &at,
                 const double           t) const;

  private:
    /** Whether J_e is above the threshold at @p t (day), or there is none. */
    bool
    passes_checkpoint(const CellAt<dim> &at,
                      const double       J_e,
                      const double       t) const
    {
      const double threshold = at.value(size_checkpoint, t);
      return threshold == 0. || J_e > threshold;
    }

    /** When a waiting cell starts S in a step until @p t1, day; infinity: not
     * in this step. doc/theory.md (6.3g) */
    double
    onset(const CycleState<dim> &state,
          const CellAt<dim>     &at,
          const double           t0,
          const double           t1,
          const ElasticSize     &size) const;

    /** T of the cell's cycle, day. */
    double
    cycle_duration(const CycleState<dim> &state, const CellAt<dim> &at) const
    {
      return has_own_duration() ? state.duration : at.value(duration);
    }

    /** T of a cell. Evaluates the expressions that depend on its state, or the
     *  others. */
    double
    checked_duration(const CellAt<dim> &at, const bool in_its_state) const;

    /** Refuses steps in which a cell could divide twice. */
    void
    check_step(const double shortest, const double step) const;

    /** Begins to wait at @p t, day. */
    void
    wait(CycleState<dim> &state, const CellAt<dim> &at, const double t) const;

    /** Ends the wait in (t0, t1], if the hazard says so. */
    void
    integrate_hazard(CycleState<dim>   &state,
                     const CellAt<dim> &at,
                     const double       t0,
                     const double       t1) const;

    Expression    duration, exit_rate, size_checkpoint, where;
    bool          start_together;
    std::uint64_t seed;
    double        slack;
    bool          own_duration, own_hazard;
  };
} // namespace Morula

#endif
