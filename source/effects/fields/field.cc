// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fields/field.h>

#include <algorithm>

namespace Morula
{
  namespace
  {
    /** k c is differentiated by such differences of c, relative to c and to the
     *  field's scale. They are so small that k does not change its kind, as at
     *  a threshold, and so large that k is told from rounding. */
    constexpr double difference = 1e-6, smallest_difference = 1e-9;

    /** The value at a place, as the expression's rule wants it. */
    template <int dim>
    double
    at_place(const Expression &expression, const Point<dim> &X, const double t)
    {
      // In 2-D Z is 0.
      VariableValues values;
      for (unsigned int d = 0; d < 3; ++d)
        values[d] = d < dim ? X[d] : 0.;
      values[static_cast<unsigned int>(Variable::t)] = t;
      return expression.value(values);
    }
  } // namespace


  template <int dim>
  Field<dim>::Field(const FieldKeys          &keys,
                    const unsigned int        number,
                    const EffectSetting<dim> &setting)
    : name_(keys.name)
    , number(number)
    , kind_(keys.is_steady() ? FieldKind::steady : FieldKind::transient)
    , diluted(keys.dilution)
    , diffusion_(setting.state.use(keys.diffusion))
    , production_(setting.state.use(keys.production))
    , consumption(setting.state.use(keys.consumption))
    , initial_(keys.initial.expression(dim))
    , value_(keys.value.expression(dim))
    , fixed_where(keys.fixed_where.optional(dim))
    , transfer_(keys.transfer.optional(dim))
    , flux_(keys.flux.optional(dim))
    , flux_where(keys.flux_where.optional(dim))
  {}


  template <int dim>
  bool
  Field<dim>::has_nonlinear_source() const
  {
    // Whether the field reads itself decides how it is solved, so it is asked
    // of the expressions rather than of a key.
    const Variable own = field_variable(number);
    return diffusion_.uses(own) || production_.uses(own);
  }


  template <int dim>
  bool
  Field<dim>::depends_on(const unsigned int other) const
  {
    const Variable variable = field_variable(other);
    return other != number &&
           (diffusion_.uses(variable) || production_.uses(variable) ||
            consumption.uses(variable));
  }


  template <int dim>
  double
  Field<dim>::initial(const Point<dim> &X) const
  {
    return at_place(initial_, X, 0.);
  }


  template <int dim>
  double
  Field<dim>::used(PresentCell<dim> &cell, const double t, const double c) const
  {
    cell.set_field(number, c);
    return cell.value(consumption, t) * c;
  }


  template <int dim>
  Uptake
  Field<dim>::uptake(PresentCell<dim> &cell,
                     const double      t,
                     const double      c,
                     const double      scale) const
  {
    // A rate that does not read the field has itself as its slope.
    if (!consumption.uses(field_variable(number)))
      {
        const double k = cell.value(consumption, t);
        return {k * c, k};
      }
    // The difference goes upwards, so that c stays in the range that the
    // expression was written for. A negative slope would make the matrix
    // indefinite, so it counts as 0: doc/theory.md (11.4).
    const double more =
      c + std::max(difference * c, smallest_difference * scale);
    const double used_more = used(cell, t, more), used_now = used(cell, t, c);
    return {used_now, std::max(0., (used_more - used_now) / (more - c))};
  }


  template <int dim>
  bool
  Field<dim>::is_fixed(const Point<dim> &X) const
  {
    return fixed_where && at_place(*fixed_where, X, 0.) > 0.;
  }


  template <int dim>
  double
  Field<dim>::value(const Point<dim> &X, const double t) const
  {
    return at_place(value_, X, t);
  }


  template <int dim>
  double
  Field<dim>::transfer(const Point<dim> &X, const double t) const
  {
    return transfer_ ? at_place(*transfer_, X, t) : 0.;
  }


  template <int dim>
  bool
  Field<dim>::takes_flux(const Point<dim> &X) const
  {
    // A point that has the Value takes no flux.
    return flux_where && at_place(*flux_where, X, 0.) > 0. && !is_fixed(X);
  }


  template <int dim>
  double
  Field<dim>::flux(const Point<dim> &X, const double t) const
  {
    return takes_flux(X) ? at_place(*flux_, X, t) : 0.;
  }


  template class Field<2>;
  template class Field<3>;
} // namespace Morula
