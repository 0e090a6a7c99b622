// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_elastic_point_h
#define morula_mechanics_elastic_point_h

#include <morula/mechanics/material.h>
#include <morula/mechanics/materials/material.h>
#include <morula/particles/cell_state.h>

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <cmath>

namespace Morula
{
  using namespace dealii;

  /** A material's energy, stress and tangent at one point: doc/theory.md,
   *  sections 1.4 and 2.3. In 2-D (plane strain) with F_e,zz = 1. */
  template <int dim>
  class ElasticPoint
  {
  public:
    /**
     * @param F_e   elastic part of the deformation gradient, det F_e > 0
     * @param theta ln J_e of its pool if volumes are pooled
     */
    ElasticPoint(const Tensor<2, dim> &F_e,
                 const Lame           &lame,
                 const Material       &material,
                 const double         *theta = nullptr)
      : b_(symmetrize(F_e * transpose(F_e)))
      , strain_(strain(trace(b_), determinant(F_e), lame, theta))
      , response_(material.response(strain_))
    {}

    /** b_e = F_e F_eᵀ. */
    const SymmetricTensor<2, dim> &
    b() const
    {
      return b_;
    }

    /** The law's input: tr b_e, J_e and the rest. */
    const Strain<double> &
    strain() const
    {
      return strain_;
    }

    /** The law's response. */
    const CoupledResponse<double> &
    response() const
    {
      return response_;
    }

    /** Ψ, kPa. */
    double
    energy() const
    {
      return volumetric(response_.volumetric.energy) + response_.energy;
    }

    /** Size of the numbers whose difference is Ψ, for its rounding error, kPa.
     */
    double
    energy_magnitude() const
    {
      return volumetric(response_.volumetric.magnitude) + response_.magnitude;
    }

    /** The part of the Kirchhoff stress τ in the plane (3-D: all of it), kPa.
     */
    SymmetricTensor<2, dim>
    kirchhoff_stress() const
    {
      return stress(response_.total_gamma());
    }

    /** τ without the volumetric part of the law, kPa. */
    SymmetricTensor<2, dim>
    distortional_stress() const
    {
      return stress(response_.gamma);
    }

    /** τ_zz, also in plane strain, kPa. */
    double
    kirchhoff_stress_zz() const
    {
      return dim == 3 ? kirchhoff_stress()[dim - 1][dim - 1] :
                        response_.total_gamma();
    }

    /** The stiffness of a stretch along the unit vector @p n: doc/theory.md
     *  (4.6), for W / V_t = 1, kPa. */
    double
    stiffness(const Tensor<1, dim> &n) const
    {
      const double nbn = n * (b_ * n);
      return response_.total_A() + (response_.alpha - response_.total_gamma()) +
             response_.alpha * nbn +
             (2. * response_.B + response_.C * nbn) * nbn;
    }

  private:
    /** @param trace_b in the plane (3-D: all of it) */
    static Strain<double>
    strain(const double  trace_b,
           const double  J,
           const Lame   &lame,
           const double *theta)
    {
      const double log_J = std::log(J);
      return {trace_b - dim,
              trace_b + dim,
              J,
              log_J,
              theta == nullptr ? log_J : *theta,
              lame.lambda,
              lame.mu};
    }

    double
    volumetric(const double U) const
    {
      return response_.volumetric.modulus * U;
    }

    /** α (b_e - I) + γ I. */
    SymmetricTensor<2, dim>
    stress(const double gamma) const
    {
      const auto I = unit_symmetric_tensor<dim>();
      return response_.alpha * (b_ - I) + gamma * I;
    }

    SymmetricTensor<2, dim> b_;
    Strain<double>          strain_;
    CoupledResponse<double> response_;
  };

  /** What the state of a cell says of its volumes and its energy. */
  struct CellScalars
  {
    /** V⁰, µm^dim. */
    double initial_volume;
    /** V = V⁰ det F, µm^dim. */
    double volume;
    /** det F_g. */
    double growth_volume_ratio;
    /** J_e. */
    double elastic_volume_ratio;
    /** Ψ of equation (14), kPa. */
    double energy_density;
  };

  /** What the state of a cell says of its mechanics. */
  struct CellQuantities : public CellScalars
  {
    /**
     * Cauchy stress σ = W τ / V, kPa, where W is V⁰ or, per grown volume,
     * V⁰ det F_g. In 2-D with the σ_zz of plane strain.
     */
    SymmetricTensor<2, 3> stress;
  };

  /** The scalars of a cell, without the stress, at half the cost. */
  template <int dim>
  CellScalars
  cell_scalars(const CellView<dim, const double> &cell,
               const Material                    &material,
               const Lame                        &lame);

  /** All quantities of a cell. */
  template <int dim>
  CellQuantities
  cell_quantities(const CellView<dim, const double> &cell,
                  const Material                    &material,
                  const Lame                        &lame,
                  const bool                         per_grown_volume);
} // namespace Morula

#endif
