// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/point_term.h>

#include <utility>

namespace Morula
{
  template <int dim>
  PointTerm<dim>::PointTerm(GroupedPoints<dim> points)
    : points(std::move(points))
  {}


  template <int dim>
  void
  PointTerm<dim>::add(const unsigned int     grid_cell,
                      const LocalField<dim> &field,
                      const GrowthAt,
                      LocalSystem<dim> &system) const
  {
    // A term that has met an inverted point needs no further ones: the state is
    // refused anyway.
    for (unsigned int p = points.offsets[grid_cell];
         p < points.offsets[grid_cell + 1] && !system.inverted;
         ++p)
      add_point(p, SplineValues<dim>(points.xi[p], points.h), field, system);
  }


  // A rigid translation moves all splines alike, so that a point's residual,
  // summed over them, is minus the force.
  template <int dim>
  std::vector<Tensor<1, dim>>
  PointTerm<dim>::forces(const unsigned int     grid_cell,
                         const LocalField<dim> &field) const
  {
    std::vector<Tensor<1, dim>> list;
    LocalSystem<dim>            system(LocalSystem<dim>::energy_and_residual);
    for (unsigned int p = points.offsets[grid_cell];
         p < points.offsets[grid_cell + 1];
         ++p)
      {
        system.clear();
        add_point(p, SplineValues<dim>(points.xi[p], points.h), field, system);
        Tensor<1, dim> force;
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
            force[i] -= system.residual[i * BSpline<dim>::n + a];
        list.push_back(force);
      }
    return list;
  }


  template <int dim>
  void
  add_force_at(const SplineValues<dim> &splines,
               const Tensor<1, dim>    &force,
               LocalSystem<dim>        &system)
  {
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
        system.add_force(i, a, force[i] * splines.value[a]);
  }


  template <int dim>
  void
  add_force_at(const SplineValues<dim> &splines,
               const double             energy,
               const Tensor<1, dim>    &force,
               const Tensor<2, dim>    &stiffness,
               LocalSystem<dim>        &system)
  {
    constexpr unsigned int n      = BSpline<dim>::n;
    constexpr unsigned int n_dofs = LocalSystem<dim>::n_dofs;
    // Energy and residual come together, the tangent alone: this is how
    // Newton's method asks.
    if (system.wanted != LocalSystem<dim>::tangent)
      {
        system.add_energy(energy);
        add_force_at(splines, force, system);
        return;
      }
    // The stiffness at the point times N_a N_b: row by row, contiguous in b.
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int j = 0; j < dim; ++j)
          {
            const double factor = stiffness[i][j] * splines.value[a];
            double      *row    = &system.matrix[(i * n + a) * n_dofs + j * n];
            for (unsigned int b = 0; b < n; ++b)
              row[b] += factor * splines.value[b];
          }
  }


#define INSTANTIATE(dim)                                \
  template class PointTerm<dim>;                        \
  template void add_force_at(const SplineValues<dim> &, \
                             const Tensor<1, dim> &,    \
                             LocalSystem<dim> &);       \
  template void add_force_at(const SplineValues<dim> &, \
                             const double,              \
                             const Tensor<1, dim> &,    \
                             const Tensor<2, dim> &,    \
                             LocalSystem<dim> &);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
