// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fields/field.h>

#include <algorithm>
#include <vector>

namespace Morula
{
  namespace
  {
    /** Differences of c by which k c is differentiated, relative to c and to
     *  the field's scale: k is not to change its kind, but to be told from
     *  rounding. */
    constexpr double difference = 1e-6, smallest_difference = 1e-9;

    /** The value at a place, as the expression's rule wants it. */
    template <int dim>
    double
    at_place(const Expression &expression, const Point<dim> &X, const double t)
    {
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
    , steady(keys.is_steady())
    , diluted(keys.dilution)
    , diffusion_(setting.state.use(keys.diffusion))
    , production(setting.state.use(keys.production))
    , consumption(setting.state.use(keys.consumption))
    , initial_(keys.initial.expression(dim))
    , value_(keys.value.expression(dim))
    , fixed_where(keys.fixed_where.optional(dim))
    , transfer_(keys.transfer.optional(dim))
  {}


  template <int dim>
  const std::string &
  Field<dim>::name() const
  {
    return name_;
  }


  template <int dim>
  bool
  Field<dim>::is_steady() const
  {
    return steady;
  }


  template <int dim>
  bool
  Field<dim>::is_diluted() const
  {
    return diluted && !steady;
  }


  template <int dim>
  bool
  Field<dim>::has_surface() const
  {
    return fixed_where || transfer_;
  }


  template <int dim>
  bool
  Field<dim>::is_nonlinear() const
  {
    const Variable own = field_variable(number);
    return diffusion_.uses(own) || production.uses(own) ||
           consumption.uses(own);
  }


  template <int dim>
  std::optional<double>
  Field<dim>::uniform_diffusion() const
  {
    return diffusion_.is_constant() ? diffusion_.plain_number() :
                                      std::optional<double>();
  }


  template <int dim>
  double
  Field<dim>::initial(const Point<dim> &X) const
  {
    return at_place(initial_, X, 0.);
  }


  template <int dim>
  FieldAtCell
  Field<dim>::at_cell(const PresentCell<dim> &cell,
                      const double            t,
                      const double            c,
                      const double            known,
                      const double            scale) const
  {
    double k     = cell.value(consumption, t);
    double slope = k;
    if (consumption.uses(field_variable(number)))
      {
        const double more =
          c + std::max(difference * c, smallest_difference * scale);
        const CellView<dim, const double> &view = cell.cell();
        std::vector<double>         row(view.row().begin(), view.row().end());
        const CellView<dim, double> other(make_array_view(row), view.columns());
        other.set(cell.reader().columns.fields[number], more);
        const double k_more =
          PresentCell<dim>(other, cell.id(), cell.position(), cell.reader())
            .value(consumption, t);
        slope = std::max(0., (k_more * more - k * c) / (more - c));
      }
    return {cell.cell().volume(),
            diffusion(cell, t),
            slope,
            cell.value(production, t) - k * c + slope * (c - known)};
  }


  template <int dim>
  double
  Field<dim>::diffusion(const PresentCell<dim> &cell, const double t) const
  {
    return cell.value(diffusion_, t);
  }


  template <int dim>
  bool
  Field<dim>::acts_on(const Point<dim> &X) const
  {
    return transfer_ || is_fixed(X);
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


  template class Field<2>;
  template class Field<3>;
} // namespace Morula
