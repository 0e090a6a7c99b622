// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_development_h
#define morula_effects_development_h

#include <morula/effects/fate/cell_types.h>
#include <morula/effects/fate/proliferation.h>
#include <morula/effects/growth/growth_law.h>
#include <morula/effects/state/present_cell.h>
#include <morula/mechanics/material.h>
#include <morula/particles/cell_event.h>
#include <morula/particles/neighbours.h>
#include <morula/particles/tissue.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace Morula
{
  /** The growth and the events of all cells of a rank in one step, in the order
   *  of Tissue::cells(). */
  template <int dim>
  struct DevelopmentOfStep
  {
    bool                        present = false; // else nothing grows
    std::vector<Tensor<2, dim>> previous;        // F_g at t
    std::vector<Tensor<2, dim>> current;         // F_g at t + dt
    /** λ and μ at t + dt if they depend on the cells' state; else empty. */
    std::vector<Lame> lame;
    /** The cells' rows at t + dt, one after the other, without a new F; that of
     *  the last one alone if commit() computes them anew. */
    std::vector<double> rows;
    /** Changes of type and deaths. */
    std::vector<CellEvent> events;
    /** The step before. */
    PastStep past = {};
    /** An error of the forecast motion times this is an error of what flows; a
     *  number for each cell and flow. */
    std::vector<double> flow_shares = {};
    /** By cell; empty if nothing flows. */
    std::vector<Relaxed> relaxation = {};
    /** |missed| of the step before, by cell, if growth follows the state; else
     *  empty. */
    std::vector<double> missed_growth = {};

    /** F_g of cell number @p p at t, and at t + dt. */
    Tensor<2, dim>
    growth_before(const Tissue<dim> &tissue, const unsigned int p) const
    {
      return present ? previous[p] : tissue.cells()[p].growth();
    }

    Tensor<2, dim>
    growth_after(const Tissue<dim> &tissue, const unsigned int p) const
    {
      return present ? current[p] : tissue.cells()[p].growth();
    }

    /** λ and μ of cell number @p p at t + dt. */
    Lame
    lame_of(const Tissue<dim>    &tissue,
            const unsigned int    p,
            const TissueMaterial &material) const
    {
      return lame.empty() ?
               material.lame_at(tissue.cells()[p].founder_position()) :
               lame[p];
    }
  };

  /** What the points file may say of a founder. */
  struct GivenState
  {
    /** The phase in which it begins: see CellCycle::founder_in_phase(). */
    std::optional<unsigned int> phase;
    /** Number of its type. */
    std::optional<unsigned int> type;
  };

  /** The effects that decide how cells develop. */
  template <int dim>
  struct DevelopmentEffects
  {
    /** The fates, in the order in which they are asked. */
    Fates<dim> fates;
    /** Two of the fates, to which other parts speak, or null: the cell cycle
     *  and the changes of type. */
    const Proliferation<dim> *proliferation = nullptr;
    const Fate<dim>          *types         = nullptr;
    /** The type of a founder, if there are types. */
    std::function<unsigned int(const Point<dim> &)> founder_type = {};
    /** The law of growth, or null. */
    std::unique_ptr<const GrowthLaw<dim>> law;
    /** Whether cells grow by the law, by type; empty: all do. */
    std::vector<bool> grows = {};
    /** Factors of F_g left of the law, from the right. */
    std::vector<std::unique_ptr<const GrowthFactor<dim>>> factors;
    /** The flows, in the order in which they act. */
    std::vector<std::unique_ptr<const Flow<dim>>> flows;
    /** F_law, if there are factors to its left. */
    Column<Tensor<2, dim>> law_growth;
    /** F_r of (8.7), if there is no cycle that keeps it. */
    Column<Tensor<2, dim>> relaxed;
    /** How the cells beside one are found, if changes of type depend on their
     *  types. */
    std::optional<NeighbourSearch> neighbours = {};
    /** All effects that have columns of their own. Others own these effects. */
    std::vector<const Effect<dim> *> with_state = {};

    /** Adds a fate, behind those before. */
    void
    add_fate(std::unique_ptr<const Fate<dim>> fate)
    {
      if (const auto *cycle =
            dynamic_cast<const Proliferation<dim> *>(fate.get()))
        proliferation = cycle;
      fates.add(std::move(fate));
    }

    /** Whether the law follows the cells' state, so that a step can miss some
     *  growth. */
    bool
    law_follows_state() const
    {
      return law && law->follows_state();
    }

    /** Whether a step's error is known: growth follows the state, or tissue
     *  flows. */
    bool
    states_error() const
    {
      return law_follows_state() ||
             std::any_of(flows.begin(), flows.end(), [](const auto &flow) {
               return flow->has_forecast();
             });
    }
  };

  /**
   * The development of cells in a step, before anything moves: the clock, the
   * columns of effects, and F_g, the product of the effects' parts:
   * doc/theory.md (8.7). Pure functions of the committed state. It knows
   * nothing of the balance of momentum.
   */
  template <int dim>
  class CellDevelopment
  {
  public:
    /**
     * @param columns  of the cells, all declared
     * @param state    the columns behind the variables of expressions
     * @param material of the tissue
     */
    CellDevelopment(DevelopmentEffects<dim>  effects,
                    const CellColumns<dim>  &columns,
                    const StateColumns<dim> &state,
                    const TissueMaterial    &material,
                    const std::uint64_t      random_seed);

    /** A development with these effects alone, in cells of the default
     *  material. */
    CellDevelopment(std::unique_ptr<const GrowthLaw<dim>>    law,
                    std::optional<CellCycle<dim>>            cycle,
                    std::unique_ptr<const DivisionRule<dim>> rule = nullptr);

    /** Whether anything grows. */
    bool
    grows() const
    {
      return effects.law || effects.proliferation || !effects.factors.empty() ||
             !effects.flows.empty() || is_mortal();
    }

    /** Whether a step changes what cells are or how stiff they are. */
    bool
    present() const
    {
      return grows() || keeps_rows || material.depends_on_state();
    }

    /** The cell cycle, or null. */
    const CellCycle<dim> *
    cycle() const
    {
      return effects.proliferation ? &effects.proliferation->cycle() : nullptr;
    }

    /** The columns of the cells. */
    const CellColumns<dim> &
    columns() const
    {
      return columns_;
    }

    /** The columns behind the variables of expressions. */
    const StateColumns<dim> &
    state() const
    {
      return state_;
    }

    /** A reader for cells whose state is that of time @p t, day.
     *  @param past the step that led to it */
    CellReader<dim>
    reader(const double t, const PastStep &past = {}) const;

    /** A cell's clock. Only with a cycle. */
    CycleState<dim>
    clock(const CellView<dim, const double> &cell) const
    {
      return effects.proliferation->clock(cell);
    }

    /** Whether cells can wait at a size checkpoint. */
    bool
    has_checkpoint() const
    {
      return cycle() != nullptr && cycle()->has_checkpoint();
    }

    /** Whether the cell waits there at @p t, day. */
    bool
    is_held(const PresentCell<dim> &cell, const double t) const;

    /**
     * Sets a founder's columns at t = 0, and refuses a founder that some effect
     * cannot handle. Called again when the steady fields are known.
     * @param step of the run, day; 0: nothing is refused
     * @param given what its file says of it
     * @throws InputError
     */
    void
    initialize(const types::particle_index  id,
               const CellView<dim, double> &cell,
               const double                 step  = 0.,
               const GivenState            &given = {}) const;

    /** The development of the cells in (t0, t1]. @param past the step that
     *  ended at @p t0. Collective. @throws InputError on all ranks */
    DevelopmentOfStep<dim>
    of_step(const Tissue<dim> &tissue,
            const double       t0,
            const double       t1,
            const PastStep    &past = {}) const;

    /** How much the step that led to the state at @p t0 missed of the growth
     *  of each cell, |missed| of doc/theory.md (5.9), in the order of the
     *  cells; empty where nothing that grows follows the state. */
    std::vector<double>
    missed_growth(const Tissue<dim> &tissue,
                  const double       t0,
                  const PastStep    &past) const;

    /** Keeps what relaxation will need to know of a step of the tissue.
     *  @param f of the step, at the cell */
    void
    remember_motion(const CellView<dim, double> &cell,
                    const Tensor<2, dim>        &f) const
    {
      for (const auto &flow : effects.flows)
        flow->remember_motion(cell, f);
    }

    /** Gives cells that have flowed far another reference configuration, before
     *  F and F_g lose the digits of F_e: doc/theory.md (8.8). To be called when
     *  no cell is due to divide. */
    void
    refer_anew(Tissue<dim> &tissue) const;

    /**
     * By how much the forecast of a step's motion was wrong about what has
     * flowed, |missed|; to be called before remember_motion().
     * @param p    the cell's place in @p of_step
     * @param f    of the step
     * @param t1   its end, day
     */
    double
    missed_flow(const CellView<dim, const double> &cell,
                const unsigned int                 p,
                const Tensor<2, dim>              &f,
                const DevelopmentOfStep<dim>      &of_step,
                const double                       t0,
                const double                       t1) const;

    /** Whether a step's error is known: something follows the state. */
    bool
    states_error() const
    {
      return effects.states_error();
    }

    /** Whether cells flow, or do what depends on their strain or stress. */
    bool
    follows_strain() const
    {
      return has_checkpoint() || state_.feels_strain() ||
             std::any_of(effects.flows.begin(),
                         effects.flows.end(),
                         [](const auto &flow) { return flow->has_forecast(); });
    }

    /** Sets all columns but F to their values at the end of the step. F must
     *  still be that at @p t0. */
    void
    commit(Tissue<dim>                  &tissue,
           const DevelopmentOfStep<dim> &of_step,
           const double                  t0,
           const double                  t1) const;

    /** What befalls cells. */
    const Fates<dim> &
    fates() const
    {
      return effects.fates;
    }

    /** Whether cells can divide. */
    bool
    divides() const
    {
      return effects.fates.dividing != nullptr;
    }

    /** When a cell divides, if at or before @p t; day; infinity: it does not.
     */
    double
    time_of_division(const CellView<dim, const double> &cell,
                     const double                       t) const
    {
      return effects.fates.dividing->time_of_division(cell, t);
    }

    /** Whether cells can die. */
    bool
    is_mortal() const
    {
      return !effects.fates.deadly.empty();
    }

    /**
     * Sets what distinguishes a daughter from her mother, and lets her live
     * until the end of the step.
     * @param daughter has her mother's columns, by their rules
     * @param which    0 for the one at -n_s, 1 for the other
     * @param birth    exact time, day
     * @param t1       end of the step, day
     * @return the number of the type that she is born with
     */
    unsigned int
    make_daughter(const CellView<dim, double> &daughter,
                  const types::particle_index  id,
                  const Point<dim>            &position,
                  const unsigned int           which,
                  const double                 birth,
                  const double                 t1,
                  std::vector<CellEvent>      &changes) const;

    /** Unit direction along which the daughters of a cell are placed. Only
     *  where cells divide. */
    Tensor<1, dim>
    placement_axis(const CellView<dim, const double> &cell) const
    {
      return effects.fates.dividing->placement_axis(
        cell, state_.type.exists() ? cell.get(state_.type) : 0);
    }

  private:
    /** What is known of errors when a cell develops. */
    struct Errors
    {
      /** |missed| of the step before. */
      double missed_growth = 0.;
      /** An error of the motion times this is one of the flow; by flow. */
      std::vector<double> flow_shares = {};
      Relaxed             relaxed     = {};
    };

    /** Sets all columns of @p after but F. @param around as in live() */
    void
    develop(const PresentCell<dim>      &before,
            const CellView<dim, double> &after,
            const double                 t0,
            const double                 t1,
            const TypesAround<dim>      *around,
            std::vector<CellEvent>      &events,
            Errors                      &errors) const;

    /** Keeps the rates that the step saw, for the next one. @param around the
     *  types beside the cell if they changed, or null */
    void
    expect(const PresentCell<dim>      &before,
           const CellView<dim, double> &after,
           const double                 t,
           const bool                   is_whole,
           const TypesAround<dim>      *around) const;

    /** Lets cell @p p develop, and sets what @p result has of it; its events
     *  are added. @param reader of the beginning of the step */
    void
    let_live(const Tissue<dim>      &tissue,
             const unsigned int      p,
             const double            t1,
             const CellReader<dim>  &reader,
             const TypesAround<dim> *around,
             DevelopmentOfStep<dim> &result) const;

    /** Lets cells develop again until all have seen the changes of the types
     *  beside them. Collective. */
    void
    see_neighbours(const Tissue<dim>      &tissue,
                   const double            t0,
                   const double            t1,
                   DevelopmentOfStep<dim> &result) const;

    /** Whether cells of the type of this one grow by the law. */
    bool
    grows_by_law(const PresentCell<dim> &cell) const
    {
      return effects.grows.empty() || effects.grows[cell.type()];
    }

    /** What the law sees of a cell in its state at t0. */
    GrowingCell<dim>
    growing(const PresentCell<dim> &cell, const double t0) const;

    /** Tells the fate that follows growth how the law lets a living cell grow
     *  in the step, in @p after. */
    void
    announce_growth(const PresentCell<dim>      &before,
                    const CellView<dim, double> &after,
                    const double                 t0,
                    const double                 t1) const;

    /** The factors of F_g to the right of the law's part, at the time @p t of
     *  the clock: the cycle's part and what has relaxed. */
    Tensor<2, dim>
    growth_behind_law(const CellView<dim, const double> &cell,
                      const double                       t) const
    {
      // This is F_cycle F_r, all that stands to the right of the law's factor.
      // Where there is a cell cycle it keeps F_r within its own growth before
      // the cycle.
      if (effects.proliferation)
        return effects.proliferation->growth(cell, t);
      return effects.relaxed.exists() ?
               cell.get(effects.relaxed) :
               Tensor<2, dim>(unit_symmetric_tensor<dim>());
    }

    /**
     * F_g of law, cycle and factors at @p t1, also written to @p after.
     * @param after  has the clock of t1
     * @param missed set to |missed| of the step before, of the law
     */
    Tensor<2, dim>
    living_growth(const PresentCell<dim>      &before,
                  const CellView<dim, double> &after,
                  const double                 t0,
                  const double                 t1,
                  double                      &missed) const;

    /** F_g after all flows, what has flowed written to @p after.
     *  @param F_g    of the other effects at t1
     *  @param errors gets the shares of the flows, and how far it relaxes */
    Tensor<2, dim>
    flow(const PresentCell<dim>      &before,
         const CellView<dim, double> &after,
         Tensor<2, dim>               F_g,
         const double                 t0,
         const double                 t1,
         Errors                      &errors) const;

    /** D F_g, also written to @p after, as if D had come before all growth. */
    Tensor<2, dim>
    absorb(const Tensor<2, dim>        &D,
           const Tensor<2, dim>        &F_g,
           const CellView<dim, double> &after) const;

    DevelopmentEffects<dim> effects;
    CellColumns<dim>        columns_;
    StateColumns<dim>       state_;
    TissueMaterial          material;
    std::uint64_t           random_seed;
    bool                    keeps_rows;
    bool                    announces_growth; // to the fate that divides
  };
} // namespace Morula

#endif
