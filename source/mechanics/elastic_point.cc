// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
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
      // In 2-D the tensor gets the third direction, in which plane strain has a
      // stress, too.
      SymmetricTensor<2, 3>         full;
      const SymmetricTensor<2, dim> tau = state.kirchhoff_stress();
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = i; j < dim; ++j)
          full[i][j] = tau[i][j];
      full[2][2] = state.kirchhoff_stress_zz();
      return full;
    }

    /** A cell's deformations and what its material says to them. */
    template <int dim>
    struct State
    {
      State(const CellView<dim, const double> &cell,
            const Material                    &material,
            const Lame                        &lame)
        : F(cell.F())
        , F_g(cell.growth())
        , smoothing(cell.smoothing())
        , point(F * invert(F_g), lame, material)
      {}

      const Tensor<2, dim>    F, F_g;
      const double            smoothing;
      const ElasticPoint<dim> point;

      CellScalars
      scalars(const double initial_volume) const
      {
        CellScalars q;
        q.initial_volume       = initial_volume;
        q.volume               = initial_volume * determinant(F);
        q.growth_volume_ratio  = determinant(F_g);
        q.elastic_volume_ratio = point.strain().J * smoothing;
        q.energy_density       = point.energy();
        return q;
      }
    };
  } // namespace

  template <int dim>
  CellScalars
  cell_scalars(const CellView<dim, const double> &cell,
               const Material                    &material,
               const Lame                        &lame)
  {
    return State<dim>(cell, material, lame).scalars(cell.initial_volume());
  }

  template <int dim>
  CellQuantities
  cell_quantities(const CellView<dim, const double> &cell,
                  const Material                    &material,
                  const Lame                        &lame,
                  const bool                         per_grown_volume)
  {
    const State<dim> state(cell, material, lame);
    CellQuantities   q;
    static_cast<CellScalars &>(q) = state.scalars(cell.initial_volume());
    // σ = W τ / V with V = V⁰ det F: V⁰ cancels, so that W/V is 1/det F or det
    // F_g/det F (doc/theory.md, section 1.5). Where volumes are pooled it is
    // that of the smoothed F_e, doc/theory.md (2.10).
    const double stretch = std::pow(state.smoothing, 1. / dim);
    q.stress             = kirchhoff_stress(
                 stretch == 1. ?
                   state.point :
                   ElasticPoint<dim>(stretch * (state.F * invert(state.F_g)),
                                     lame,
                                     material)) *
               ((per_grown_volume ? q.growth_volume_ratio : 1.) /
                (determinant(state.F) * state.smoothing));
    return q;
  }

  MORULA_INSTANTIATE(cell_scalars);
  MORULA_INSTANTIATE(cell_quantities);
} // namespace Morula
