// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/surface/fixed.h>

namespace Morula
{
  std::string
  FixedParameters::details() const
  {
    return "; displacement " + displacement.text() + " um";
  }


  template <int dim>
  Fixed<dim>::Fixed(const Parameters &parameters)
    : PlacedCondition<dim>(SurfaceCondition::fixed, parameters)
    , displacement_(parameters.displacement.expression(dim))
  {}


  template <int dim>
  bool
  Fixed<dim>::moves() const
  {
    // A clamp at rest does not move the tissue; one that is prescribed may.
    return !displacement_.is_always(0., dim);
  }


  template <int dim>
  void
  Fixed<dim>::check_at(const Point<dim> &X, const double t) const
  {
    // To evaluate it is the check: an expression without a value throws.
    displacement_.vector(X, t);
  }


  template class Fixed<2>;
  template class Fixed<3>;
} // namespace Morula
