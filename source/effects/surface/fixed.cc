// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/catalogue.h>
#include <morula/effects/surface/fixed.h>

namespace Morula
{
  namespace
  {
    /** Points that are held in all directions, at a prescribed displacement. */
    template <int dim>
    class Fixed : public PlacedCondition<dim>
    {
    public:
      using Parameters = FixedParameters;

      /** @throws InputError for expressions that cannot be parsed */
      explicit Fixed(const Parameters &parameters)
        : PlacedCondition<dim>(SurfaceCondition::fixed,
                               parameters,
                               parameters.displacement,
                               dim)
      {}

      Tensor<1, dim>
      displacement(const Point<dim> &X, const double t) const override
      {
        return this->prescribed->vector(X, t);
      }
      bool
      moves() const override
      {
        // A clamp at rest does not move the tissue; one that is prescribed may.
        return !this->prescribed->is_always(0., dim);
      }
    };
  } // namespace


  void
  add_fixed(Catalogue &catalogue)
  {
    catalogue.add_own<Fixed>(
      "fixed",
      {"Boundary conditions/Fixed where=X + Y < -2",
       "Boundary conditions/Displacement=0.2*t; 0.2*t; 0"});
  }
} // namespace Morula
