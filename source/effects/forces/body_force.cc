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
                    "Force per initial volume: an expression for each "
                    "direction, separated by ';'. Units: kPa/um.",
                    Evaluated::step,
                    3)
  {}


  bool
  BodyForceParameters::is_on() const
  {
    return !force_density.is_default() || force_density.differs_by_type();
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
  BodyForce<dim>::BodyForce(const Parameters         &parameters,
                            const EffectSetting<dim> &setting)
    : density(setting.state.use(parameters.force_density))
  {}


  template <int dim>
  std::unique_ptr<Term<dim>>
  BodyForce<dim>::term(const Tissue<dim>        &tissue,
                       const CellReader<dim>    &reader,
                       const GroupedPoints<dim> &positions,
                       const double,
                       const double t1) const
  {
    // The force on cell p is V⁰ b, doc/theory.md (4.7). The state of the cell
    // is that of the beginning of the step, but the time is that of its end, as
    // the equilibrium is sought there. The load is dead: it does not change
    // with u.
    const Cells<dim>           &cells = tissue.cells();
    std::vector<Tensor<1, dim>> forces;
    for (unsigned int p = 0; p < cells.size(); ++p)
      forces.push_back(cells.initial_volume(p) *
                       present_cell(tissue, p, reader).vector(density, t1));
    return std::make_unique<DeadLoad<dim>>(positions, std::move(forces));
  }


  template <int dim>
  void
  BodyForce<dim>::check(const Preview<dim> &scene) const
  {
    // An expression of the cells' state has no value before there are cells;
    // check_cell() evaluates it for each founder.
    if (density.depends_on_state())
      return;
    for (const Point<dim> &X : scene.founders)
      // An expression of place and time has a value at both ends of the run, or
      // throws here.
      for (const double t : {0., scene.end_time})
        density.vector(X, t);
  }


  template <int dim>
  void
  BodyForce<dim>::check_cell(const PresentCell<dim> &founder,
                             const double) const
  {
    founder.vector(density, 0.);
  }


  template class BodyForce<2>;
  template class BodyForce<3>;
} // namespace Morula
