// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_boundary_condition_h
#define morula_effects_surface_boundary_condition_h

#include <morula/effects/part_of_step.h>
#include <morula/mechanics/material_points.h>
#include <morula/mechanics/term.h>
#include <morula/particles/boundary_state.h>

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace Morula
{
  /** The boundary points that no condition holds, for terms that load them:
   *  values of the configuration at the beginning of the step. */
  template <int dim>
  struct LoadedPoints : public GroupedPoints<dim>
  {
    /** One boundary point. */
    struct Point
    {
      /** Initial position of the point at t = 0 of which this one is a part,
       *  µm. It decides whether a condition acts. */
      dealii::Point<dim> X_seed;
      /** Initial position, µm. */
      dealii::Point<dim> X;
      /** Initial outward unit normal. */
      Tensor<1, dim> N;
      /** Position, µm. */
      dealii::Point<dim> x;
      /** Initial area, µm^(dim-1). */
      double initial_area;
      /** Area times outward normal, µm^(dim-1). */
      Tensor<1, dim> area;
      /** The two-sided obstacles that hold it: BoundaryColumns::touched. */
      unsigned int touched = 0;
    };

    /** The points in the order of xi. */
    std::vector<Point> points;
    /** Their sides; empty without contact. */
    std::vector<Side<dim>> sides;
    /** The tissue whose points they are. */
    const Tissue<dim> *tissue = nullptr;
    /** Time of the configuration, day. */
    double time = 0.;
    /** Young's modulus of the stiffest cell, kPa. */
    double youngs_modulus = 0.;
  };

  /**
   * A condition on the surface. It holds its points, in all directions or along
   * their normal, or it loads them by a term of its own. One Nitsche term does
   * the holding for all conditions.
   *
   * If several act on a point, one that fixes wins over one that lets slip, and
   * that one over those that load. Of two that fix, or two that let slip, the
   * one that was added first wins. All that load act together.
   */
  template <int dim>
  class BoundaryCondition : public Effect<dim>
  {
  public:
    /** What the condition does: fixed, slip or loaded. */
    virtual SurfaceCondition
    kind() const
    {
      return SurfaceCondition::loaded;
    }

    /** Whether it acts on the point with initial position @p X (µm) and initial
     *  outward unit normal @p N; asked at t = 0. */
    virtual bool
    acts_on(const Point<dim> & /*X*/, const Tensor<1, dim> & /*N*/) const
    {
      return true;
    }

    /** Displacement at which a fixed point is held at @p t (day), µm. */
    virtual Tensor<1, dim>
    displacement(const Point<dim> & /*X*/, const double /*t*/) const
    {
      return Tensor<1, dim>();
    }

    /** The term of a condition that loads, at the end @p t (day) of a step, for
     *  those of @p points on which it acts; null: it has none. Collective: all
     *  ranks ask at once.
     *  @throws StepFailed if the step is too long for it */
    virtual std::unique_ptr<Term<dim>>
    term(const LoadedPoints<dim> &, const double) const
    {
      return nullptr;
    }

    /** A part of a condition whose force is told apart from the others'. */
    struct Part
    {
      /** Empty: the condition as a whole. */
      std::string                name;
      std::unique_ptr<Term<dim>> term;
      /** Whether it acts on those points alone on which it has a force. */
      bool only_where_it_touches = false;
    };

    /** The parts of a condition that loads, with terms as term() makes them. */
    virtual std::vector<Part>
    parts(const LoadedPoints<dim> &points, const double t) const
    {
      std::vector<Part> list;
      if (auto whole = term(points, t))
        list.push_back({"", std::move(whole)});
      return list;
    }

    /** The parts that the condition as a whole has in an attempt at a step
     *  besides its terms, which may keep a reference to @p attempt.
     *  Collective. */
    virtual std::vector<std::unique_ptr<PartOfStep<dim>>>
    parts_of_step(const AttemptAtStep<dim> & /*attempt*/) const
    {
      return {};
    }

    /** Refuses a surface at t = 0 on which it cannot act. The areas are those
     *  of the boundary points, µm^(dim-1). Collective. @throws InputError */
    virtual void
    check_surface(const Preview<dim> & /*at*/,
                  const std::vector<double> & /*areas*/) const
    {}

    /** Whether it only pushes tissue that it touches, and never holds it. */
    virtual bool
    only_pushes() const
    {
      return false;
    }

    /** Adds the columns of boundary points in which these remember what the
     *  condition does to them. */
    virtual void
    add_columns(BoundaryColumns<dim> &) const
    {}

    /** Lets the points that touch it at @p t (day), when a step begins,
     *  remember that, and those forget it that have let go. */
    virtual void
    touch(Tissue<dim> &, const double /*t*/) const
    {}

    /** What is called so, and the shortest way (µm) from a place (µm) out of
     *  it; zero outside of it. */
    using Forbidden =
      std::pair<std::string, std::function<Tensor<1, dim>(const Point<dim> &)>>;

    /** Where no cell may be at @p t (day); what is given keeps references. */
    virtual std::vector<Forbidden>
    forbidden(const double /*t*/) const
    {
      return {};
    }

    /** Whether tissue at rest would move: for the estimate of the time. */
    virtual bool
    moves() const
    {
      // A load moves tissue from rest; what holds points does so only if it is
      // prescribed to move.
      return kind() == SurfaceCondition::loaded;
    }
  };
} // namespace Morula

#endif
