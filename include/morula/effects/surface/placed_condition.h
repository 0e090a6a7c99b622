// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_placed_condition_h
#define morula_effects_surface_placed_condition_h

#include <morula/effects/surface/boundary_condition.h>
#include <morula/effects/surface/condition_keys.h>

#include <vector>

namespace Morula
{
  /** A condition that acts where an expression of the place is positive. */
  template <int dim>
  class PlacedCondition : public BoundaryCondition<dim>
  {
  public:
    SurfaceCondition
    kind() const override
    {
      return kind_;
    }
    bool
    acts_on(const Point<dim> &X, const Tensor<1, dim> &) const override
    {
      return holds(X);
    }
    void
    check(const Preview<dim> &scene) const override;

  protected:
    /** @throws InputError for an expression that cannot be parsed */
    PlacedCondition(const SurfaceCondition kind, const ConditionKeys &keys);

    /** Refuses what the condition cannot do at a point @p X (µm) on which it
     *  acts, at @p t (day). @throws InputError */
    virtual void
    check_at(const Point<dim> &, const double) const
    {}

    /** @p value of each point on which it acts, and Value() for the others. */
    template <typename Value, typename Function>
    std::vector<Value>
    loads(const LoadedPoints<dim> &points, const Function &value) const
    {
      std::vector<Value> list;
      for (const auto &point : points.points)
        list.push_back(holds(point.X_seed) ? value(point) : Value());
      return list;
    }

  private:
    bool
    holds(const Point<dim> &X) const;

    const SurfaceCondition kind_;
    const Expression       where;
  };
} // namespace Morula

#endif
