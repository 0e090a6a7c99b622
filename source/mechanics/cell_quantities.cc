// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/cell_quantities.h>
#include <morula/mechanics/elastic_point.h>

namespace Morula
{
  namespace
  {
    /** The true σ also in plane strain: τ in the plane and τ_zz. */
    template <int dim>
    SymmetricTensor<2, 3>
    kirchhoff_stress(const ElasticPoint<dim> &state)
    {
      SymmetricTensor<2, 3>         full;
      const SymmetricTensor<2, dim> tau = state.kirchhoff_stress();
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = i; j < dim; ++j)
          full[i][j] = tau[i][j];
      full[2][2] = state.kirchhoff_stress_zz();
      return full;
    }
  } // namespace

  template <int dim>
  CellQuantities
  cell_quantities(const CellView<dim, const double> &cell,
                  const Material                    &material,
                  const Lame                        &lame,
                  const bool                         per_grown_volume)
  {
    const Tensor<2, dim>    F     = cell.F();
    const Tensor<2, dim>    F_g   = cell.growth();
    const double            det_F = determinant(F);
    const ElasticPoint<dim> state(F * invert(F_g), lame, material);

    CellQuantities q;
    q.initial_volume       = cell.initial_volume();
    q.volume               = q.initial_volume * det_F;
    q.growth_volume_ratio  = determinant(F_g);
    q.elastic_volume_ratio = state.strain().J;
    q.energy_density       = state.energy();
    q.stress               = kirchhoff_stress(state) *
               ((per_grown_volume ? q.growth_volume_ratio : 1.) / det_F);
    return q;
  }

  template CellQuantities
  cell_quantities<2>(const CellView<2, const double> &,
                     const Material &,
                     const Lame &,
                     const bool);
  template CellQuantities
  cell_quantities<3>(const CellView<3, const double> &,
                     const Material &,
                     const Lame &,
                     const bool);
} // namespace Morula
