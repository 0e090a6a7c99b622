// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/simulation/simulation.h>

#include <cmath>
#include <sstream>

namespace Morula
{
  namespace
  {
    /** Of the lumen's volume. Solver/Newton tolerance limits it as well. */
    constexpr double volume_tolerance = 1e-8;

    /** Equilibria of a step with different pressures in the lumen. */
    constexpr unsigned int max_equilibria = 20;

    /** Compression modulus of the content whose pressure is being found, over
     *  Young's modulus of the tissue: doc/theory.md (4.8j). */
    constexpr double relative_modulus = 100.;
  } // namespace


  template <int dim>
  void
  Simulation<dim>::begin_lumen()
  {
    if (const Lumen<dim> *lumen = boundary_conditions.lumen())
      {
        lumen_at_start = enclosed_volume(lumen_patches(*lumen, tissue), comm);
        if (!lumen->keeps_volume())
          lumen_pressure = lumen->pressure(0.);
      }
  }


  template <int dim>
  void
  Simulation<dim>::restore_lumen()
  {
    if (boundary_conditions.lumen() == nullptr)
      return;
    lumen_at_start = resumed_from->number("lumen_at_start");
    lumen_pressure = resumed_from->number("lumen_pressure");
  }


  template <int dim>
  void
  Simulation<dim>::save_lumen(SnapshotData<dim> &data) const
  {
    if (boundary_conditions.lumen() == nullptr)
      return;
    data.numbers["lumen_at_start"] = lumen_at_start;
    data.numbers["lumen_pressure"] = lumen_pressure;
  }


  template <int dim>
  std::optional<LumenState>
  Simulation<dim>::lumen_state() const
  {
    const Lumen<dim> *lumen = boundary_conditions.lumen();
    if (lumen == nullptr)
      return {};
    return LumenState{enclosed_volume(lumen_patches(*lumen, tissue), comm),
                      lumen_pressure};
  }


  template <int dim>
  EnclosedContent
  Simulation<dim>::lumen_content(const double volume) const
  {
    const Lumen<dim> &lumen = *boundary_conditions.lumen();
    const double      t     = time_steps.next();
    EnclosedContent   content;
    if (!lumen.keeps_volume())
      {
        content.gas = lumen.pressure(t) * lumen_at_start;
        return content;
      }
    content.target              = lumen.volume(t, lumen_at_start);
    content.pressure_at_target  = lumen_pressure;
    content.stiffness_at_target = relative_modulus * typical_stiffness / volume;
    return content;
  }


  template <int dim>
  Equilibrium::Evaluation
  Simulation<dim>::keep_lumen_volume(
    const SplineSpace<dim>                         &space,
    const std::function<Equilibrium::Evaluation()> &solve,
    MomentumBalance<dim>                           &balance,
    EnclosedContent                                &content,
    const Equilibrium::Vector                      &u)
  {
    const Lumen<dim> &lumen  = *boundary_conditions.lumen();
    const double      wanted = content.target;
    double            error  = 0.;
    for (unsigned int i = 0; i < max_equilibria; ++i)
      {
        const Equilibrium::Evaluation evaluation = solve();
        const TimerOutput::Scope      section(timer, "lumen");
        const double                  V = balance.enclosed_volume(u);
        lumen_pressure_of_step          = content.pressure(V);
        if (!lumen.keeps_volume())
          return evaluation;
        const DisplacementField<dim> displacement(space, u, comm);
        const double                 after =
          enclosed_volume(lumen_patches(lumen, tissue, &displacement), comm);
        error = after / wanted - 1.;
        if (std::abs(error) <= volume_tolerance)
          return evaluation;
        // The pressure moves on, and the volume of the step, by which the
        // energy counts, is corrected by what that of the moved points has
        // more: doc/theory.md (4.8j).
        content.pressure_at_target = lumen_pressure_of_step;
        content.target             = wanted - (after - V);
        balance.go_on();
      }
    std::ostringstream text;
    text << "the lumen does not get its volume: it still differs by " << error
         << " times " << wanted << (dim == 3 ? " um^3" : " um^2");
    throw StepFailed(text.str());
  }


  template class Simulation<2>;
  template class Simulation<3>;
} // namespace Morula
