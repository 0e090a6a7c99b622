// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_enclosure_h
#define morula_mechanics_enclosure_h

#include <morula/mechanics/point_term.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace Morula
{
  /**
   * The volume that a space enclosed by boundary points gains in a step:
   * doc/theory.md (4.8h). Its "energy" is this volume (µm^dim), its "residual"
   * the first derivative (µm^(dim-1)), its "tangent" the second (µm^(dim-2)).
   * It is not itself a term of the momentum balance, which multiplies it by the
   * pressure of the content.
   */
  template <int dim>
  class SweptVolume : public PointTerm<dim>
  {
  public:
    /** @param areas a_t n_t of the points, out of the tissue and so into the
     *         space; µm^(dim-1) */
    SweptVolume(GroupedPoints<dim> points, std::vector<Tensor<1, dim>> areas)
      : PointTerm<dim>(std::move(points))
      , areas(std::move(areas))
    {}

  private:
    void
    add_point(const unsigned int       p,
              const SplineValues<dim> &splines,
              const LocalField<dim>   &field,
              LocalSystem<dim>        &system) const override;

    const std::vector<Tensor<1, dim>> areas;
  };

  /**
   * The content of an enclosed space. Its pressure at the volume V is
   * p = C/(V - V_f) + p_0 - κ (V - V*): a gas, beside which there may be a
   * fluid, or a content of given volume whose pressure p_0 is being sought:
   * doc/theory.md (4.8i).
   */
  struct EnclosedContent
  {
    /** C, the pressure of a gas times its volume; kPa µm^dim. */
    double gas = 0.;
    /** V_f, the volume of the fluid beside a gas, µm^dim. */
    double fluid = 0.;
    /** p_0, kPa. */
    double pressure_at_target = 0.;
    /** κ, kPa/µm^dim. */
    double stiffness_at_target = 0.;
    /** V*, µm^dim. */
    double target = 0.;

    /** p, kPa. */
    double
    pressure(const double V) const
    {
      return (gas != 0. ? gas / (V - fluid) : 0.) + pressure_at_target -
             stiffness_at_target * (V - target);
    }

    /** -dp/dV, kPa/µm^dim. */
    double
    stiffness(const double V) const
    {
      return (gas != 0. ? gas / ((V - fluid) * (V - fluid)) : 0.) +
             stiffness_at_target;
    }

    /** The energy -∫ p dV from the volume @p before on, kPa µm^dim; infinite if
     *  no volume is left. */
    double
    energy(const double V, const double before) const
    {
      if (!(V > fluid))
        return std::numeric_limits<double>::infinity();
      const double mean = 0.5 * (V + before);
      return (gas != 0. ? -gas * std::log((V - fluid) / (before - fluid)) :
                          0.) -
             (pressure_at_target - stiffness_at_target * (mean - target)) *
               (V - before);
    }
  };

  /** A space that boundary points enclose, and its content. */
  template <int dim>
  struct Enclosure
  {
    /** The volume that it gains in the step. */
    SweptVolume<dim> gain;
    /** Its volume at the beginning of the step, µm^dim. */
    double volume;
    /** Its content. */
    EnclosedContent content;
  };
} // namespace Morula

#endif
