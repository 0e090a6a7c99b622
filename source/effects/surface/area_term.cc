// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/surface/area_term.h>

#include <utility>

namespace Morula
{
  template <int dim>
  AreaTerm<dim>::AreaTerm(GroupedPoints<dim> points, std::vector<Load> loads)
    : PointTerm<dim>(std::move(points))
    , loads(std::move(loads))
  {}


  template <int dim>
  Tensor<1, dim>
  AreaTerm<dim>::Deformed::gradient(const unsigned int a) const
  {
    // This is g_a = f⁻ᵀ ∇N_a, in the trial configuration.
    Tensor<1, dim> g;
    for (unsigned int k = 0; k < dim; ++k)
      for (unsigned int j = 0; j < dim; ++j)
        g[j] += f_inverse[k][j] * splines.gradient[k][a];
    return g;
  }


  template <int dim>
  void
  AreaTerm<dim>::add_point(const unsigned int       p,
                           const SplineValues<dim> &splines,
                           const LocalField<dim>   &field,
                           LocalSystem<dim>        &system) const
  {
    // A point whose step turns it inside out has no area, so the state has no
    // energy.
    const Tensor<2, dim> f = field.step_deformation(splines);
    const double         J = determinant(f);
    if (J <= 0.)
      system.inverted = true;
    else
      add_load(loads[p], {splines, J, invert(f)}, system);
  }


  template class AreaTerm<2>;
  template class AreaTerm<3>;
} // namespace Morula
