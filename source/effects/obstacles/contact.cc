// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/obstacles/contact.h>

#include <utility>

namespace Morula
{
  namespace
  {
    /** Adds the energy, residual or tangent of a force at a place. */
    template <int dim>
    void
    add_at(const SplineValues<dim> &splines,
           const double             energy,
           const Tensor<1, dim>    &force,
           const Tensor<2, dim>    &stiffness,
           LocalSystem<dim>        &system)
    {
      constexpr unsigned int n      = BSpline<dim>::n;
      constexpr unsigned int n_dofs = LocalSystem<dim>::n_dofs;
      if (system.wanted != LocalSystem<dim>::tangent)
        {
          system.add_energy(energy);
          for (unsigned int i = 0; i < dim; ++i)
            for (unsigned int a = 0; a < n; ++a)
              system.add_force(i, a, force[i] * splines.value[a]);
          return;
        }
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int a = 0; a < n; ++a)
          for (unsigned int j = 0; j < dim; ++j)
            {
              const double factor = stiffness[i][j] * splines.value[a];
              double      *row = &system.matrix[(i * n + a) * n_dofs + j * n];
              for (unsigned int b = 0; b < n; ++b)
                row[b] += factor * splines.value[b];
            }
    }
  } // namespace


  template <int dim>
  Contact<dim>::Contact(GroupedPoints<dim>         points,
                        std::vector<BoundaryPoint> boundary_points,
                        std::vector<Obstacle>      obstacles)
    : points(std::move(points))
    , boundary_points(std::move(boundary_points))
    , obstacles(std::move(obstacles))
  {}


  template <int dim>
  void
  Contact<dim>::add(const unsigned int     cell,
                    const LocalField<dim> &field,
                    const GrowthAt,
                    LocalSystem<dim> &system) const
  {
    for (unsigned int p = points.offsets[cell]; p < points.offsets[cell + 1];
         ++p)
      {
        const SplineValues<dim> splines(points.xi[p], points.h);
        const Point<dim>        x = boundary_points[p].x + field.value(splines);
        for (const Obstacle &obstacle : obstacles)
          {
            const Distance<dim> phi = obstacle.body->distance(x - obstacle.way);
            if (obstacle.is_mould ? phi.value <= 0. : phi.value >= 0.)
              continue;
            const double k = boundary_points[p].area * obstacle.stiffness;
            add_at(splines,
                   0.5 * k * phi.value * phi.value,
                   k * phi.value * phi.gradient,
                   k * (outer_product(phi.gradient, phi.gradient) +
                        phi.value * phi.curvature),
                   system);
          }
      }
  }


  template <int dim>
  Drag<dim>::Drag(GroupedPoints<dim>  cells,
                  std::vector<double> volumes,
                  const double        eta)
    : cells(std::move(cells))
    , volumes(std::move(volumes))
    , eta(eta)
  {}


  template <int dim>
  void
  Drag<dim>::add(const unsigned int     cell,
                 const LocalField<dim> &field,
                 const GrowthAt,
                 LocalSystem<dim> &system) const
  {
    for (unsigned int p = cells.offsets[cell]; p < cells.offsets[cell + 1]; ++p)
      {
        const SplineValues<dim> splines(cells.xi[p], cells.h);
        const Tensor<1, dim>    u = field.value(splines);
        const double            k = eta * volumes[p];
        add_at(splines,
               0.5 * k * u.norm_square(),
               k * u,
               k * Tensor<2, dim>(unit_symmetric_tensor<dim>()),
               system);
      }
  }


  template class Contact<2>;
  template class Contact<3>;
  template class Drag<2>;
  template class Drag<3>;
} // namespace Morula
