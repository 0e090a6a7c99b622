// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_obstacles_body_h
#define morula_effects_obstacles_body_h

#include <morula/effects/obstacles/obstacle_parameters.h>

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <memory>

namespace Morula
{
  /** Distance of a place to the surface of a body, with its derivatives. */
  template <int dim>
  struct Distance
  {
    /** µm; positive outside of the body. */
    double value = 0.;
    /** Unit vector away from the body; 0 if it is undefined. */
    Tensor<1, dim> gradient;
    /** Second derivative of the value, 1/µm; 0 beside a plane. */
    Tensor<2, dim> curvature;
  };

  /** A rigid body at its place of t = 0. */
  template <int dim>
  class Body
  {
  public:
    virtual ~Body() = default;

    /** Distance of @p x (µm) to the surface. */
    virtual Distance<dim>
    distance(const Point<dim> &x) const = 0;
  };

  /** The body that the keys of an obstacle describe. @throws InputError */
  template <int dim>
  std::unique_ptr<const Body<dim>>
  make_body(const ObstacleKeys &keys);
} // namespace Morula

#endif
