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
  LumenPressure<dim>::LumenPressure(const Lumen<dim>           &lumen,
                                    const Tissue<dim>          &tissue,
                                    const SplineSpace<dim>     &space,
                                    const MomentumBalance<dim> &balance,
                                    EnclosedContent            &content,
                                    TimerOutput                &timer)
    : lumen(lumen)
    , tissue(tissue)
    , space(space)
    , balance(balance)
    , content(content)
    , timer(timer)
    , wanted(content.target)
  {}


  template <int dim>
  bool
  LumenPressure<dim>::renew(const Equilibrium::Vector &u)
  {
    const TimerOutput::Scope section(timer, "lumen");
    const MPI_Comm           comm = tissue.communicator();
    const double             V    = balance.enclosed_volume(u);
    pressure_                     = content.pressure(V);
    if (!lumen.keeps_volume())
      return false;
    const DisplacementField<dim> displacement(space, u, comm);
    const double                 after =
      enclosed_volume(lumen_patches(lumen, tissue, &displacement), comm);
    error = after / wanted - 1.;
    if (std::abs(error) <= volume_tolerance)
      return false;
    // The pressure moves on, and the volume of the step, by which the energy
    // counts, is corrected by what that of the moved points has more:
    // doc/theory.md (4.8j).
    content.pressure_at_target = pressure_;
    content.target             = wanted - (after - V);
    return true;
  }


  template <int dim>
  std::string
  LumenPressure<dim>::unfinished() const
  {
    std::ostringstream text;
    text << "the lumen does not get its volume: it still differs by " << error
         << " times " << wanted << (dim == 3 ? " um^3" : " um^2");
    return text.str();
  }


  template <int dim>
  double
  LumenPressure<dim>::pressure() const
  {
    return pressure_;
  }


#define INSTANTIATE(dim)                                                       \
  template std::optional<LumenMemory> lumen_at_start(const TissueModel<dim> &, \
                                                     const Tissue<dim> &);     \
  template std::optional<LumenState>  lumen_state(                             \
     const TissueModel<dim> &,                                                 \
     const Tissue<dim> &,                                                      \
     const std::optional<LumenMemory> &);                                      \
  template EnclosedContent lumen_content(const Lumen<dim> &,                   \
                                         const LumenMemory &,                  \
                                         const double,                         \
                                         const double,                         \
                                         const double);                        \
  template class LumenPressure<dim>;
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
