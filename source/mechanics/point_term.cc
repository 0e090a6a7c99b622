// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/point_term.h>
#include <morula/mechanics/spline_moments.h>

#include <utility>

namespace Morula
{


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


  template <int dim>
  void
  Drag<dim>::add(const unsigned int     grid_cell,
                 const LocalField<dim> &field,
                 const GrowthAt         growth,
                 LocalSystem<dim>      &system) const
  {
    // Energy and residual are sums over the cells, as for any point term.
    if (system.wanted != LocalSystem<dim>::tangent)
      {
        PointTerm<dim>::add(grid_cell, field, growth, system);
        return;
      }
    // The stiffness does not depend on u, so the moments of the cells in the
    // grid cell give the whole matrix: doc/theory.md (11.6). Entries cell by
    // cell would take far longer. All components have the same block.
    const GroupedPoints<dim> &cells = this->points;
    MassMoments<dim>          moments;
    for (unsigned int p = cells.offsets[grid_cell];
         p < cells.offsets[grid_cell + 1];
         ++p)
      moments.add(cells.xi[p], {{strength * stiffnesses[p]}});
    const std::vector<double> mass   = mass_matrix(moments);
    constexpr unsigned int    n      = BSpline<dim>::n;
    constexpr unsigned int    n_dofs = LocalSystem<dim>::n_dofs;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int a = 0; a < n; ++a)
        {
          double *const row = &system.matrix[(i * n + a) * n_dofs + i * n];
          for (unsigned int b = 0; b < n; ++b)
            row[b] += mass[a * n + b];
        }
  }


  template <int dim>
  void
  Drag<dim>::add_point(const unsigned int       p,
                       const SplineValues<dim> &splines,
                       const LocalField<dim>   &field,
                       LocalSystem<dim>        &system) const
  {
    Tensor<1, dim> u = field.value(splines);
    if (!centre.empty())
      u -= centre[p];
    const double k = strength * stiffnesses[p];
    system.add_energy(0.5 * k * u.norm_square());
    add_force_at(splines, k * u, system);
  }


  template class Drag<2>;
  template class Drag<3>;
} // namespace Morula
