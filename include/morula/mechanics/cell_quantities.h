// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_cell_quantities_h
#define morula_mechanics_cell_quantities_h

#include <morula/mechanics/material.h>
#include <morula/particles/cell_state.h>

#include <deal.II/base/symmetric_tensor.h>

namespace Morula
{
  using namespace dealii;

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
