// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/growth/isotropic.h>
#include <morula/input_error.h>

#include <sstream>

namespace Morula
{
  void
  IsotropicGrowthParameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter("Stretch",
                      stretch,
                      "Growth stretch theta(X, Y, Z, t), an expression; > 0. "
                      "F_g = theta I; theta = 1 is the initial size.");
  }


  IsotropicGrowth::IsotropicGrowth(const IsotropicGrowthParameters &parameters)
    : theta("Growth/Isotropic/Stretch", parameters.stretch)
  {}


  template <int dim>
  double
  IsotropicGrowth::stretch(const Point<dim> &X, const double t) const
  {
    const double value = theta.value(X, t);
    if (value <= 0.)
      {
        std::ostringstream place;
        place << "It is " << value << " at the cell from (" << X
              << ") um, t = " << t
              << " day. Choose a stretch that stays positive until End time.";
        throw InputError(theta.key(),
                         theta.text(),
                         "a value > 0 (a ratio of lengths)",
                         place.str());
      }
    return value;
  }


  template double
  IsotropicGrowth::stretch(const Point<2> &, const double) const;
  template double
  IsotropicGrowth::stretch(const Point<3> &, const double) const;
} // namespace Morula
