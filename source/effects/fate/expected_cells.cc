// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fate/expected_cells.h>

#include <boost/math/special_functions/gamma.hpp>

#include <cmath>

namespace Morula
{
  double
  expected_cells(const double T,
                 const double Lambda,
                 const double t,
                 const bool   together)
  {
    // The sum goes over generations: the k-th division of a lineage adds
    // 2^(k-1) cells. It comes after (k - 1/2) T in cycles and the waits in G0
    // before them. The sum of k exponential waits has a gamma distribution,
    // whose function is the share of lineages that have come so far.
    double n = 1.;
    for (unsigned int k = 1; (k - 0.5) * T <= t && std::isfinite(n); ++k)
      {
        // The k-th division comes after k waits, without the first if all start
        // together.
        const unsigned int waits = together ? k - 1 : k;
        const double       share =
          waits == 0 ?
                  1. :
                Lambda == 0. ?
                  0. :
                  boost::math::gamma_p(waits, Lambda * (t - (k - 0.5) * T));
        if (share == 0.)
          break;
        n += std::exp2(k - 1.) * share;
      }
    return n;
  }


  double
  expected_cells_by_size(const double ratio, const double noise)
  {
    // The k-th division of a lineage adds 2^(k-1) cells, if all before it have
    // come and the cells of that generation, which have 2^(1-k) of the volume,
    // are beyond their threshold. Thresholds of a mother and a daughter are
    // independent.
    const double s = std::sqrt(std::log1p(noise * noise));
    double       n = 1., share = 1.;
    for (unsigned int k = 1; share > 1e-6; ++k)
      {
        const double log_size = std::log(ratio) - (k - 1.) * std::log(2.);
        share *= s == 0. ?
                   (log_size >= 0. ? 1. : 0.) :
                   0.5 * std::erfc(-(log_size / s + 0.5 * s) / std::sqrt(2.));
        n += std::exp2(k - 1.) * share;
      }
    return n;
  }


  template <int dim>
  Descendants<dim>::Descendants(const CellCycleParameters &cycle,
                                const double               end_time)
    : together(cycle.start == "together")
    , end_time(end_time)
    , where(cycle.where.expression(dim))
    , duration(cycle.duration.expression(dim))
    , rate(cycle.exit_rate.expression(dim))
    , checkpoint(cycle.size_checkpoint.expression(dim))
  {}


  template <int dim>
  double
  Descendants<dim>::expected(const Point<dim> &X)
  {
    // Where the run alone can tell, the answer is 1, a lower bound.
    // Neighbouring founders often have the same duration and rate, so the last
    // result is kept.
    if (!(where.value(X, 0.) > 0.))
      return 1.;
    for (const Expression *expression : {&duration, &rate, &checkpoint})
      if (depends_on_more_than_place(*expression))
        return 1.;
    if (checkpoint.value(X, 0.) > 0.)
      return 1.;
    const std::pair<double, double> here = {duration.value(X, 0.),
                                            rate.value(X, 0.)};
    if (here != last)
      {
        last = here;
        n    = expected_cells(here.first, here.second, end_time, together);
      }
    return n;
  }


  template class Descendants<2>;
  template class Descendants<3>;
} // namespace Morula
