// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/forces/friction.h>
#include <morula/mechanics/point_term.h>
#include <morula/effects/scene_keys.h>

#include <utility>
#include <vector>

namespace Morula
{
  bool
  FrictionParameters::is_on() const
  {
    // A type of cells may set the key in its own section and leave the scene's
    // at its default.
    return coefficient.is_changed();
  }



  template <int dim>
  Friction<dim>::Friction(const Parameters         &parameters,
                          const EffectSetting<dim> &setting)
    : coefficient(setting.state.use(parameters.coefficient))
  {}


  template <int dim>
  std::unique_ptr<Term<dim>>
  Friction<dim>::term(const Tissue<dim>        &tissue,
                      const CellReader<dim>    &reader,
                      const GroupedPoints<dim> &positions,
                      const double              t0,
                      const double              t1) const
  {
    // The velocity of backward Euler's method is u/Δt, so that friction acts as
    // a spring of stiffness V⁰ ζ/Δt from where the cell is at the beginning of
    // the step: doc/theory.md (4.7a).
    std::vector<double> stiffnesses = friction(tissue, reader, t0);
    for (unsigned int p = 0; p < tissue.cells().size(); ++p)
      stiffnesses[p] *= tissue.cells().initial_volume(p) / (t1 - t0);
    return std::make_unique<Drag<dim>>(positions, std::move(stiffnesses));
  }


  template <int dim>
  std::vector<double>
  Friction<dim>::friction(const Tissue<dim>     &tissue,
                          const CellReader<dim> &reader,
                          const double           t0) const
  {
    // These values also tell the equilibrium which pieces friction holds: a
    // rigid motion against it is not taken out of the step.
    std::vector<double> list;
    for (unsigned int p = 0; p < tissue.cells().size(); ++p)
      list.push_back(*friction_of(present_cell(tissue, p, reader), t0));
    return list;
  }


  template <int dim>
  void
  Friction<dim>::check(const Preview<dim> &scene) const
  {
    if (coefficient.depends_on_state())
      return;
    // The end time is one sample: a coefficient that falls with time is
    // smallest there.
    for (const Point<dim> &X : scene.founders)
      coefficient.value(X, scene.keys.time.end_time);
  }


  template <int dim>
  void
  Friction<dim>::check_cell(const PresentCell<dim> &founder, const double) const
  {
    founder.value(coefficient, 0.);
  }


  template class Friction<2>;
  template class Friction<3>;
} // namespace Morula
