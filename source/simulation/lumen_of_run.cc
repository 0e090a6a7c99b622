// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/surface/boundary_terms.h>
#include <morula/effects/surface/lumen.h>
#include <morula/simulation/lumen_of_run.h>

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
  std::optional<LumenMemory>
  lumen_at_start(const TissueModel<dim> &model, const Tissue<dim> &tissue)
  {
    const Lumen<dim> *lumen = model.boundary_conditions.lumen();
    if (lumen == nullptr)
      return {};
    return LumenMemory{enclosed_volume(lumen_patches(*lumen, tissue),
                                       tissue.communicator()),
                       lumen->keeps_volume() ? 0. : lumen->pressure(0.)};
  }


  template <int dim>
  std::optional<LumenState>
  lumen_state(const TissueModel<dim>           &model,
              const Tissue<dim>                &tissue,
              const std::optional<LumenMemory> &memory)
  {
    if (!memory)
      return {};
    return LumenState{
      enclosed_volume(lumen_patches(*model.boundary_conditions.lumen(), tissue),
                      tissue.communicator()),
      memory->pressure};
  }


  template <int dim>
  EnclosedContent
  lumen_content(const Lumen<dim>  &lumen,
                const LumenMemory &memory,
                const double       t_next,
                const double       volume,
                const double       typical_stiffness)
  {
    EnclosedContent content;
    if (!lumen.keeps_volume())
      {
        content.gas = lumen.pressure(t_next) * memory.volume_at_start;
        return content;
      }
    content.target              = lumen.volume(t_next, memory.volume_at_start);
    content.pressure_at_target  = memory.pressure;
    content.stiffness_at_target = relative_modulus * typical_stiffness / volume;
    return content;
  }


  template <int dim>
  LumenEquilibrium
  keep_lumen_volume(const Lumen<dim>                               &lumen,
                    const Tissue<dim>                              &tissue,
                    const SplineSpace<dim>                         &space,
                    const std::function<Equilibrium::Evaluation()> &solve,
                    MomentumBalance<dim>                           &balance,
                    EnclosedContent                                &content,
                    const Equilibrium::Vector                      &u,
                    TimerOutput                                    &timer)
  {
    const MPI_Comm comm   = tissue.communicator();
    const double   wanted = content.target;
    double         error  = 0.;
    for (unsigned int i = 0; i < max_equilibria; ++i)
      {
        const Equilibrium::Evaluation evaluation = solve();
        const TimerOutput::Scope      section(timer, "lumen");
        const double                  V        = balance.enclosed_volume(u);
        const double                  pressure = content.pressure(V);
        if (!lumen.keeps_volume())
          return {evaluation, pressure};
        const DisplacementField<dim> displacement(space, u, comm);
        const double                 after =
          enclosed_volume(lumen_patches(lumen, tissue, &displacement), comm);
        error = after / wanted - 1.;
        if (std::abs(error) <= volume_tolerance)
          return {evaluation, pressure};
        // The pressure moves on, and the volume of the step, by which the
        // energy counts, is corrected by what that of the moved points has
        // more: doc/theory.md (4.8j).
        content.pressure_at_target = pressure;
        content.target             = wanted - (after - V);
        balance.use_growth_at_end();
      }
    std::ostringstream text;
    text << "the lumen does not get its volume: it still differs by " << error
         << " times " << wanted << (dim == 3 ? " um^3" : " um^2");
    throw StepFailed(text.str());
  }


#define INSTANTIATE(dim)                                                       \
  template std::optional<LumenMemory> lumen_at_start(const TissueModel<dim> &, \
                                                     const Tissue<dim> &);     \
  template std::optional<LumenState>  lumen_state(                             \
     const TissueModel<dim> &,                                                 \
     const Tissue<dim> &,                                                      \
     const std::optional<LumenMemory> &);                                      \
  template EnclosedContent  lumen_content(const Lumen<dim> &,                  \
                                          const LumenMemory &,                 \
                                          const double,                        \
                                          const double,                        \
                                          const double);                       \
  template LumenEquilibrium keep_lumen_volume(                                 \
    const Lumen<dim> &,                                                        \
    const Tissue<dim> &,                                                       \
    const SplineSpace<dim> &,                                                  \
    const std::function<Equilibrium::Evaluation()> &,                          \
    MomentumBalance<dim> &,                                                    \
    EnclosedContent &,                                                         \
    const Equilibrium::Vector &,                                               \
    TimerOutput &);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
