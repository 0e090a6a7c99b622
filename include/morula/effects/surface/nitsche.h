// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_nitsche_h
#define morula_effects_surface_nitsche_h

#include <morula/base/key.h>
#include <morula/base/review.h>
#include <morula/mechanics/material.h>
#include <morula/mechanics/material_points.h>
#include <morula/mechanics/materials/material.h>
#include <morula/mechanics/plain_kernels.h>
#include <morula/mechanics/point_term.h>
#include <morula/mechanics/term.h>

#include <memory>
#include <string>
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
     *  after it: bounded_nitsche(). */
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
            const AddProducts<dim> add_products = &add_products_plainly<dim>)
      : form(form)
      , material(material)
      , part(part)
      , points(std::move(points))
      , held_points(std::move(held_points))
      , current(std::move(current))
      , previous(std::move(previous))
      , add_products(add_products)
    {}

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

  /**
   * Prescribed positions of boundary points by Nitsche's method with a traction
   * that does not change while an equilibrium is found, doc/theory.md (4.6a):
   *
   *   Π = Σ a_t [β/2 g·g (1 + (|g|/g₀)⁴/3) - T·g], g = M (x_t + u - x̄),
   *
   * and grows quadratically with |g| beyond g₀.
   * It is a convex function of u with a lower bound, whatever T and the
   * deformation of the point. Who owns T takes it anew at the equilibrium that
   * was found, and has another one found from there. g₀ is a fifth of the grid
   * spacing: far smaller gaps meet the penalty β alone, larger ones up to six
   * times as much, so that tissue does not slip through a clamp that is soft at
   * its edge, while one that moves far still has a force that is linear.
   * @param tractions M T of the points, kPa; a reference is kept
   */
  template <int dim>
  std::unique_ptr<Term<dim>>
  bounded_nitsche(GroupedPoints<dim>                            points,
                  std::vector<typename Nitsche<dim>::HeldPoint> held_points,
                  const std::vector<Tensor<1, dim>>            &tractions);

  /** The keys of Nitsche's term, in section "Boundary conditions". */
  struct NitscheParameters : public Keys
  {
    NitscheParameters()
    {
      penalty.with("paper", "1000");
      form.with("paper", "symmetric");
      for (AnyKey *const key : list())
        key->needs(held_by());
    }

    /** Least penalty of the forms with an energy, (λ + 2μ)/h. */
    static constexpr double least_penalty = 20.;

    Key<double> penalty{
      {this, "Boundary conditions/Nitsche penalty"},
      20.,
      "Penalty of fixed and slip points; > 0. "
      "The symmetric and the bounded form use at least " +
        as_text(least_penalty) + " (lambda + 2 mu)/h. Units: E/h.",
      {},
      positive("E/h",
               "1e3 is a good choice for the symmetric Nitsche form, 20 "
               "for the others.")};

    Key<std::string> form{
      {this, "Boundary conditions/Nitsche form"},
      "bounded",
      "symmetric: the paper's, for large penalties. unsymmetric: stable for "
      "any penalty, but without an energy. bounded: the traction of fixed "
      "and slip points comes from the cells around them, is constant in a "
      "solve and updated after it; its energy has a lower bound, and with "
      "Nitsche penalty = 20 it is much more accurate beside the edge of a "
      "fixed surface.",
      {"symmetric|unsymmetric|bounded"}};

    /** Which of Nitsche's terms. */
    NitscheForm
    kind() const
    {
      return form == "symmetric"   ? NitscheForm::symmetric :
             form == "unsymmetric" ? NitscheForm::unsymmetric :
                                     NitscheForm::bounded;
    }

    /** Nitsche's penalty β, kPa/µm, for a point with Young's modulus @p E,
     *  Lamé constants @p lame and the @p stiffness that it has now (kPa) on a
     *  grid of spacing @p h (µm): doc/theory.md (4.6). */
    double
    beta(const double           E,
         const Lame            &lame,
         const double           stiffness,
         const VolumetricStrain volumetric_form,
         const double           h) const;

    /** Full paths of the keys that hold points. */
    static std::vector<std::string>
    held_by()
    {
      return {"Boundary conditions/Fixed where",
              "Boundary conditions/Slip where"};
    }

    /** Warns of penalties that are too low if @p all_is_fixed (all of the
     *  surface). For scenes that hold points. */
    void
    review(const bool all_is_fixed, Review &review) const;
  };
} // namespace Morula

#endif
