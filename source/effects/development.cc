// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/development.h>
#include <morula/effects/fate/random.h>

#include <algorithm>
#include <utility>

namespace Morula
{
  template <int dim>
  bool
  DevelopmentEffects<dim>::states_error() const
  {
    return law_follows_state() ||
           std::any_of(flows.begin(), flows.end(), [](const auto &flow) {
             return flow->has_forecast();
           });
  }


  template <int dim>
  CellDevelopment<dim>::CellDevelopment(DevelopmentEffects<dim>  effects,
                                        const CellColumns<dim>  &columns,
                                        const StateColumns<dim> &state,
                                        const TissueMaterial    &material,
                                        const std::uint64_t      random_seed)
    : effects(std::move(effects))
    , columns_(columns)
    , state_(state)
    , material(material)
    , random_seed(random_seed)
  {
    // Rows are kept from of_step() to commit() where an effect has columns of
    // its own, an expression reads the state, or tissue flows. Otherwise a row
    // costs more memory than its second computation costs time.
    keeps_rows = !this->effects.with_state.empty() || state_.any_in_use() ||
                 !this->effects.flows.empty();
    announces_growth = this->effects.law && divides() &&
                       this->effects.fates.dividing->follows_growth();
  }


  template <int dim>
  void
  DevelopmentEffects<dim>::add_fate(std::unique_ptr<const Fate<dim>> fate)
  {
    if (const auto *cycle =
          dynamic_cast<const Proliferation<dim> *>(fate.get()))
      proliferation = cycle;
    if (const auto *of_types = dynamic_cast<const CellTypes<dim> *>(fate.get()))
      types = of_types;
    fates.add(std::move(fate));
  }


  template <int dim>
  CellDevelopment<dim>::CellDevelopment(
    std::unique_ptr<const GrowthLaw<dim>>    law,
    std::optional<CellCycle<dim>>            cycle,
    std::unique_ptr<const DivisionRule<dim>> rule)
    : CellDevelopment(DevelopmentEffects<dim>(),
                      CellColumns<dim>(),
                      StateColumns<dim>(),
                      TissueMaterial(MaterialParameters()),
                      0)
  {
    // This constructor is for tests and small programs: it has no types of
    // cells, no deaths and no expressions of the state, and the seed of the
    // cycle is its own.
    if (law)
      columns_.need_growth();
    effects.law = std::move(law);
    if (!cycle)
      return;
    auto proliferation =
      std::make_unique<Proliferation<dim>>(std::move(*cycle), columns_, 0);
    typename DivisionAxes<dim>::Rules rules;
    if (rule)
      rules.push_back(std::move(rule));
    proliferation->axes = std::make_shared<const DivisionAxes<dim>>(
      DivisionParameters(), state_, 0, std::move(rules));
    effects.with_state.push_back(proliferation.get());
    effects.add_fate(std::move(proliferation));
  }


  template <int dim>
  CellReader<dim>
  CellDevelopment<dim>::reader(const double t, const PastStep &past) const
  {
    // The reader has all that an expression may ask for besides the cell
    // itself. It has no clock without a cell cycle; then every cell counts as
    // its own founder.
    return {state_,
            material,
            effects.proliferation ? &effects.proliferation->columns() : nullptr,
            cycle(),
            random_seed,
            t,
            past};
  }


  template <int dim>
  bool
  CellDevelopment<dim>::is_held(const PresentCell<dim> &cell,
                                const double            t) const
  {
    return cycle() != nullptr &&
           cycle()->is_held(clock(cell.cell()),
                            CellAt<dim>(cell, t),
                            t,
                            cell.cell().elastic_volume_ratio());
  }


  template <int dim>
  void
  CellDevelopment<dim>::set_clock(const CellView<dim, double> &cell,
                                  const CycleState<dim>       &state) const
  {
    effects.proliferation->set_clock(cell, state);
  }


