// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_area_term_h
#define morula_effects_surface_area_term_h

#include <morula/mechanics/point_term.h>

#include <vector>

namespace Morula
{
  /** A term of boundary points that depends on their current area and normal,
   *  a n = det f f⁻ᵀ a_t n_t (Nanson). */
  template <int dim>
  class AreaTerm : public PointTerm<dim>
  {
  public:
    /** What acts on a boundary point. */
    struct Load
    {
      /** What acts per area: a pressure in kPa, or a tension in kPa µm. */
      double value;
      /** a_t n_t, µm^(dim-1). */
      Tensor<1, dim> area;
    };

    AreaTerm(GroupedPoints<dim> points, std::vector<Load> loads);

  protected:
    /** The step at a boundary point. */
    struct Deformed
    {
      const SplineValues<dim> &splines;
      /** det f > 0. */
      double J;
      /** f⁻¹. */
      Tensor<2, dim> f_inverse;

      /** f⁻ᵀ ∇N of a spline, per µm. */
      Tensor<1, dim>
      gradient(const unsigned int a) const;
    };

    /** Adds the energy, residual and tangent that @p system asks for at a
     *  boundary point. */
    virtual void
    add_load(const Load       &load,
             const Deformed   &point,
             LocalSystem<dim> &system) const = 0;

  private:
    void
    add_point(const unsigned int       p,
              const SplineValues<dim> &splines,
              const LocalField<dim>   &field,
              LocalSystem<dim>        &system) const override;

    const std::vector<Load> loads;
  };
} // namespace Morula

#endif
