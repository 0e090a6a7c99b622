// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

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
    return across * unit_symmetric_tensor<dim>() +
           (along - across) * symmetrize(outer_product(a, a));
  }


  template <int dim>
  Tensor<2, dim>
  grown(const Tensor<2, dim>          &before,
        const SymmetricTensor<2, dim> &L,
        const double                   dt)
  {
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
    return part.rate -
           part.damping * (all.rate - seen(all, widening)) * delay(all.damping);
  }


  double
  expected_rate(const GrowthFeedback &part,
                const GrowthFeedback &all,
                const double          widening)
  {
    return part.rate - part.damping * (all.rate - seen(all, widening)) *
                         mean_of_decay(all.damping);
  }


  FirstStep
  after_first_step(const double grown,
                   const double withheld,
                   const double squeezed,
                   const double dt)
  {
    if (std::abs(grown) <= 0. || dt <= 0.)
      return {};
    const double relief =
      std::min(std::max(1. - squeezed / grown, 0.), 1.); // alpha
    const double c = withheld / grown;
    // What the step would have grown with this in mind.
    const double would_be = (grown + withheld) / (1. + c * (1. - relief));
    return {would_be - grown, relief * would_be / dt};
  }


  template SymmetricTensor<2, 2>
  rate_along_and_across(const Tensor<1, 2> &, const double, const double);
  template SymmetricTensor<2, 3>
  rate_along_and_across(const Tensor<1, 3> &, const double, const double);
  template Tensor<2, 2>
  grown(const Tensor<2, 2> &, const SymmetricTensor<2, 2> &, const double);
  template Tensor<2, 3>
  grown(const Tensor<2, 3> &, const SymmetricTensor<2, 3> &, const double);
} // namespace Morula