  template <int dim>
  void
  CellDevelopment<dim>::initialize(const types::particle_index  id,
                                   const CellView<dim, double> &cell,
                                   const double                 step,
                                   const GivenState            &given) const
  {
    // The order follows who reads what. The type comes first, as most
    // expressions depend on it; then the cycle, whose lineage key is behind the
    // noise; then what other effects keep. At last, if a step is given, each
    // effect evaluates its expressions once, so that an error is reported
    // before the run begins.
    const CellReader<dim> reader = this->reader(0.);
    const Point<dim>      X      = cell.founder_position();
    if (effects.types)
      cell.set(state_.type,
               given.type ? *given.type : effects.types->founder_type(X));
    if (columns_.lineage_key.exists())
      cell.set(columns_.lineage_key, Random::founder_key(random_seed, id));
    const PresentCell<dim> founder(cell, id, X, reader);
    if (effects.proliferation)
      effects.proliferation->found(founder, cell, step, given.phase);
    for (const Effect<dim> *effect : effects.with_state)
      effect->begin(cell);
    // Without a step only the row is wanted, for example for an estimate.
    if (!(step > 0.))
      return;
    for (const auto &fate : effects.fates.list)
      fate->check_cell(founder, step);
    if (effects.law)
      effects.law->check_cell(founder, step);
    for (const auto &factor : effects.factors)
      factor->check_cell(founder, step);
    for (const auto &flow : effects.flows)
      flow->check_cell(founder, step);
  }


  template <int dim>
  void
  CellDevelopment<dim>::choose_first_axis(
    const PresentCell<dim> &founder, const CellView<dim, double> &cell) const
  {
    if (effects.proliferation)
      effects.proliferation->choose_first_axis(founder, cell);
  }


  template <int dim>
  void
  CellDevelopment<dim>::commit(Tissue<dim>                  &tissue,
                               const DevelopmentOfStep<dim> &of_step,
                               const double                  t0,
                               const double                  t1) const
  {
    // The equilibrium has converged, so the rows of t1 replace those of t0. F
    // is not touched here: the motion of the step updates it afterwards. Rows
    // that were not kept are computed again from the same committed state and
    // the same times, and so come out the same to the last bit.
    if (!grows() && !keeps_rows)
      return;
    const CellReader<dim>  reader = this->reader(t0, of_step.past);
    std::vector<double>    row;
    std::vector<CellEvent> events; // not read: of_step has them already
    Errors                 errors;
    for (unsigned int p = 0; p < tissue.cells().size(); ++p)
      {
        const CellView<dim, double> cell = tissue.cell(p);
        if (keeps_rows)
          {
            const auto kept =
              of_step.rows.begin() + std::size_t(p) * columns_.n_numbers();
            std::copy(kept, kept + columns_.n_numbers(), cell.row().begin());
            continue;
          }
        // The row was not kept, as computing it again is cheap.
        row.assign(cell.row().begin(), cell.row().end());
        develop(present_cell(tissue, p, reader),
                CellView<dim, double>(make_array_view(row), columns_),
                t0,
                t1,
                nullptr,
                events,
                errors);
        std::copy(row.begin(), row.end(), cell.row().begin());
      }
  }


  template <int dim>
  unsigned int
  CellDevelopment<dim>::make_daughter(const CellView<dim, double> &daughter,
                                      const types::particle_index  id,
                                      const Point<dim>            &position,
                                      const unsigned int           which,
                                      const double                 birth,
                                      const double                 t1,
                                      std::vector<CellEvent>      &events) const
  {
    // A daughter begins as a copy of her mother. First she gets what is hers by
    // birth, then she lives through the rest of the step, from her birth to t1,
    // in which she may change her type or die. The type that is returned is the
    // one she is born with, since the later change is an event of its own.
    if (state_.birth_time.exists())
      daughter.set(state_.birth_time, birth);
    for (const auto &fate : effects.fates.list)
      fate->inherit(daughter, state_, which, birth);
    const unsigned int own =
      state_.type.exists() ? daughter.get(state_.type) : 0;
    // Where the clock is the only fate there is nothing to do now: it has exact
    // times, so the next step finds what happened since the birth.
    if (!effects.proliferation || effects.fates.list.size() > 1)
      {
        const CellReader<dim>  reader = this->reader(t1);
        const PresentCell<dim> cell(daughter, id, position, reader);
        effects.fates.live(cell, daughter, birth, t1, events);
      }
    return own;
  }


  template struct DevelopmentEffects<2>;
  template struct DevelopmentEffects<3>;
  template class CellDevelopment<2>;
  template class CellDevelopment<3>;
} // namespace Morula
