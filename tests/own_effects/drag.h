// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// A condition on the surface that loads it.

#ifndef own_effects_drag_h
#define own_effects_drag_h

#include <morula/effects/surface/boundary_condition.h>
#include <morula/effects/surface/condition_keys.h>
#include <morula/effects/surface/dead_load.h>

namespace Own
{
  using namespace Morula;

  struct DragKeys : public ConditionKeys
  {
    DragKeys()
      : ConditionKeys("Where", "Where it acts; empty: nowhere.")
    {}

    ExpressionKey load{"Load",
                       "0; 0; 0",
                       "Force per initial area. Units: kPa.",
                       Evaluated::place,
                       3};

    using Keys::list;
    KeyList
    list() override
    {
      return {&where, &load};
    }
  };

  template <int dim>
  class Drag : public BoundaryCondition<dim>
  {
  public:
    using Parameters = DragKeys;

    explicit Drag(const Parameters &parameters)
      : where(parameters.where.expression(dim))
      , load(parameters.load.expression(dim))
    {}

    SurfaceCondition
    kind() const override
    {
      return SurfaceCondition::loaded;
    }

    bool
    acts_on(const Point<dim> &X, const Tensor<1, dim> &) const override
    {
      return holds(where, X);
    }

    std::unique_ptr<Term<dim>>
    term(const LoadedPoints<dim> &points, const double t) const override
    {
      std::vector<Tensor<1, dim>> forces;
      for (const auto &point : points.points)
        forces.push_back(holds(where, point.X_seed) ?
                           point.initial_area * load.vector(point.X, t) :
                           Tensor<1, dim>());
      return std::make_unique<DeadLoad<dim>>(points, std::move(forces));
    }

  private:
    const Expression where, load;
  };
} // namespace Own

#endif
