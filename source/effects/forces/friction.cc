// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/forces/friction.h>
#include <morula/mechanics/drag.h>

#include <utility>
#include <vector>

namespace Morula
{
  FrictionParameters::FrictionParameters()
    : coefficient("Friction/Coefficient",
                  "0",
                  "Force per initial volume against a cell's velocity, over "
                  "that velocity: friction with what surrounds the tissue and "
                  "stands still. An expression. Units: kPa day/um^2.",
                  Evaluated::step)
  {
    coefficient.positive("kPa day/um^2",
                         "Where there is hardly any friction a small number "
                         "does, such as 1e-12; a scene without the key has "
                         "none.");
  }


  bool
  FrictionParameters::is_on() const
  {
    return !coefficient.is_default() || coefficient.differs_by_type();
  }


  std::string
  FrictionParameters::details() const
  {
    return coefficient.text() + " kPa day/um^2";
  }


  KeyList
  FrictionParameters::list()
  {
    return {&coefficient};
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
    const Cells<dim>   &cells = tissue.cells();
    std::vector<double> stiffnesses;
    for (unsigned int p = 0; p < cells.size(); ++p)
      stiffnesses.push_back(
        cells.initial_volume(p) *
        present_cell(tissue, p, reader).value(coefficient, t1) / (t1 - t0));
    return std::make_unique<Drag<dim>>(positions, std::move(stiffnesses));
  }


  template <int dim>
  bool
  Friction<dim>::resists_motion() const
  {
    return true;
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
