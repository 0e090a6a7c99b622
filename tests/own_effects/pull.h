// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// A force on the cells.

#ifndef own_effects_pull_h
#define own_effects_pull_h

#include <morula/base/expression_key.h>
#include <morula/effects/forces/force.h>
#include <morula/effects/surface/dead_load.h>

namespace Own
{
  using namespace Morula;

  struct PullKeys : public EffectKeys
  {
    ExpressionKey density{"Density",
                          "0; 0; 0",
                          "Force per initial volume. Units: kPa/um.",
                          Evaluated::place,
                          3};

    bool
    is_on() const override
    {
      return !density.is_default();
    }

    using Keys::list;
    KeyList
    list() override
    {
      return {&density};
    }
  };

  template <int dim>
  class Pull : public Force<dim>
  {
  public:
    using Parameters = PullKeys;

    explicit Pull(const Parameters &parameters)
      : density(parameters.density.expression(dim))
    {}

    std::unique_ptr<Term<dim>>
    term(const Tissue<dim>        &tissue,
         const GroupedPoints<dim> &positions,
         const double              t) const override
    {
      std::vector<Tensor<1, dim>> forces;
      for (unsigned int p = 0; p < tissue.cells().size(); ++p)
        {
          const auto cell = tissue.cells()[p];
          forces.push_back(cell.initial_volume() *
                           density.vector(cell.founder_position(), t));
        }
      return std::make_unique<DeadLoad<dim>>(positions, std::move(forces));
    }

  private:
    const Expression density;
  };
} // namespace Own

#endif
