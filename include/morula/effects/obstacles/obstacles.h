// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_obstacles_obstacles_h
#define morula_effects_obstacles_obstacles_h

#include <morula/effects/obstacles/obstacle_contact.h>
#include <morula/effects/surface/boundary_condition.h>

#include <memory>
#include <string>
#include <vector>

namespace Morula
{
  /** Rigid bodies that the surface of the tissue slides along and cannot
   *  enter: doc/theory.md (4.8d). */
  template <int dim>
  class Obstacles : public BoundaryCondition<dim>
  {
  public:
    using Parameters = ObstaclesParameters;

    /** @throws InputError for bodies that do not exist, and for velocities that
     *  cannot be parsed */
    explicit Obstacles(const Parameters &parameters);

    SurfaceCondition
    kind() const override
    {
      return SurfaceCondition::loaded;
    }
    bool
    acts_on(const Point<dim> &, const Tensor<1, dim> &) const override
    {
      return true;
    }
    /** @throws StepFailed if an obstacle moves too far in the step */
    std::unique_ptr<Term<dim>>
    term(const LoadedPoints<dim> &points, const double t) const override;
    /** One part for each obstacle. */
    std::vector<typename BoundaryCondition<dim>::Part>
    parts(const LoadedPoints<dim> &points, const double t) const override;
    bool
    only_pushes() const override
    {
      return true;
    }
    void
    check(const Preview<dim> &scene) const override;
    void
    review(const Preview<dim> &scene, Review &review) const override;

  private:
    struct Obstacle
    {
      std::string                      name;
      bool                             is_mould;
      std::unique_ptr<const Body<dim>> body;
      double                           stiffness; // κ h / E
      Expression                       velocity;  // µm/day
      std::string                      mesh_key;  // that names the mesh's file
      std::string                      mesh;      // empty without one
      /** The least thickness of the body, µm; infinite if it has none. */
      double thickness;

      /** The way of the body from t = 0 to @p t, µm. */
      Tensor<1, dim>
      way(const double t) const;

      /** The obstacle at @p t (day) against these points. */
      typename ObstacleContact<dim>::Obstacle
      at(const double t, const LoadedPoints<dim> &points) const;
    };

    std::vector<Obstacle> list;
  };
} // namespace Morula

#endif
