// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/forces/placed_force.h>

#include <utility>

namespace Morula
{
  namespace
  {
    /** Difference of places by which b is differentiated, in grid spacings. */
    constexpr double part_of_spacing = 1e-5;

    constexpr Variable coordinates[] = {Variable::x, Variable::y, Variable::z};
  } // namespace


  template <int dim>
  PlacedForce<dim>::PlacedForce(GroupedPoints<dim>    points,
                                std::vector<Particle> particles,
                                const Expression     &density)
    : PointTerm<dim>(std::move(points))
    , particles(std::move(particles))
    , density(density)
  {}


  template <int dim>
  bool
  PlacedForce<dim>::depends_on_place(const Expression &expression)
  {
    for (const Variable place : coordinates)
      if (expression.uses(place))
        return true;
    return false;
  }


  template <int dim>
  Tensor<1, dim>
  PlacedForce<dim>::density_at(const Particle   &particle,
                               const Point<dim> &x) const
  {
    VariableValues values = particle.values;
    for (unsigned int d = 0; d < dim; ++d)
      values[static_cast<unsigned int>(coordinates[d])] = x[d];
    Tensor<1, dim> b;
    for (unsigned int d = 0; d < dim; ++d)
      b[d] = density.value(values, d);
    return b;
  }


  template <int dim>
  void
  PlacedForce<dim>::add_point(const unsigned int       p,
                              const SplineValues<dim> &splines,
                              const LocalField<dim>   &field,
                              LocalSystem<dim>        &system) const
  {
    const Particle  &particle = particles[p];
    const Point<dim> x        = particle.x + field.value(splines);
    Tensor<1, dim>   force;
    Tensor<2, dim>   stiffness;
    if (system.wanted != LocalSystem<dim>::tangent)
      force = -particle.volume * density_at(particle, x);
    else
      for (unsigned int j = 0; j < dim; ++j)
        {
          const double delta = part_of_spacing * this->points.h;
          Point<dim>   before(x), behind(x);
          before[j] -= delta;
          behind[j] += delta;
          const Tensor<1, dim> change =
            -particle.volume / (2. * delta) *
            (density_at(particle, behind) - density_at(particle, before));
          for (unsigned int i = 0; i < dim; ++i)
            stiffness[i][j] = change[i];
        }
    add_force_at(splines, 0., force, stiffness, system);
  }


  template class PlacedForce<2>;
  template class PlacedForce<3>;
} // namespace Morula
