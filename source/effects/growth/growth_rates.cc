// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/effects/growth/growth_rates.h>

#include <algorithm>
#include <cmath>

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
} // namespace Morula
