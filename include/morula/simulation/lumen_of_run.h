// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_lumen_of_run_h
#define morula_simulation_lumen_of_run_h

#include <morula/mechanics/enclosure.h>
#include <morula/mechanics/momentum_balance.h>
#include <morula/output/statistics.h>
#include <morula/simulation/tissue_model.h>

#include <deal.II/base/timer.h>

#include <functional>
#include <optional>

namespace Morula
{
  /** The state of a lumen that outlives a step. */
  struct LumenMemory
  {
    double volume_at_start = 0.; // µm^dim, at t = 0
    double pressure        = 0.; // kPa, above that around the tissue
  };

  /** The lumen at t = 0; nothing without one. Collective. */
  template <int dim>
  std::optional<LumenMemory>
  lumen_at_start(const TissueModel<dim> &model, const Tissue<dim> &tissue);

  /** The lumen's state for statistics.csv. Collective. */
  template <int dim>
  std::optional<LumenState>
  lumen_state(const TissueModel<dim>           &model,
              const Tissue<dim>                &tissue,
              const std::optional<LumenMemory> &memory);

  /** The lumen's content before the pressure of the step is known.
   *  @param t_next end of the step, day
   *  @param volume at its beginning, µm^dim
   *  @param typical_stiffness of the tissue, kPa
   *  @throws InputError */
  template <int dim>
  EnclosedContent
  lumen_content(const Lumen<dim>  &lumen,
                const LumenMemory &memory,
                const double       t_next,
                const double       volume,
                const double       typical_stiffness);

  /** An equilibrium with the lumen's pressure. */
  struct LumenEquilibrium
  {
    Equilibrium::Evaluation evaluation;
    double                  pressure; // kPa
  };

  /**
   * Solves a step again with other pressures until the lumen has its volume. If
   * a gas fills it, once is enough: doc/theory.md (4.8j). Collective.
   * @param solve   finds the displacement @p u that balances @p content
   * @param content of the lumen; the pressure that is sought is changed
   * @throws StepFailed if it does not get its volume
   */
  template <int dim>
  LumenEquilibrium
  keep_lumen_volume(const Lumen<dim>                               &lumen,
                    const Tissue<dim>                              &tissue,
                    const SplineSpace<dim>                         &space,
                    const std::function<Equilibrium::Evaluation()> &solve,
                    MomentumBalance<dim>                           &balance,
                    EnclosedContent                                &content,
                    const Equilibrium::Vector                      &u,
                    TimerOutput                                    &timer);
} // namespace Morula

#endif
