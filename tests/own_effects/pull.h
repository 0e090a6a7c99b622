// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// A force on the cells.

#ifndef own_effects_pull_h
#define own_effects_pull_h

#include <morula/base/expression_key.h>
#include <morula/effects/forces/force.h>
#include <morula/effects/surface/loads.h>

namespace Own
{
  using namespace Morula;

  struct PullKeys : public EffectKeys
  {
    ExpressionKey density{{this, "Density"},
                          "0; 0; 0",
                          "Force per initial volume. Units: kPa/um.",
                          Evaluated::step,
                          3};

    bool
    is_on() const override
    {
      return !density.is_default();
    }
  };

  template <int dim>
  class Pull : public Force<dim>
  {
  public:
    using Parameters = PullKeys;

    Pull(const Parameters &parameters, const EffectSetting<dim> &setting)
      : density(setting.state.use(parameters.density))
    {}

    std::unique_ptr<Term<dim>>
    term(const Tissue<dim>        &tissue,
         const CellReader<dim>    &reader,
         const GroupedPoints<dim> &positions,
         const double,
         const double t1) const override
    {
      std::vector<Tensor<1, dim>> forces;
      for (unsigned int p = 0; p < tissue.cells().size(); ++p)
        {
          const auto cell = present_cell(tissue, p, reader);
          forces.push_back(cell.cell().initial_volume() *
                           cell.vector(density, t1));
        }
      return std::make_unique<DeadLoad<dim>>(positions, std::move(forces));
    }

    void
    check_cell(const PresentCell<dim> &founder, const double) const override
    {
      founder.vector(density, 0.);
    }

  private:
    const Expression density;
  };
} // namespace Own

#endif
