// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_lumen_pressure_h
#define morula_effects_surface_lumen_pressure_h

#include <morula/effects/part_of_step.h>
#include <morula/effects/surface/lumen.h>
#include <morula/mechanics/spline_field.h>

#include <string>
#include <vector>

namespace Morula
{
  /** The patches of this rank around the lumen; after the step with this
   *  displacement if there is one. */
  template <int dim>
  std::vector<LumenPatch<dim>>
  lumen_patches(const Lumen<dim>             &lumen,
                const Tissue<dim>            &tissue,
                const DisplacementField<dim> *displacement = nullptr);

  /**
   * The content of a lumen in a step. Seeks the pressure of one that keeps its
   * volume, turn by turn. If a gas fills it, one turn is enough: doc/theory.md
   * (4.8j). Keeps references to all that it is given.
   */
  template <int dim>
  class LumenPressure : public PartOfStep<dim>
  {
  public:
    /** Collective. @throws InputError */
    LumenPressure(const Lumen<dim> &lumen, const AttemptAtStep<dim> &attempt);

    Enclosure<dim> *
    enclosure() override
    {
      return &space;
    }

    void
    begin(MomentumBalance<dim> &balance, const Equilibrium::Vector &u) override;

    bool
    renew(const Equilibrium::Vector &u) override;

    std::string
    unfinished() const override;

    bool
    is_exact() const override
    {
      return true;
    }

    std::optional<ForceOnPoints<dim>>
    force() const override;

    void
    keep(NamedNumbers &numbers) const override;

  private:
    const Lumen<dim>           &lumen;
    const AttemptAtStep<dim>   &attempt;
    Enclosure<dim>              space;
    double                      wanted; // volume, µm^dim
    const MomentumBalance<dim> *balance  = nullptr;
    double                      pressure = 0.; // at the last equilibrium, kPa
    double                      error    = 0.; // of the volume, relative
  };
} // namespace Morula

#endif
