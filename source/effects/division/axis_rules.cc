// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/effects/division/axis_rules.h>
#include <morula/effects/division/directions.h>
#include <morula/effects/state/present_cell.h>

#include <sstream>

namespace Morula
{
  namespace
  {
    template <int dim>
    std::string
    zero_is_refused()
    {
      return "a vector of " + std::to_string(dim) +
             " components that is not zero";
    }

    const char *const remedy_of_zero =
      "Give the direction along which cells divide, or set Division axis = "
      "random.";

    /** The normal of the surface near the cell, now. */
    template <int dim>
    Tensor<1, dim>
    surface_normal(const PresentCell<dim> &cell)
    {
      // What is stored is N of the point that was nearest to the founder at t =
      // 0; F carries it to now.
      return Directions::carried_normal(cell.cell().F(), cell.surface_normal());
    }
  } // namespace


  FixedAxisParameters::FixedAxisParameters()
  {
    axis.admit_commas();
  }


  template <int dim>
  FixedAxis<dim>::FixedAxis(const Parameters         &parameters,
                            const EffectSetting<dim> &setting)
    : direction(setting.state.use(parameters.axis))
  {
    // A vector that is zero for every cell is refused as the keys are read. One
    // that is zero for some cells is found as they enter S.
    if (direction.is_always(0., dim))
      parameters.axis.refuse(zero_is_refused<dim>(), remedy_of_zero);
  }


  template <int dim>
  Tensor<1, dim>
  FixedAxis<dim>::axis(const CellAtOnset<dim> &cell) const
  {
    // Before the cells are placed no rule can look at one. The random axis then
    // stands in, so that the checks before the run go through.
    if (cell.present == nullptr)
      return cell.random;
    const Tensor<1, dim> vector = cell.present->vector(direction, cell.time);
    if (vector.norm() > 0.)
      return vector;
    std::ostringstream place;
    place << cell.founder_position;
    throw InputError(direction.key(),
                     direction.text(),
                     zero_is_refused<dim>() +
                       "; it is zero for the cell whose founder was at (" +
                       place.str() + ") um",
                     remedy_of_zero);
  }


  template <int dim>
  Tensor<1, dim>
  StretchAxis<dim>::axis(const CellAtOnset<dim> &cell) const
  {
    // A cell that is stretched equally has no long axis and takes the random
    // one, as with Division axis = random.
    return Directions::of_largest_stretch(cell.elastic,
                                          cell.least_anisotropy,
                                          cell.random)
      .value_or(cell.random);
  }


  template <int dim>
  Tensor<1, dim>
  StressAxis<dim>::axis(const CellAtOnset<dim> &cell) const
  {
    if (cell.present == nullptr)
      return cell.random;
    // The stress is that at the beginning of the step, since the present step
    // is still to be solved.
    return Directions::of_largest_stress(cell.present->quantities().stress,
                                         cell.present->lame().mu,
                                         cell.least_anisotropy,
                                         cell.random)
      .value_or(cell.random);
  }


  template <int dim>
  RadialAxis<dim>::RadialAxis(const Parameters         &parameters,
                              const EffectSetting<dim> &setting)
    : center(setting.state.use(parameters.center))
  {}


  template <int dim>
  Tensor<1, dim>
  RadialAxis<dim>::axis(const CellAtOnset<dim> &cell) const
  {
    if (cell.present == nullptr)
      return cell.random;
    const Tensor<1, dim> away =
      cell.present->position() -
      Point<dim>(cell.present->vector(center, cell.time));
    // A cell exactly at the center has no way out from it.
    return away.norm() > 0. ? away : cell.random;
  }


  template <int dim>
  SurfaceNormalAxis<dim>::SurfaceNormalAxis(const NoAxisKeys &,
                                            const EffectSetting<dim> &setting)
  {
    // The columns for the normal exist only where an effect asks for them.
    setting.state.need_surface_normal();
  }


  template <int dim>
  Tensor<1, dim>
  SurfaceNormalAxis<dim>::axis(const CellAtOnset<dim> &cell) const
  {
    return cell.present == nullptr ? cell.random :
                                     surface_normal(*cell.present);
  }


  template <int dim>
  TangentialAxis<dim>::TangentialAxis(const NoAxisKeys &,
                                      const EffectSetting<dim> &setting)
  {
    setting.state.need_surface_normal();
  }


  template <int dim>
  Tensor<1, dim>
  TangentialAxis<dim>::axis(const CellAtOnset<dim> &cell) const
  {
    return cell.present == nullptr ?
             cell.random :
             Directions::across(surface_normal(*cell.present), cell.random);
  }


  template <int dim>
  GradientAxis<dim>::GradientAxis(const std::string        &field,
                                  const EffectSetting<dim> &setting)
    : number(setting.state.need_gradient(field))
  {}


  template <int dim>
  Tensor<1, dim>
  GradientAxis<dim>::axis(const CellAtOnset<dim> &cell) const
  {
    if (cell.present == nullptr)
      return cell.random;
    const Tensor<1, dim> gradient = cell.present->gradient(number);
    return gradient.norm() > 0. ? gradient : cell.random;
  }


#define INSTANTIATE(dim)                 \
  template class FixedAxis<dim>;         \
  template class StretchAxis<dim>;       \
  template class StressAxis<dim>;        \
  template class RadialAxis<dim>;        \
  template class SurfaceNormalAxis<dim>; \
  template class TangentialAxis<dim>;    \
  template class GradientAxis<dim>;
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
