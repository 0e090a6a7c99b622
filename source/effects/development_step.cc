// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/effects/development.h>
#include <morula/effects/neighbour_histories.h>

#include <algorithm>

// This file lets all cells develop through a step.

namespace Morula
{
  template <int dim>
  void
  CellDevelopment<dim>::expect(const PresentCell<dim>      &before,
                               const CellView<dim, double> &after,
                               const double                 t,
                               const bool                   is_whole,
                               const TypesAround<dim>      *around) const
  {
    // An event in mid-step resets hazards, so that the next step could compare
    // nothing: rates are remembered only of a step without events. What the
    // types beside the cell have changed is in the integrals already, so the
    // next step must not see it as missed: the rate is that among the types at
    // the end.
    const auto tell = [&](const PresentCell<dim> &cell) {
      for (const auto &fate : effects.fates)
        fate->expect(cell, after, t, is_whole);
    };
    if (around == nullptr)
      {
        tell(before);
        return;
      }
    const auto                  at_t0 = before.cell().row();
    std::vector<double>         row(at_t0.begin(), at_t0.end());
    const CellView<dim, double> at_end(make_array_view(row), columns_);
    around->set(at_end, around->size());
    tell(PresentCell<dim>(
      at_end, before.id(), before.position(), before.reader()));
  }


  template <int dim>
  void
  CellDevelopment<dim>::develop(const PresentCell<dim>      &before,
                                const CellView<dim, double> &after,
                                const double                 t0,
                                const double                 t1,
                                const TypesAround<dim>      *around,
                                std::vector<CellEvent>      &events,
                                Errors                      &errors) const
  {
    // The cell is seen twice: `before` is its committed state of t0 and is
    // never written, `after` is a copy of its row that becomes the state of t1.
    // Three passes follow: events and clocks, then what effects keep, then the
    // product (8.7) of doc/theory.md. The step's equilibrium is sought
    // afterwards with the new F_g, so F in `after` is still that of t0.

    // What happens to the cell comes first, as growth depends on it: a cell
    // that dies or enters S within the step grows otherwise from then on.
    errors.missed_growth       = 0.;
    const std::size_t n_events = events.size();
    const bool dead = is_dead_at(effects.fates, before, after, t0, events);
    if (!dead)
      {
        for (const auto &fate : effects.fates)
          // The integral of a rate gets what the last step missed of it,
          // doc/theory.md (5.9), before thresholds are looked for.
          fate->make_good(before, after);
        if (announces_growth)
          announce_growth(before, after, t0, t1);
        // A clock that no other fate can interrupt never has to be taken back,
        // so it needs no search for the earliest event.
        if (effects.proliferation && effects.fates.size() == 1)
          effects.proliferation->run_clock(before, after, {t0, t1});
        else
          live(effects.fates, before, after, t0, t1, events, around);
        expect(
          before, after, 0.5 * (t0 + t1), events.size() == n_events, around);
      }
    for (const Effect<dim> *effect : effects.with_state)
      effect->advance(before, after, t0, t1);
    if (!grows())
      return;

    // The product of all that grows is doc/theory.md (8.7). A dead cell keeps
    // the growth that it had and shrinks by (6.9); one that dies in this step
    // grows until its death. Flows come last: they relax the stress of the
    // elastic part, which is known only when all other factors are.
    Tensor<2, dim> F_g =
      dead ?
        before.cell().growth() :
        living_growth(before,
                      after,
                      t0,
                      std::min(t1, time_of_death<dim>(effects.fates, after)),
                      errors.missed_growth);
    for (const auto &fate : effects.fates)
      if (fate->time_of_death(after) <= t1)
        F_g *= fate->shrink(after, t1);
    F_g = flow(before, after, F_g, t0, t1, errors.flow_shares);
    after.set(columns_.growth, F_g);
  }


