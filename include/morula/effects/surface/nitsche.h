// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_nitsche_h
#define morula_effects_surface_nitsche_h

#include <morula/mechanics/material_points.h>
#include <morula/mechanics/materials/material.h>
#include <morula/mechanics/plain_kernels.h>
#include <morula/mechanics/term.h>

#include <vector>

namespace Morula
{
  /** The sign of the traction's variation in Nitsche's term: doc/theory.md
   *  (4.4), (4.5). */
  enum class NitscheForm
  {
    /** Derived from an energy; stable for large penalties. */
    symmetric,
    /** The traction's variation with the other sign: no energy, but stable for
     *  any penalty. */
    unsymmetric,
    /** The traction is constant while an equilibrium is found, and renewed
     *  after it: BoundedNitsche. */
    bounded
  };

  /**
   * Prescribed positions of boundary points by Nitsche's method in total-gap
   * form, doc/theory.md (4.1), (4.2), (4.4):
   *
   *   R[δu] = Σ a_t ((β g - T)·δu ∓ g·DT[δu]), g = M (x_t + u - x̄),
   *
   * with T multiplied by the point's traction_fraction; M = I at fixed points
   * and N⊗N at slip points, and the nominal traction of the step's
   * configuration T = (W/V_t) τ f⁻ᵀ n_t. The upper sign is that of the
   * symmetric form, which has the energy Π = Σ a_t (β/2 g·g - T·g).
   */
  template <int dim>
  class Nitsche : public Term<dim>
  {
  public:
    /** How a boundary point is held. */
    struct HeldPoint
    {
      /** M. */
      Tensor<2, dim> projection;
      /** M (x_t - x̄), µm. */
      Tensor<1, dim> gap;
      /** max(|x_t|, |x̄|), µm: the size of the numbers whose difference is the
       *  gap. */
      double position_scale;
      /** n_t, unit outward normal of the configuration at t. */
      Tensor<1, dim> normal;
      /** a_t, µm^(dim-1). */
      double area;
      /** β, kPa/µm. */
      double penalty;
      /** Fraction of the traction that counts, 0 to 1. It is less than 1 if no
       *  cell is near the point, since its traction is extrapolated then. */
      double traction_fraction = 1.;
      Lame   lame;

      /** The gap that the displacement leaves, µm: doc/theory.md (4.1). */
      Tensor<1, dim>
      gap_with(const LocalField<dim>   &field,
               const SplineValues<dim> &splines) const
      {
        return gap + projection * field.value(splines);
      }
    };

    /**
     * Keeps a reference to the material.
     * @param part     part of the law that enters T
     * @param current  states with growth at t + dt
     * @param previous states with growth at t; empty if nothing grows
     * @param add_products what adds up the tangent
     */
    Nitsche(const NitscheForm              form,
            const Material                &material,
            const PartOfLaw                part,
            GroupedPoints<dim>             points,
            std::vector<HeldPoint>         held_points,
            std::vector<ElasticState<dim>> current,
            std::vector<ElasticState<dim>> previous,
            const AddProducts<dim> add_products = &add_products_plainly<dim>);

    void
    add(const unsigned int     cell,
        const LocalField<dim> &field,
        const GrowthAt         growth,
        LocalSystem<dim>      &system) const override;

    std::vector<Tensor<1, dim>>
    forces(const unsigned int     cell,
           const LocalField<dim> &field) const override;

    bool
    is_conservative() const override
    {
      return form == NitscheForm::symmetric;
    }

  private:
    const NitscheForm                    form;
    const Material                      &material;
    const PartOfLaw                      part;
    const GroupedPoints<dim>             points;
    const std::vector<HeldPoint>         held_points;
    const std::vector<ElasticState<dim>> current;
    const std::vector<ElasticState<dim>> previous;
    const AddProducts<dim>               add_products;
  };
} // namespace Morula

#endif
