// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/surface_mesh.h>
#include <morula/effects/obstacles/body.h>

#include <cmath>
#include <limits>

namespace Morula
{
  namespace
  {
    template <int dim>
    Tensor<2, dim>
    identity()
    {
      return Tensor<2, dim>(unit_symmetric_tensor<dim>());
    }

    template <int dim>
    Body<dim>
    plane_body(const Point<dim> &point, const Tensor<1, dim> &normal)
    {
      // A plane does not curve, so the second term of the tangent (4.8e) is
      // zero.
      return [=](const Point<dim> &x) -> Distance<dim> {
        return {normal * (x - point), normal, Tensor<2, dim>()};
      };
    }

    /** A sphere, or a cylinder if a direction does not count.
     *  @param across projection onto the directions that count */
    template <int dim>
    Body<dim>
    round_body(const Point<dim>     &center,
               const double          radius,
               const Tensor<2, dim> &across)
    {
      return [=](const Point<dim> &x) {
        // The distance of a sphere is |x - c| - r, and its second derivative is
        // (P - n⊗n)/|x - c|. P is the identity for a sphere. For a cylinder P
        // removes the part along its axis, so that the same formulas give the
        // distance to the axis.
        const Tensor<1, dim> arm    = across * (x - center);
        const double         length = arm.norm();
        Distance<dim>        result;
        result.value = length - radius;
        // At the center no direction is nearest: gradient and curvature stay
        // zero, and the force there vanishes.
        if (length > 0.)
          {
            result.gradient = arm / length;
            result.curvature =
              (across - outer_product(result.gradient, result.gradient)) /
              length;
          }
        return result;
      };
    }

    template <int dim>
    Body<dim>
    box_body(const Point<dim> &center, const Point<dim> &size)
    {
      return [=](const Point<dim> &x) {
        // One pass over the directions finds both distances that the place may
        // need. q is how far x is beyond the pair of faces across direction d,
        // and negative between them. The largest q belongs to the nearest face
        // if x is inside of the box; the positive ones together lead from the
        // box to x if it is outside.
        Distance<dim>  inside; // to the nearest face
        Tensor<1, dim> beyond; // from the nearest point of the box
        inside.value = -std::numeric_limits<double>::infinity();
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double arm  = x[d] - center[d];
            const double sign = arm < 0. ? -1. : 1.;
            const double q    = std::abs(arm) - 0.5 * size[d];
            if (q > inside.value)
              {
                inside.value       = q;
                inside.gradient    = Tensor<1, dim>();
                inside.gradient[d] = sign;
              }
            beyond[d] = q > 0. ? sign * q : 0.;
          }
        if (!(inside.value > 0.))
          return inside;
        // Outside, the distance has the form of a sphere's around the nearest
        // point of the box: (P - n⊗n)/|b|, where P projects onto the directions
        // in which x is beyond a face. Beside a face that is one direction, and
        // the curvature is zero; beside an edge it is that of a cylinder,
        // beside a corner that of a sphere.
        Distance<dim> result;
        result.value     = beyond.norm();
        result.gradient  = beyond / result.value;
        result.curvature = outer_product(result.gradient, result.gradient);
        result.curvature *= -1. / result.value;
        for (unsigned int d = 0; d < dim; ++d)
          if (beyond[d] != 0.)
            result.curvature[d][d] += 1. / result.value;
        return result;
      };
    }

    /** The inside of a closed surface of triangles.
     *  @param origin of the file's coordinates */
    Body<3>
    mesh_body(const Point<3> &origin, const Key<std::string> &file)
    {
      // The tree of triangles is in the file's coordinates, so the place moves
      // instead of the mesh.
      const auto mesh = std::make_shared<const SurfaceMesh>(file.path(), file);
      return [=](const Point<3> &x) -> Distance<3> {
        const NearestPoint nearest = mesh->nearest(Point<3>(x - origin));
        return {nearest.distance, nearest.direction, nearest.curvature};
      };
    }

    template <int dim>
    Point<dim>
    place(const Key<std::vector<double>> &key)
    {
      if (key->size() < dim)
        key.refuse(std::to_string(dim) + " numbers in um",
                   "Write one for each direction.");
      Point<dim> result;
      for (unsigned int d = 0; d < dim; ++d)
        result[d] = key.value()[d];
      return result;
    }

    template <int dim>
    Tensor<1, dim>
    direction(const DirectionKey &key, const std::string &shape)
    {
      if (key->empty())
        key.refuse("a direction, as Shape = " + shape,
                   "Write for example 0, 1, 0.");
      return unit_vector<dim>(key.path(), key.value());
    }

    double
    positive_radius(const ObstacleKeys &keys)
    {
      if (!(keys.radius > 0.))
        keys.radius.refuse("a length in um > 0, as Shape = " + keys.shape,
                           "Give the radius of the body.");
      return keys.radius;
    }

    template <int dim>
    Point<dim>
    positive_size(const ObstacleKeys &keys)
    {
      const Point<dim> size = place<dim>(keys.size);
      for (unsigned int d = 0; d < dim; ++d)
        if (!(size[d] > 0.))
          keys.size.refuse("lengths in um > 0", "Give the edges of the box.");
      return size;
    }
  } // namespace


  template <int dim>
  Body<dim>
  make_body(const ObstacleKeys &keys)
  {
    // Each shape reads the keys that describe it, and refuses a value only if
    // it needs the key: a radius of zero is no error for a box. What is left at
    // the end is the cylinder, which has no meaning in 2-D. A file of triangles
    // is read only in 3-D, where such a surface encloses a volume.
    const Point<dim>  center = place<dim>(keys.center);
    const std::string shape  = keys.shape;
    if (shape == "plane")
      return plane_body<dim>(center, direction<dim>(keys.normal, shape));
    if (shape == "sphere")
      return round_body<dim>(center, positive_radius(keys), identity<dim>());
    if (shape == "box")
      return box_body<dim>(center, positive_size<dim>(keys));
    if (shape.empty())
      keys.shape.refuse("plane, sphere, cylinder, box or mesh",
                        "Say what the obstacle is.");
    if constexpr (dim == 3)
      if (shape == "mesh")
        {
          if (keys.surface_mesh->empty())
            keys.surface_mesh.refuse("a file, as Shape = mesh",
                                     "Name the file, or choose another Shape.");
          return mesh_body(center, keys.surface_mesh);
        }
    if (dim == 2)
      keys.shape.refuse("plane, sphere or box in 2-D",
                        "There a sphere is a disc.");
    // A cylinder is a sphere for which the way along the axis does not count.
    // The tensor I - a⊗a projects onto the rest.
    const Tensor<1, dim> axis = direction<dim>(keys.axis, shape);
    return round_body<dim>(center,
                           positive_radius(keys),
                           identity<dim>() - outer_product(axis, axis));
  }


  MORULA_INSTANTIATE(make_body);
} // namespace Morula
