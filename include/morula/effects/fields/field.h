// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fields_field_h
#define morula_effects_fields_field_h

#include <morula/effects/effect.h>
#include <morula/effects/fields/field_equation.h>
#include <morula/effects/fields/field_parameters.h>
#include <morula/effects/state/present_cell.h>
#include <morula/particles/boundary_state.h>

#include <optional>
#include <string>

namespace Morula
{
  /** How a field depends on time. */
  enum class FieldKind
  {
    steady,   // its steady state in every configuration
    transient // it changes with time
  };

  /** A cell's consumption of a field at a value c. */
  struct Uptake
  {
    /** k c, in the field's unit per day. */
    double used;
    /** d(kc)/dc, or 0 if that is negative, 1/day. */
    double slope;
  };

  /** What cells and the surface do to one field: its expressions. */
  template <int dim>
  class Field
  {
  public:
    /** @param number of the field. @throws InputError for an expression that
     *  cannot be parsed */
    Field(const FieldKeys          &keys,
          const unsigned int        number,
          const EffectSetting<dim> &setting);

    /** The name, as in Fields/Names. */
    const std::string &
    name() const
    {
      return name_;
    }

    /** The kind, as in Time. */
    FieldKind
    kind() const
    {
      return kind_;
    }

    /** Whether growth of cells dilutes it: the amount stays the same. */
    bool
    is_diluted() const
    {
      return diluted && kind_ == FieldKind::transient;
    }

    /** Whether something is done to it at the surface. */
    bool
    has_surface() const
    {
      return fixed_where || transfer_ || flux_where;
    }

    /** Whether what cells do to it depends on the field itself. */
    bool
    is_nonlinear() const
    {
      return has_nonlinear_source() || consumption.uses(field_variable(number));
    }

    /** Whether its diffusion or production depends on the field itself. */
    bool
    has_nonlinear_source() const;

    /** Whether what cells do to it depends on another field, by its number. */
    bool
    depends_on(const unsigned int other) const;

    /** D, if it is a plain number. */
    std::optional<double>
    uniform_diffusion() const
    {
      return diffusion_.is_constant() ? diffusion_.number() :
                                        std::optional<double>();
    }

    /** The value at a founder at @p X, at t = 0. @throws InputError */
    double
    initial(const Point<dim> &X) const;

    /** D of a cell, µm²/day. @throws InputError */
    double
    diffusion(const PresentCell<dim> &cell, const double t) const
    {
      return cell.value(diffusion_, t);
    }

    /** s of a cell, in the field's unit per day. @throws InputError */
    double
    production(const PresentCell<dim> &cell, const double t) const
    {
      return cell.value(production_, t);
    }

    /** What a cell uses up at the value @p c, k c, in the field's unit per day.
     *  @param cell has the value afterwards. @throws InputError */
    double
    used(PresentCell<dim> &cell, const double t, const double c) const;

    /**
     * What a cell uses up at the value @p c, linearised: doc/theory.md (11.4).
     * @param cell has the value, and others in between
     * @param scale of the field's values
     * @throws InputError
     */
    Uptake
    uptake(PresentCell<dim> &cell,
           const double      t,
           const double      c,
           const double      scale) const;

    /** Whether something is done to it at a boundary point that was at @p X at
     *  t = 0. */
    bool
    acts_on(const Point<dim> &X) const
    {
      return transfer_ || is_fixed(X) || takes_flux(X);
    }

    /** Whether it has the Value at a boundary point. */
    bool
    is_fixed(const Point<dim> &X) const;

    /** The Value there. @throws InputError */
    double
    value(const Point<dim> &X, const double t) const;

    /** The Transfer there, 0 if there is none, µm/day. @throws InputError */
    double
    transfer(const Point<dim> &X, const double t) const;

    /** Whether the Flux comes in at a boundary point. */
    bool
    takes_flux(const Point<dim> &X) const;

    /** The Flux there, 0 where none comes in, in the field's unit times µm/day.
     *  @throws InputError */
    double
    flux(const Point<dim> &X, const double t) const;

  private:
    std::string               name_;
    unsigned int              number;
    FieldKind                 kind_;
    bool                      diluted;
    Expression                diffusion_, production_, consumption;
    Expression                initial_, value_;
    std::optional<Expression> fixed_where, transfer_, flux_, flux_where;
  };
} // namespace Morula

#endif
