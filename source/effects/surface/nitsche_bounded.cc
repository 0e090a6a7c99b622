// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/surface/nitsche_bounded.h>

#include <cmath>
#include <utility>

namespace Morula
{
  namespace
  {
    /** The gap at which the penalty has doubled, g₀ in (4.6a), in grid
     *  spacings. A penalty that rises with the gap does not let squeezed tissue
     *  slip through a clamp that is soft at its edge. */
    constexpr double stiffening_gap = 0.2;
  } // namespace


  template <int dim>
  BoundedNitsche<dim>::BoundedNitsche(
    GroupedPoints<dim>                 points,
    std::vector<HeldPoint>             held_points,
    const std::vector<Tensor<1, dim>> &tractions)
    : PointTerm<dim>(std::move(points))
    , held_points(std::move(held_points))
    , tractions(tractions)
  {}


  template <int dim>
  void
  BoundedNitsche<dim>::add_point(const unsigned int       p,
                                 const SplineValues<dim> &splines,
                                 const LocalField<dim>   &field,
                                 LocalSystem<dim>        &system) const
  {
    // These are energy, force and stiffness of doc/theory.md (4.6a). The
    // deformation of the point does not enter, so there is nothing to be
    // inverted.
    const HeldPoint      &held = held_points[p];
    const double          a_t = held.area, beta = held.penalty;
    const Tensor<1, dim>  gap = held.gap_with(field, splines);
    const Tensor<1, dim> &T   = tractions[p];
    system.note_gap(gap.norm(), this->points.xi[p]);
    const double   ratio = gap.norm() / (stiffening_gap * this->points.h);
    const double   more  = std::pow(ratio, 4); // of the penalty, at this gap
    Tensor<2, dim> stiffness = (1. + more) * held.projection;
    if (more > 0.)
      // This is the derivative of the penalty along the gap. At a gap of 0 it
      // vanishes, and the quotient has no value.
      stiffness += 4. * more / gap.norm_square() * outer_product(gap, gap);
    add_force_at(splines,
                 a_t * (0.5 * beta * (1. + more / 3.) * gap.norm_square() -
                        T * gap),
                 a_t * (beta * (1. + more) * gap - T),
                 a_t * beta * stiffness,
                 system);
    // The gap is the difference of two positions, whose rounding counts.
    if (system.wanted == LocalSystem<dim>::rounding)
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
          system.magnitude[i * BSpline<dim>::n + a] +=
            a_t * beta * held.position_scale * splines.value[a];
  }

  template class BoundedNitsche<2>;
  template class BoundedNitsche<3>;
} // namespace Morula
