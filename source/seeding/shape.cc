// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/seeding/shape.h>

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
    // The parameters' own check has refused what does not exist in this
    // dimension, so the last line is reached by points only, which have no
    // inside.
    const std::string &shape = parameters.shape;
    if (shape == "sphere")
      return make_sphere<dim>(parameters);
    if (shape == "box")
      return make_box<dim>(parameters);
    if (shape == "ellipsoid")
      return make_ellipsoid<dim>(parameters);
    if constexpr (dim == 3)
      {
        if (shape == "cylinder")
          return make_cylinder(parameters);
        if (shape == "mesh")
          return make_mesh_shape(parameters);
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
