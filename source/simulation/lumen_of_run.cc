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
    /** The relative error of the lumen's volume at which turns end. What is
     * left after a turn also depends on Solver/Newton tolerance. */
    constexpr double volume_tolerance = 1e-8;

    /** Compression modulus of the content whose pressure is being found, over
     *  Young's modulus of the tissue: doc/theory.md (4.8j). */
    constexpr double relative_modulus = 100.;
  } // namespace


  void
  keep_lumen(const LumenMemory &lumen, NamedNumbers &kept)
  {
    kept["lumen_at_start"] = lumen.volume_at_start;
    kept["lumen_pressure"] = lumen.pressure;
  }


  template <int dim>
  void
  begin_lumen(const TissueModel<dim> &model,
              const Tissue<dim>      &tissue,
              NamedNumbers           &kept)
  {
    // The first pressure of a lumen that keeps its volume is a guess, 0, from
    // which the turns of the first step begin; that of a gas is given.
    const Lumen<dim> *lumen = model.boundary_conditions.lumen();
    if (lumen != nullptr)
      keep_lumen({enclosed_volume(lumen_patches(*lumen, tissue),
                                  tissue.communicator()),
                  lumen->keeps_volume() ? 0. : lumen->pressure(0.)},
                 kept);
  }


  template <int dim>
  std::optional<LumenMemory>
  saved_lumen(const TissueModel<dim> &model, const NamedNumbers &kept)
  {
    if (model.boundary_conditions.lumen() == nullptr)
      return {};
    return LumenMemory{kept.at("lumen_at_start"), kept.at("lumen_pressure")};
  }


  template <int dim>
  void
  describe_lumen(const TissueModel<dim> &model,
                 const Tissue<dim>      &tissue,
                 const NamedNumbers     &kept,
                 NamedNumbers           &columns)
  {
    const auto memory = saved_lumen(model, kept);
    if (!memory)
      return;
    columns["lumen_volume"] =
      enclosed_volume(lumen_patches(*model.boundary_conditions.lumen(), tissue),
                      tissue.communicator());
    columns["lumen_pressure"] = memory->pressure;
  }


  template <int dim>
  EnclosedContent
  lumen_content(const Lumen<dim>  &lumen,
                const LumenMemory &memory,
                const double       t_next,
                const double       volume,
                const double       typical_stiffness)
  {
    // A gas has p = p₀V₀/V, which needs only the product. Where the volume is
    // given the content is that of a compressible fluid, doc/theory.md (4.8j),
    // which begins with the pressure of the step before: a good guess saves
    // turns.
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
    // Two volumes are at hand: V, which the energy of the step counts, and that
    // of the moved points (4.8g), which has to be the wanted one. Both are sums
    // over all ranks. A gas needs no second turn, as its pressure follows from
    // V at once.
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
    // The next turn begins at the pressure of this one. Its target is a volume
    // V, so that the difference between the two volumes is taken off what is
    // wanted: doc/theory.md (4.8j).
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
  template void                       begin_lumen(const TissueModel<dim> &,    \
                                                  const Tissue<dim> &,         \
                                                  NamedNumbers &);             \
  template std::optional<LumenMemory> saved_lumen(const TissueModel<dim> &,    \
                                                  const NamedNumbers &);       \
  template void                       describe_lumen(const TissueModel<dim> &, \
                                                     const Tissue<dim> &,      \
                                                     const NamedNumbers &,     \
                                                     NamedNumbers &);          \
  template EnclosedContent            lumen_content(const Lumen<dim> &,        \
                                                    const LumenMemory &,       \
                                                    const double,              \
                                                    const double,              \
                                                    const double);             \
  template class LumenPressure<dim>;
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
