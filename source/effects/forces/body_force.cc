// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/forces/body_force.h>
#include <morula/effects/surface/dead_load.h>

#include <utility>
#include <vector>

namespace Morula
{
  BodyForceParameters::BodyForceParameters()
    : force_density("Body force/Force density",
                    "0; 0; 0",
                    "Force per initial volume: functions of X, Y, Z, t "
                    "separated by ';'. Units: kPa/um.",
                    Evaluated::place,
                    3)
  {}


  bool
  BodyForceParameters::is_on() const
  {
    return !force_density.is_default();
  }


  std::string
  BodyForceParameters::details() const
  {
    return force_density.text() + " kPa/um";
  }


  KeyList
  BodyForceParameters::list()
  {
    return {&force_density};
  }


  template <int dim>
  BodyForce<dim>::BodyForce(const Parameters &parameters)
    : density(parameters.force_density.expression(dim))
  {}


  template <int dim>
  std::unique_ptr<Term<dim>>
  BodyForce<dim>::term(const Tissue<dim>        &tissue,
                       const GroupedPoints<dim> &positions,
                       const double              t) const
  {
    const Cells<dim>           &cells = tissue.cells();
    std::vector<Tensor<1, dim>> forces;
    for (unsigned int p = 0; p < cells.size(); ++p)
      forces.push_back(cells.initial_volume(p) *
                       density.vector(cells.founder_position(p), t));
    return std::make_unique<DeadLoad<dim>>(positions, std::move(forces));
  }


  template <int dim>
  void
  BodyForce<dim>::check(const Preview<dim> &scene) const
  {
    for (const Point<dim> &X : scene.founders)
      for (const double t : {0., scene.end_time})
        density.vector(X, t);
  }


  template class BodyForce<2>;
  template class BodyForce<3>;
} // namespace Morula
