// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/effects/growth/isotropic.h>

#include <deal.II/base/symmetric_tensor.h>

#include <cmath>
#include <sstream>

namespace Morula
{
  IsotropicGrowthParameters::IsotropicGrowthParameters()
    : stretch("Growth/Isotropic/Stretch",
              "1",
              "Growth stretch theta(X, Y, Z, t), an expression; > 0. "
              "F_g = theta I; theta = 1 is the initial size.",
              Evaluated::step)
  {
    stretch.symbol("theta").positive("(a ratio of lengths)",
                                     "1 is the initial size.");
  }


  KeyList
  IsotropicGrowthParameters::list()
  {
    return {&stretch};
  }


  template <int dim>
  IsotropicGrowth<dim>::IsotropicGrowth(
    const IsotropicGrowthParameters &parameters)
    : theta(parameters.stretch.expression(dim))
  {}


  template <int dim>
  double
  IsotropicGrowth<dim>::stretch(const Point<dim> &X, const double t) const
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


  template <int dim>
  Tensor<2, dim>
  IsotropicGrowth<dim>::growth(const GrowingCell<dim> &cell,
                               const double /*t0*/,
                               const double t1) const
  {
    return stretch(cell.founder_position, t1) *
           Tensor<2, dim>(unit_symmetric_tensor<dim>());
  }


  template <int dim>
  double
  IsotropicGrowth<dim>::expected_volume_ratio(const Point<dim> &X,
                                              const double      t) const
  {
    return std::pow(stretch(X, t), dim);
  }


  template class IsotropicGrowth<2>;
  template class IsotropicGrowth<3>;
} // namespace Morula
