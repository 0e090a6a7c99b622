// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <deal.II/base/utilities.h>

#include <half-fixed-sphere/parameters.h>

#include <cmath>
#include <sstream>

namespace HalfFixedSphere
{
  InputError::InputError(const std::string &key,
                         const std::string &value,
                         const std::string &problem)
    : std::runtime_error(key + " = '" + value + "': " + problem +
                         ". 'half-fixed-sphere --parameters' prints all keys.")
  {}


  void
  Parameters::declare(ParameterHandler &prm)
  {
    using namespace Patterns;
    const Double number;
    prm.add_parameter("Radius", radius, "R of the sphere, um; > 0.");
    prm.add_parameter("Young's modulus", youngs_modulus, "E, kPa; > 0.");
    prm.add_parameter("Poisson's ratio", poissons_ratio, "-1 < nu < 0.5.");
    prm.add_parameter("Growth stretches",
                      stretches,
                      "theta of the states written, in the order in which they "
                      "are visited from theta = 1 on; > 0.",
                      List(number, 1));
    prm.add_parameter("Hold lower surface",
                      held,
                      "Whether the surface with Z <= 'Clamp edge' keeps its "
                      "place. Without it the sphere grows freely.");
    prm.add_parameter("Clamp edge",
                      edge,
                      "Height Z of the edge of the held surface, um; smaller "
                      "in size than the radius.");
    prm.add_parameter("Subdivisions",
                      mesh.subdivisions,
                      "Grid cells along an eighth of the great circle before "
                      "any refinement.",
                      Integer(1, 1000));
    prm.add_parameter("Edge levels",
                      mesh.edge_levels,
                      "Bisections of the grid cells that touch the edge.",
                      Integer(0, 30));
    prm.add_parameter("Uniform levels",
                      mesh.uniform_levels,
                      "Bisections of all grid cells after that.",
                      Integer(0, 10));
    prm.add_parameter("Degree",
                      degree,
                      "Degree of the polynomials.",
                      Integer(1, 8));
    prm.add_parameter(
      "Edge quadrature points",
      edge_points,
      "Gauss-Lobatto points per direction in the grid cells "
      "near the edge, about 6 times the degree; 0: Gauss points "
      "as everywhere else.",
      Integer(0, 30));
    prm.add_parameter("Newton tolerance",
                      tolerance,
                      "On the residual, relative to the first of an "
                      "increment; > 0.");
    prm.add_parameter("Output",
                      output,
                      "The results go to OUTPUT.csv, OUTPUT-outline.csv and, "
                      "if asked for, OUTPUT-THETA.vtu.");
    prm.add_parameter(
      "Stability modes",
      modes,
      "Numbers m of waves around the axis against which the "
      "stability of each state is tested, OUTPUT-stability.csv.",
      List(Integer(2, 10000)));
    prm.add_parameter("Write VTU", write_vtu, "Whether fields are written.");
  }


  namespace
  {
    void
    override_key(const std::string &text, ParameterHandler &prm)
    {
      const std::size_t equal = text.find('=');
      if (equal == std::string::npos)
        throw InputError("-s", text, "must be of the form Key=value");
      const std::string key   = Utilities::trim(text.substr(0, equal));
      const std::string value = text.substr(equal + 1);
      try
        {
          prm.set(key, value);
        }
      catch (const ParameterHandler::ExcEntryUndeclared &)
        {
          throw InputError(key, value, "there is no such key");
        }
      catch (const ParameterHandler::ExcValueDoesNotMatchPattern &error)
        {
          std::ostringstream problem;
          error.print_info(problem);
          throw InputError(key, value, Utilities::trim(problem.str()));
        }
    }
  } // namespace


  Parameters
  Parameters::read(const std::vector<std::string> &overrides)
  {
    Parameters       result;
    ParameterHandler prm;
    result.declare(prm);
    for (const std::string &text : overrides)
      override_key(text, prm);
    result.check();
    return result;
  }


  void
  Parameters::check() const
  {
    const auto require = [](const bool         good,
                            const std::string &key,
                            const double       value,
                            const std::string &allowed) {
      std::ostringstream text;
      text << value;
      if (!good)
        throw InputError(key, text.str(), "must be " + allowed);
    };
    require(radius > 0., "Radius", radius, "a length > 0 um");
    require(youngs_modulus > 0.,
            "Young's modulus",
            youngs_modulus,
            "a stiffness > 0 kPa");
    require(poissons_ratio > -1. && poissons_ratio < 0.5,
            "Poisson's ratio",
            poissons_ratio,
            "a number above -1 and below 0.5");
    for (const double theta : stretches)
      require(theta > 0., "Growth stretches", theta, "a list of numbers > 0");
    require(std::abs(edge) < radius,
            "Clamp edge",
            edge,
            "a height between -Radius and Radius");
    require(edge_points == 0 || edge_points >= 3,
            "Edge quadrature points",
            edge_points,
            "0 or a number of at least 3");
    require(tolerance > 0. && tolerance < 1.,
            "Newton tolerance",
            tolerance,
            "a number above 0 and below 1");
  }
} // namespace HalfFixedSphere
