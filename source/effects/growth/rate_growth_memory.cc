// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/growth/rate_growth.h>
#include <morula/effects/state/present_cell.h>

#include <algorithm>
#include <cmath>

// What growth by rates keeps of the past: doc/theory.md (5.9) and section 10.2.

namespace Morula
{
  template <int dim>
  FirstStep
  RateGrowth<dim>::seen_at_first_step(const GrowingCell<dim> &cell,
                                      const double            t0) const
  {
    const double dt = t0 - cell.cell->get(memory->time);
    if (dt <= slack) // the first step: as if held
      return {};
    const double withheld = cell.cell->get(memory->withheld);
    const double grown    = std::log(determinant(cell.growth));
    const double J_e      = cell.cell->elastic_volume_ratio();
    if (withheld != 0.)
      return after_first_step(grown, withheld, -std::log(J_e), dt);
    return {0., (std::log(J_e) + grown - cell.cell->get(memory->place)) / dt};
  }


  template <int dim>
  SymmetricTensor<2, dim>
  RateGrowth<dim>::missed_tensor(const GrowingCell<dim> &cell) const
  {
    const PastStep &past = cell.present->reader().past;
    if (!expected || !past.exists() ||
        // The second step makes good what the first withheld, and all else.
        (memory && cell.cell->get(memory->withheld) != 0.))
      return {};
    const double t    = past.middle();
    const double half = 0.5 * past.length();
    if (expected->volume.exists())
      return half / dim *
             (cell.present->value(rate, t) - cell.cell->get(expected->volume)) *
             unit_symmetric_tensor<dim>();
    return half * (tensor_of(rates(*cell.present, t, t), *cell.present, t) -
                   cell.cell->get(expected->tensor));
  }


  template <int dim>
  double
  RateGrowth<dim>::size_of(const SymmetricTensor<2, dim> &missed)
  {
    return std::abs(trace(missed)) + deviator(missed).norm();
  }


  template <int dim>
  double
  RateGrowth<dim>::missed(const GrowingCell<dim> &cell) const
  {
    return size_of(missed_tensor(cell));
  }


  template <int dim>
  void
  RateGrowth<dim>::expect(const GrowingCell<dim>      &cell,
                          const Rates                 &now,
                          const double                 t0,
                          const double                 t1,
                          const CellView<dim, double> &after) const
  {
    const GrowthFeedback all = now.all();
    const double widening = memory ? seen_at_first_step(cell, t0).widening : 0.;
    const double k        = expected_rate(now.of_rate, all, widening);
    if (expected->volume.exists())
      {
        after.set(expected->volume, k);
        return;
      }
    Rates end               = now;
    end.of_rate.rate        = k;
    end.of_homeostasis.rate = expected_rate(now.of_homeostasis, all, widening);
    end.shape *= std::exp(-now.shape_damping);
    after.set(expected->tensor, tensor_of(end, *cell.present, (t0 + t1) / 2.));
  }


  template <int dim>
  void
  RateGrowth<dim>::remember(const GrowingCell<dim>      &cell,
                            const double                 t0,
                            const double                 t1,
                            const CellView<dim, double> &after) const
  {
    if (!expected && !memory)
      return;
    const Rates now = rates(*cell.present, t0, t1);
    if (expected)
      expect(cell, now, t0, t1, after);
    if (memory)
      remember_place(cell, now, t0, t1, after);
  }


  template <int dim>
  void
  RateGrowth<dim>::remember_place(const GrowingCell<dim>      &cell,
                                  const Rates                 &now,
                                  const double                 t0,
                                  const double                 t1,
                                  const CellView<dim, double> &after) const
  {
    if (t0 <= slack)
      {
        const GrowthFeedback all = now.all();
        after.set(memory->withheld,
                  (t1 - t0) * (all.rate - predicted_rate(all, all, 0.)));
      }
    else if (cell.cell->get(memory->withheld) != 0.)
      // The second step made it good: the place is measured from t = 0 once
      // more.
      after.set(memory->withheld, 0.);
    else
      {
        after.set(memory->place,
                  std::log(cell.cell->elastic_volume_ratio() *
                           determinant(cell.growth)));
        after.set(memory->time, t0);
      }
  }


  template class RateGrowth<2>;
  template class RateGrowth<3>;
} // namespace Morula
