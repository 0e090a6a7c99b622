// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/base/instantiate.h>
#include <morula/seeding/shape.h>
#include <morula/seeding/shapes/box.h>
#include <morula/seeding/shapes/cylinder.h>
#include <morula/seeding/shapes/ellipsoid.h>
#include <morula/seeding/shapes/mesh.h>
#include <morula/seeding/shapes/sphere.h>

#include <deal.II/base/exceptions.h>

#include <cmath>

namespace Morula
{
  template <int dim>
  std::optional<bool>
  Shape<dim>::side_of_cube(const Point<dim> &x, const double half_side) const
  {
    return this->contains(x, std::sqrt(double(dim)) * half_side) ?
             std::optional<bool>(true) :
             std::nullopt;
  }


  template <int dim>
  Point<dim>
  leading_components(const std::vector<double> &numbers)
  {
    AssertThrow(numbers.size() >= dim,
                ExcDimensionMismatch(numbers.size(), dim));
    Point<dim> p;
    for (unsigned int d = 0; d < dim; ++d)
      p[d] = numbers[d];
    return p;
  }

  double
  golden_fraction(const std::uint64_t i)
  {
    const double turns = static_cast<double>(i) * golden_turn;
    return turns - std::floor(turns);
  }

  template <int dim>
  std::unique_ptr<Shape<dim>>
  make_shape(const TissueParameters &parameters)
  {
    // Each shape takes the keys that belong to it. The parameters' own check
    // has refused what does not exist in this dimension, so the last line is
    // reached by points only, which have no inside.
    const std::string &shape  = parameters.shape;
    const Point<dim>   center = leading_components<dim>(parameters.center);

    if (shape == "sphere")
      return std::make_unique<Sphere<dim>>(center,
                                           parameters.radius,
                                           parameters.inner_radius);
    if (shape == "box")
      return std::make_unique<Box<dim>>(
        center, leading_components<dim>(parameters.size));
    if (shape == "ellipsoid")
      return std::make_unique<Ellipsoid<dim>>(
        center, 0.5 * leading_components<dim>(parameters.size));
    if constexpr (dim == 3)
      {
        if (shape == "cylinder")
          return std::make_unique<Cylinder>(center,
                                            parameters.radius,
                                            parameters.size->at(2));
        if (shape == "mesh")
          return std::make_unique<MeshShape>(parameters.surface_mesh.path(),
                                             parameters.surface_mesh);
      }
    parameters.shape.refuse(dim == 3 ?
                              "sphere, box, ellipsoid, cylinder or mesh" :
                              "sphere, box or ellipsoid in 2-D",
                            "Choose a shape that has an inside.");
  }

  template class Shape<2>;
  template class Shape<3>;
  MORULA_INSTANTIATE(leading_components);
  MORULA_INSTANTIATE(make_shape);
} // namespace Morula