  template <int dim>
  DevelopmentOfStep<dim>
  CellDevelopment<dim>::of_step(const Tissue<dim> &tissue,
                                const double       t0,
                                const double       t1,
                                const PastStep    &past) const
  {
    // The loop is over the cells that this rank owns, in the order of the
    // store, and no cell reads another one. The tissue is left as it is,
    // because the step may fail and be repeated with half the length. The
    // results are vectors in the same order, with the growth of t0 and of t1
    // for the first tangent, doc/theory.md (5.1). Where changes of type depend
    // on the types of the cells beside, some cells then live again, until all
    // have seen what those beside them do: section 12.1.
    DevelopmentOfStep<dim> result;
    result.present = grows();
    result.past    = past;
    if (!present())
      return result;
    const std::size_t n = tissue.cells().size();
    if (keeps_rows)
      result.rows.resize(n * columns_.n_numbers());
    if (grows())
      {
        result.previous.resize(n);
        result.current.resize(n);
      }
    if (effects.law_follows_state())
      result.missed_growth.resize(n);
    if (material.depends_on_state())
      result.lame.resize(n);
    result.flow_shares.resize(n * effects.flows.size());
    std::vector<double> row;
    everywhere(tissue.communicator(), [&]() {
      for (unsigned int p = 0; p < n; ++p)
        let_live(tissue, p, t0, t1, nullptr, row, result);
    });
    if (effects.neighbours)
      see_neighbours(tissue, t0, t1, result);
    return result;
  }


  template <int dim>
  void
  CellDevelopment<dim>::see_neighbours(const Tissue<dim>      &tissue,
                                       const double            t0,
                                       const double            t1,
                                       DevelopmentOfStep<dim> &result) const
  {
    // Each round lets those cells live again beside which something has come
    // out otherwise than they saw it. In round k all is right that has fewer
    // than k causes in the step, one after the other: so the rounds end, and
    // the result is that of all events in the order of time, whatever the
    // ranks.
    NeighbourHistories<dim> histories(tissue,
                                      state_,
                                      *effects.neighbours,
                                      result.events);
    std::vector<double>     row;
    while (histories.exchange())
      everywhere(tissue.communicator(), [&]() {
        for (const unsigned int p : histories.to_live_again())
          {
            result.events.clear();
            const TypesAround<dim> around = histories.around(p);
            let_live(tissue, p, t0, t1, &around, row, result);
            histories.set(p, result.events);
          }
      });
    result.events = histories.events();
  }


  template <int dim>
  void
  CellDevelopment<dim>::let_live(const Tissue<dim>      &tissue,
                                 const unsigned int      p,
                                 const double            t0,
                                 const double            t1,
                                 const TypesAround<dim> *around,
                                 std::vector<double>    &row,
                                 DevelopmentOfStep<dim> &result) const
  {
    // The row is only the place for a cell's next state, so that a loop over
    // cells does not ask the heap. Stiffness that depends on the state is that
    // of the cell with its new type and age, so it is read with the time of the
    // end.
    const Cells<dim>      &cells  = tissue.cells();
    const CellReader<dim>  reader = this->reader(t0, result.past);
    const auto             cell   = cells[p];
    const PresentCell<dim> before(cell, cells.id(p), cells.position(p), reader);
    row.assign(cell.row().begin(), cell.row().end());
    const CellView<dim, double> after(make_array_view(row), columns_);
    Errors                      errors;
    develop(before, after, t0, t1, around, result.events, errors);
    if (grows())
      {
        result.previous[p] = cell.growth();
        result.current[p]  = after.growth();
      }
    if (effects.law_follows_state())
      result.missed_growth[p] = errors.missed_growth;
    std::copy(errors.flow_shares.begin(),
              errors.flow_shares.end(),
              result.flow_shares.begin() + p * effects.flows.size());
    if (material.depends_on_state())
      {
        const CellReader<dim> after_step = this->reader(t1);
        result.lame[p] =
          PresentCell<dim>(after, cells.id(p), cells.position(p), after_step)
            .lame();
      }
    if (keeps_rows)
      std::copy(row.begin(),
                row.end(),
                result.rows.begin() + std::size_t(p) * columns_.n_numbers());
  }


  template class CellDevelopment<2>;
  template class CellDevelopment<3>;
} // namespace Morula
