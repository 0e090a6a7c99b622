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

    /** As in Fields/Names. */
    const std::string &
    name() const;

    /** Whether it has its steady state in every configuration. */
    bool
    is_steady() const;

    /** Whether its amount stays where cells grow. */
    bool
    is_diluted() const;

    /** Whether something is done to it at the surface. */
    bool
    has_surface() const;

    /** Whether what cells do to it depends on the field itself. */
    bool
    is_nonlinear() const;

    /** D, if it is a plain number. */
    std::optional<double>
    uniform_diffusion() const;

    /** At a founder at @p X, at t = 0. @throws InputError */
    double
    initial(const Point<dim> &X) const;

    /**
     * What a cell does to it, linearised at the value @p c that the cell has:
     * doc/theory.md (11.4).
     * @param known what is not sought of c
     * @param scale of the field's values
     * @throws InputError
     */
    FieldAtCell
    at_cell(const PresentCell<dim> &cell,
            const double            t,
            const double            c,
            const double            known,
            const double            scale) const;

    /** D of a cell. @throws InputError */
    double
    diffusion(const PresentCell<dim> &cell, const double t) const;

    /** Whether something is done to it at a boundary point that was at @p X at
     *  t = 0. */
    bool
    acts_on(const Point<dim> &X) const;

    /** Whether it has the Value at a boundary point. */
    bool
    is_fixed(const Point<dim> &X) const;

    /** The Value there. @throws InputError */
    double
    value(const Point<dim> &X, const double t) const;

    /** The Transfer there, 0 if there is none, µm/day. @throws InputError */
    double
    transfer(const Point<dim> &X, const double t) const;

  private:
    std::string               name_;
    unsigned int              number;
    bool                      steady, diluted;
    Expression                diffusion_, production, consumption;
    Expression                initial_, value_;
    std::optional<Expression> fixed_where, transfer_;
  };
} // namespace Morula

#endif
