// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/forces/body_force.h>
#include <morula/effects/forces/placed_force.h>
#include <morula/effects/scene_keys.h>
#include <morula/effects/surface/dead_load.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace Morula
{
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
    // the equilibrium is sought there. A force that depends on the place acts
    // where the cell comes to stand; all others are dead loads.
    const Cells<dim> &cells = tissue.cells();
    if (PlacedForce<dim>::depends_on_place(density))
      {
        std::vector<typename PlacedForce<dim>::Particle> particles;
        for (unsigned int p = 0; p < cells.size(); ++p)
          particles.push_back(
            {cells.position(p),
             cells.initial_volume(p),
             present_cell(tissue, p, reader).variables(density, t1)});
        return std::make_unique<PlacedForce<dim>>(positions,
                                                  std::move(particles),
                                                  density);
      }
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
      for (const double t : {0., scene.keys.time.end_time.value()})
        density.vector(X, t);
  }


  template <int dim>
  void
  BodyForce<dim>::check_cell(const PresentCell<dim> &founder,
                             const double) const
  {
    founder.vector(density, 0.);
  }


  template <int dim>
  void
  BodyForce<dim>::review(const Preview<dim> &scene, Review &review) const
  {
    const std::vector<Variable> &used = density.used();
    const bool lags = std::any_of(used.begin(), used.end(), [](const auto v) {
      return is_field(v) || v == Variable::volume || v == Variable::growth ||
             v == Variable::J_e || v == Variable::pressure ||
             v == Variable::tension || v == Variable::shear ||
             v == Variable::energy;
    });
    if (lags)
      review.warn(density.key(),
                  density.text(),
                  "a force takes the state of its cell, but its place, from "
                  "the beginning of each step: it is late by Time/Step = " +
                    as_text(scene.keys.time.step) +
                    " day, and may swing where it changes that state much in "
                    "a step.",
                  "Repeat the run with half the step, and compare.");
  }


  template class BodyForce<2>;
  template class BodyForce<3>;
} // namespace Morula
