// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// A condition on the surface that loads it.

#ifndef own_effects_drag_h
#define own_effects_drag_h

#include <morula/effects/surface/loads.h>
#include <morula/effects/surface/placed_condition.h>

namespace Own
{
  using namespace Morula;

  struct DragKeys : public ConditionKeys
  {
    DragKeys()
      : ConditionKeys("Where", "Where it acts; empty: nowhere.")
    {}

    ExpressionKey load{{this, "Load"},
                       "0; 0; 0",
                       "Force per initial area. Units: kPa.",
                       Evaluated::place,
                       3};
  };

  template <int dim>
  class Drag : public PlacedCondition<dim>
  {
  public:
    using Parameters = DragKeys;

    explicit Drag(const Parameters &parameters)
      : PlacedCondition<dim>(SurfaceCondition::loaded, parameters)
      , load(parameters.load.expression(dim))
    {}

    std::unique_ptr<Term<dim>>
    term(const LoadedPoints<dim> &points, const double t) const override
    {
      return std::make_unique<DeadLoad<dim>>(
        points,
        this->template loads<Tensor<1, dim>>(points, [&](const auto &point) {
          return point.initial_area * load.vector(point.X, t);
        }));
    }

  private:
    const Expression load;
  };
} // namespace Own

#endif
