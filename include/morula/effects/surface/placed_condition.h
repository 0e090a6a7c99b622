// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_placed_condition_h
#define morula_effects_surface_placed_condition_h

#include <morula/base/expression_key.h>
#include <morula/effects/scene_keys.h>
#include <morula/effects/surface/boundary_condition.h>

#include <optional>
#include <string>
#include <vector>

namespace Morula
{
  /** The keys of a condition that acts where an expression is positive. */
  struct ConditionKeys : public EffectKeys
  {
    /**
     * @param path     of the key that says where it acts; without text: nowhere
     * @param anywhere its text if the scene does not set it
     */
    ConditionKeys(const std::string &path,
                  const std::string &documentation,
                  const std::string &anywhere = "")
      : where({this, path}, anywhere, documentation, Evaluated::founder)
    {}

    ExpressionKey where;

    EffectFacts
    facts() const override
    {
      return {&where};
    }
  };

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
    check(const Preview<dim> &scene) const override
    {
      // Each point on which the condition acts is tried at both ends of the
      // run. To evaluate is the check: an expression without a value throws.
      for (const Point<dim> &X : scene.boundary_points)
        if (holds(X))
          for (const double t : {0., scene.keys.time.end_time.value()})
            for (unsigned int c = 0; c < n_values; ++c)
              prescribed->value(X, t, c);
    }

  protected:
    /** @throws InputError for an expression that cannot be parsed */
    PlacedCondition(const SurfaceCondition kind, const ConditionKeys &keys)
      : kind_(kind)
      , where(keys.where.expression(dim))
    {}

    /** With an expression of place and time of which the first @p n_values
     *  components must have a value wherever the condition acts. */
    PlacedCondition(const SurfaceCondition kind,
                    const ConditionKeys   &keys,
                    const ExpressionKey   &prescribed,
                    const unsigned int     n_values)
      : kind_(kind)
      , where(keys.where.expression(dim))
      , prescribed(prescribed.expression(dim))
      , n_values(n_values)
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
    holds(const Point<dim> &X) const
    {
      // Conditions are decided at t = 0, for the whole run.
      return where.value(X, 0.) > 0.;
    }

    const SurfaceCondition kind_;
    const Expression       where;

  protected:
    const std::optional<Expression> prescribed;

  private:
    const unsigned int n_values = 0;
  };
} // namespace Morula

#endif
