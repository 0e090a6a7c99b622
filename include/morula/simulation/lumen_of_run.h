// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_lumen_of_run_h
#define morula_simulation_lumen_of_run_h

#include <morula/mechanics/enclosure.h>
#include <morula/mechanics/momentum_balance.h>
#include <morula/simulation/tissue_model.h>
#include <morula/solver/turns.h>

#include <deal.II/base/timer.h>

#include <optional>
#include <string>

namespace Morula
{
  /** The state of a lumen that outlives a step. */
  struct LumenMemory
  {
    double volume_at_start = 0.; // µm^dim, at t = 0
    double pressure        = 0.; // kPa, above that around the tissue
  };

  /** Writes the memory of a lumen into the numbers that outlive a step. */
  void
  keep_lumen(const LumenMemory &lumen, NamedNumbers &kept);

  /** Writes the lumen's volume and pressure at t = 0 into the kept numbers, if
   *  there is a lumen. Collective. */
  template <int dim>
  void
  begin_lumen(const TissueModel<dim> &model,
              const Tissue<dim>      &tissue,
              NamedNumbers           &kept);

  /** What is kept of the lumen; nothing without one. */
  template <int dim>
  std::optional<LumenMemory>
  saved_lumen(const TissueModel<dim> &model, const NamedNumbers &kept);

  /** The lumen's columns of statistics.csv, if there is one. Collective. */
  template <int dim>
  void
  describe_lumen(const TissueModel<dim> &model,
                 const Tissue<dim>      &tissue,
                 const NamedNumbers     &kept,
                 NamedNumbers           &columns);

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

  /**
   * Seeks the pressure of a lumen that keeps its volume, turn by turn. If a gas
   * fills it, one turn is enough: doc/theory.md (4.8j). Keeps references to all
   * that it is given.
   */
  template <int dim>
  class LumenPressure : public TurnParticipant
  {
  public:
    /** @param content of the lumen in @p balance; its pressure is changed */
    LumenPressure(const Lumen<dim>           &lumen,
                  const Tissue<dim>          &tissue,
                  const SplineSpace<dim>     &space,
                  const MomentumBalance<dim> &balance,
                  EnclosedContent            &content,
                  TimerOutput                &timer);

    bool
    renew(const Equilibrium::Vector &u) override;

    std::string
    unfinished() const override;

    /** The pressure at the last equilibrium, kPa. */
    double
    pressure() const;

  private:
    const Lumen<dim>           &lumen;
    const Tissue<dim>          &tissue;
    const SplineSpace<dim>     &space;
    const MomentumBalance<dim> &balance;
    EnclosedContent            &content;
    TimerOutput                &timer;
    const double                wanted; // volume, µm^dim
    double                      pressure_ = 0.;
    double                      error     = 0.; // of the volume, relative
  };
} // namespace Morula

#endif
