// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_obstacles_body_h
#define morula_effects_obstacles_body_h

#include <morula/base/expression_key.h>
#include <morula/base/name_list.h>

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <functional>
#include <string>
#include <vector>

namespace Morula
{
  /** Section "Obstacles/NAME". */
  struct ObstacleKeys : public Keys
  {
    /** @param name of the obstacle */
    explicit ObstacleKeys(const std::string &name)
      : name(name)
    {
      place_in(list(), "Obstacles/" + name);
      const std::string is = shape.path() + "=";
      radius.needs({is + "sphere", is + "cylinder"});
      normal.needs({is + "plane"});
      size.needs({is + "box"});
      axis.needs({is + "cylinder"});
      surface_mesh.needs({is + "mesh"});
      surface_mesh.of_file();
    }

    std::string      name;
    Key<std::string> shape{
      {this, "Shape"},
      "",
      "plane, sphere (2-D: a disc), cylinder (without ends), box (its "
      "edges along the axes) or mesh.",
      {"|plane|sphere|cylinder|box|mesh"}};

    Key<std::string> side{
      {this, "Side"},
      "outside",
      "outside: the tissue is outside of the body, in front of the plane; "
      "inside: the tissue is inside, as in a mould.",
      {"outside|inside"}};

    Key<std::vector<double>> center{
      {this, "Center"},
      {0., 0., 0.},
      "Center of the body, a point of the plane, or where the origin of the "
      "mesh's file is, at t = 0. Units: um."};

    Key<double> radius{{this, "Radius"},
                       0.,
                       "Radius of a sphere or cylinder; > 0. Units: um."};

    DirectionKey normal{
      {this, "Normal"},
      "",
      "Normal of a plane; it points to the tissue if Side = outside."};

    Key<std::vector<double>> size{{this, "Size"},
                                  {},
                                  "Full edge lengths of a box. Units: um."};

    DirectionKey axis{{this, "Axis"}, "", "Axis of a cylinder."};

    Key<std::string> surface_mesh{
      {this, "Surface mesh"},
      "",
      "For the shape mesh: file with a closed surface in um, as STL, OFF, "
      "PLY or OBJ."};

    Key<double> stiffness{
      {this, "Stiffness"},
      100.,
      "Pressure on the tissue over its depth in the obstacle; > 0. E "
      "is that of the stiffest cell. Units: E/h.",
      {},
      positive("E/h", "100 lets tissue under the pressure E go in by h/100.")};

    Key<bool> two_sided{
      {this, "Two-sided"},
      false,
      "Whether the obstacle also pulls back the surface that has touched it, "
      "up to a distance of half a grid spacing; along the obstacle it slides."};

    ExpressionKey velocity{
      {this, "Velocity"},
      "0; 0; 0",
      "Velocity of the obstacle: functions of t separated by ';'. "
      "Units: um/day.",
      Evaluated::place,
      3};
  };

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

  /** A rigid body at its place of t = 0: the distance of a place (µm) to its
   *  surface. */
  template <int dim>
  using Body = std::function<Distance<dim>(const Point<dim> &)>;

  /** The body that the keys of an obstacle describe. @throws InputError */
  template <int dim>
  Body<dim>
  make_body(const ObstacleKeys &keys);
} // namespace Morula

#endif
