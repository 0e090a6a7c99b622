// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/effects/growth/rate_growth.h>
#include <morula/effects/state/present_cell.h>

#include <algorithm>
#include <cmath>

// The formulas of growth by rates, and what it keeps of the past: what it
// expected, for doc/theory.md (5.9), and how its place widened, for section
// 10.2.

namespace Morula
{
  template <int dim>
  SymmetricTensor<2, dim>
  rate_along_and_across(const Tensor<1, dim> &a,
                        const double          along,
                        const double          across)
  {
    // This is L of doc/theory.md (10.1) without H: `across` in all directions,
    // and the difference added along the unit vector.
    return across * unit_symmetric_tensor<dim>() +
           (along - across) * symmetrize(outer_product(a, a));
  }


  template <int dim>
  Tensor<2, dim>
  grown(const Tensor<2, dim>          &before,
        const SymmetricTensor<2, dim> &L,
        const double                   dt)
  {
    // This is the exponential of doc/theory.md (10.1), by the eigenvectors of
    // the symmetric L. It is exact for a constant L, however long the step is.

    // Without a direction the factor is a number, and shape stays as it is.
    if (deviator(L).norm() <= 1e-15 * L.norm())
      return std::exp(dt * trace(L) / dim) * before;
    Tensor<2, dim> factor;
    for (const auto &[rate, axis] : eigenvectors(L))
      factor += std::exp(dt * rate) * outer_product(axis, axis);
    return factor * before;
  }


  double
  mean_of_decay(const double c)
  {
    return c > 0. ? -std::expm1(-c) / c : 1.;
  }


  namespace
  {
    /** (1 - φ(c)) / c with φ of mean_of_decay(), which is 1/2 at c = 0. */
    double
    delay(const double c)
    {
      // Below this the difference has fewer digits than the series.
      constexpr double small = 1e-3;
      return c < small ? 0.5 - c / 6. + c * c / 24. :
                         (1. - mean_of_decay(c)) / c;
    }


    /** The rate at which the place widens, as far as it is a forecast: a place
     *  that narrows while the cell grows, or widens while it shrinks, is no
     *  forecast of what growth does to it. */
    double
    seen(const GrowthFeedback &all, const double widening)
    {
      return all.rate * widening > 0. ? widening : 0.;
    }
  } // namespace


  double
  predicted_rate(const GrowthFeedback &part,
                 const GrowthFeedback &all,
                 const double          widening)
  {
    // The mean rate over the step is doc/theory.md (10.5), in the form for two
    // parts: each falls as its own damping says, by the excess of the sum.
    return part.rate -
           part.damping * (all.rate - seen(all, widening)) * delay(all.damping);
  }


  double
  expected_rate(const GrowthFeedback &part,
                const GrowthFeedback &all,
                const double          widening)
  {
    // This is the rate at the end of the step, doc/theory.md (10.5a). The next
    // step compares it with what the rate has become.
    return part.rate - part.damping * (all.rate - seen(all, widening)) *
                         mean_of_decay(all.damping);
  }


  FirstStep
  after_first_step(const double grown,
                   const double withheld,
                   const double squeezed,
                   const double dt)
  {
    // This is doc/theory.md (10.6). The first step knew nothing of how the
    // tissue gives way, and withheld growth. Now `relief` says which part of
    // the growth found room: 1 in free tissue, 0 in a rigid box. What was
    // withheld is due in that proportion.
    // Without growth in the first step there is no measure of relief.
    if (std::abs(grown) <= 0. || dt <= 0.)
      return {};
    const double relief =
      std::min(std::max(1. - squeezed / grown, 0.), 1.); // alpha
    const double c = withheld / grown;
    // This is what the step would have grown if it had known the relief.
    const double would_be = (grown + withheld) / (1. + c * (1. - relief));
    return {would_be - grown, relief * would_be / dt};
  }


  MORULA_INSTANTIATE(rate_along_and_across);
  MORULA_INSTANTIATE(grown);


  template <int dim>
  FirstStep
  RateGrowth<dim>::seen_at_first_step(const GrowingCell<dim> &cell,
                                      const double            t0) const
  {
    // There are three cases. In the first step nothing is known, and the place
    // is taken as rigid. In the second the first step's answer is evaluated,
    // doc/theory.md (10.6). Later the widening is the mean rate of ln (J_e det
    // F_law) over the step before.
    const double dt = t0 - cell.cell->get(memory->time);
    if (dt <= slack) // This is the first step: the cell counts as held.
      return {};
    const double withheld = cell.cell->get(memory->withheld);
    const double grown    = std::log(determinant(cell.growth));
    const double J_e      = cell.cell->elastic_volume_ratio();
    const double place    = cell.cell->get(memory->place);
    if (withheld != 0.)
      return after_first_step(grown, withheld, place - std::log(J_e), dt);
    return {0., (std::log(J_e) + grown - place) / dt};
  }


  template <int dim>
  SymmetricTensor<2, dim>
  RateGrowth<dim>::missed_tensor(const GrowingCell<dim> &cell) const
  {
    // This is doc/theory.md (5.9): half of the last step times the difference
    // between the rate of the present state, with the time of the last step's
    // middle, and what that step expected. It is a function of the committed
    // state, so a halved step finds the same.
    const PastStep &past = cell.present->reader().past;
    if (!expected || !past.exists() ||
        // In the second step after_first_step() makes good all that the first
        // missed; adding this would count it twice.
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
  void
  RateGrowth<dim>::expect(const GrowingCell<dim>      &cell,
                          const Rates                 &now,
                          const double                 t0,
                          const double                 t1,
                          const CellView<dim, double> &after) const
  {
    // What the rates are expected to be at the end of this step is kept for the
    // next one: by doc/theory.md (10.5a) with feedback. Where the direction
    // cannot turn, the rate of the volume is enough.
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
    // A type that does not grow now comes here, too; a growing cell has done
    // the same in grow().
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
    // The three branches are the first step, the second and all later ones.
    // What was withheld is stored as a number that is not zero, which tells the
    // second step that it is the second.
    if (t0 <= slack)
      {
        const GrowthFeedback all = now.all();
        after.set(memory->withheld,
                  (t1 - t0) * (all.rate - predicted_rate(all, all, 0.)));
        after.set(memory->place, std::log(cell.cell->elastic_volume_ratio()));
      }
    else if (cell.cell->get(memory->withheld) != 0.)
      // The second step has made it good. Place and time stay those of t = 0,
      // so the third step measures the widening over the first two.
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
