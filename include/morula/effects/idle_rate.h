// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_idle_rate_h
#define morula_effects_idle_rate_h

#include <morula/base/expression.h>
#include <morula/effects/effect.h>

#include <functional>
#include <string>
#include <vector>

namespace Morula
{
  /** The moments of a run at which a value is asked for. */
  enum class AskedAt
  {
    /** The ends of steps and the moments in their middle. */
    all_moments,
    ends_of_steps
  };

  /**
   * Whether a value never acts: that of no type at any founder at any time.
   * False where the state of cells decides, where asking would take long, and
   * where a value cannot be had, which is refused elsewhere. Collective.
   * @param acts what a value must be to act
   */
  template <int dim>
  bool
  never_acts(const Expression                        &value,
             const std::function<bool(const double)> &acts,
             const AskedAt                            moments,
             const Preview<dim>                      &scene);

  /** Warns of a rate that is 0 at all founders in all steps, though its text is
   *  not 0. Collective. @param so what follows from that, a sentence */
  template <int dim>
  void
  review_rate(const Expression   &rate,
              const std::string  &so,
              const Preview<dim> &scene,
              Review             &review);

  /** Warns of a law of which all values are @p neutral at all founders in all
   *  steps, so that no cell grows by it. Collective. */
  template <int dim>
  void
  review_growth(const std::vector<const Expression *> &values,
                const double                           neutral,
                const Preview<dim>                    &scene,
                Review                                &review);
} // namespace Morula

#endif
