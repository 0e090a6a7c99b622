// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fields_field_h
#define morula_effects_fields_field_h

#include <morula/base/expression_key.h>
#include <morula/effects/effect.h>
#include <morula/effects/state/present_cell.h>
#include <morula/particles/boundary_state.h>

#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace Morula
{
  /** Section "Fields/NAME". */
  struct FieldKeys : public Keys
  {
    /** @param name of the field */
    explicit FieldKeys(const std::string &name);

    std::string      name;
    Key<std::string> time{
      {this, "Time"},
      "steady",
      "steady: in each configuration the field has its steady state. "
      "transient: it changes with time.",
      {"steady|transient"}};

    ExpressionKey diffusion{
      {this, "Diffusion"},
      "",
      "Diffusion coefficient D, an expression of the cells' state; > "
      "0. Units: um^2/day.",
      Evaluated::step,
      positive("um^2/day", "Oxygen has about 1.7e8.")};

    ExpressionKey production{
      {this, "Production"},
      "0",
      "What a cell makes of it per time and volume, an expression of "
      "the cell's state; not negative. In the field's unit per day.",
      Evaluated::step,
      not_negative("a day", "What a cell uses up is Consumption.")};

    ExpressionKey consumption{
      {this, "Consumption"},
      "0",
      "Rate k at which a cell uses it up, k times the field, an expression of "
      "the cell's state, which may read the field itself: 4e6/(0.5 + NAME) "
      "saturates; not negative. Units: 1/day.",
      Evaluated::step,
      not_negative("1/day", "What a cell makes is Production.")};

    ExpressionKey initial{
      {this, "Initial"},
      "0",
      "The field at t = 0; for a steady field, where its search begins. Not "
      "negative. An expression of X, Y, Z (um).",
      Evaluated::founder,
      not_negative("(a concentration)", "0 is none at all.")};

    ExpressionKey fixed_where{
      {this, "Fixed where"},
      "",
      "At boundary points at which this is > 0 the field has Value; "
      "empty: nowhere. An expression of X, Y, Z (um).",
      Evaluated::founder};

    ExpressionKey value{
      {this, "Value"},
      "0",
      "The field at the fixed boundary points, and outside of the others "
      "if there is a Transfer; not negative. An expression of X, Y, Z "
      "(um), t (day).",
      Evaluated::place,
      not_negative("(a concentration)", "0 is none at all.")};

    ExpressionKey transfer{
      {this, "Transfer"},
      "",
      "At boundary points that are not fixed -D dc/dn = Transfer (c - "
      "Value); not negative; empty: nothing passes there. An "
      "expression of X, Y, Z (um), t (day). Units: um/day.",
      Evaluated::place,
      not_negative("um/day", "0 lets nothing pass.")};

    ExpressionKey flux{
      {this, "Flux"},
      "",
      "What comes in through the surface per time and area, D dc/dn, where "
      "Flux where holds; not negative. An expression of X, Y, Z (um), t "
      "(day). In the field's unit times um/day.",
      Evaluated::place,
      not_negative("um/day (times a concentration)",
                   "What leaves the tissue does so by a Transfer.")};

    ExpressionKey flux_where{
      {this, "Flux where"},
      "",
      "At boundary points at which this is > 0 and that are not fixed "
      "the Flux comes in, besides what a Transfer lets pass; empty: "
      "nowhere. An expression of X, Y, Z (um).",
      Evaluated::founder};

    Key<bool> dilution{
      {this, "Dilution"},
      true,
      "Whether a transient field becomes less where cells grow, so that its "
      "amount stays. A steady field is not diluted."};

    Key<bool> exchanged{
      {this, "Exchanged"},
      false,
      "Whether a cell takes its amount of a transient field along "
      "when it exchanges its place (Rearrangement), as what is "
      "inside of cells; false: the amount stays at the place."};

    /** Whether the field has its steady state in every configuration. */
    bool
    is_steady() const
    {
      return time == "steady";
    }

    /** Whether there is a value that it has at the surface, or outside. */
    bool
    has_value() const
    {
      return !fixed_where.empty() || !transfer.empty();
    }

    /** Whether something is done to it at the surface. */
    bool
    has_surface() const
    {
      return has_value() || !flux_where.empty();
    }

    /**
     * Refuses what contradicts itself.
     * @throws InputError
     */
    void
    check(const unsigned int dim) const;
  };

  /** Section "Fields": names first, then a section for each of them. */
  struct FieldsParameters : public EffectKeys
  {
    Key<std::string> names{
      {this, "Fields/Names"},
      "",
      "Fields that diffuse through the tissue, separated by commas. Each "
      "has a section of this name, and expressions of cells may have its "
      "value at the cell as a variable. Empty: there are none."};
    std::deque<FieldKeys> fields;

    bool
    is_on() const override
    {
      return !fields.empty();
    }
    void
    check(const SceneKeys &scene, Review &review) const override;
    EffectFacts
    facts() const override;
    /** Refuses names that expressions or tables cannot have, or that are given
     *  twice, as well. */
    void
    declare_sections(const std::string              &names,
                     const std::vector<std::string> &types) override;

    using Keys::list;
    KeyList
    list() override;
  };

  /** Warns of fields that stay zero, of conditions that others leave nothing to
   *  or that act on few points, and of fields that hardly reach into the
   *  tissue. Collective. */
  template <int dim>
  void
  review_fields(const FieldsParameters &parameters,
                const Preview<dim>     &scene,
                Review                 &review);

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
    /** The name, as in Fields/Names. */
    const std::string name;

    /** The kind, as in Time. */
    const FieldKind kind;

    /** D of cells, µm²/day, and s, in the field's unit per day. */
    const Expression diffusion, production;

    /** The value at founders, at t = 0, and the Value at the surface. */
    const Expression initial, value;

    /** @param number of the field. @throws InputError for an expression that
     *  cannot be parsed */
    Field(const FieldKeys          &keys,
          const unsigned int        number,
          const EffectSetting<dim> &setting);

    /** Whether growth of cells dilutes it: the amount stays the same. */
    bool
    is_diluted() const
    {
      return diluted && kind == FieldKind::transient;
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
    has_nonlinear_source() const
    {
      // Whether the field reads itself decides how it is solved, so it is asked
      // of the expressions rather than of a key.
      const Variable own = field_variable(number);
      return diffusion.uses(own) || production.uses(own);
    }

    /** Whether what cells do to it depends on another field, by its number. */
    bool
    depends_on(const unsigned int other) const
    {
      const Variable variable = field_variable(other);
      return other != number &&
             (diffusion.uses(variable) || production.uses(variable) ||
              consumption.uses(variable));
    }

    /** D, if it is a plain number. */
    std::optional<double>
    uniform_diffusion() const
    {
      return diffusion.is_constant() ? diffusion.number() :
                                       std::optional<double>();
    }

    /** What a cell uses up at the value @p c, k c, in the field's unit per day.
     *  @param cell has the value afterwards. @throws InputError */
    double
    used(PresentCell<dim> &cell, const double t, const double c) const
    {
      cell.set_field(number, c);
      return cell.value(consumption, t) * c;
    }

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
    is_fixed(const Point<dim> &X) const
    {
      return fixed_where && fixed_where->value(X, 0.) > 0.;
    }

    /** The Transfer there, 0 if there is none, µm/day. @throws InputError */
    double
    transfer(const Point<dim> &X, const double t) const
    {
      return transfer_ ? transfer_->value(X, t) : 0.;
    }

    /** Whether the Flux comes in at a boundary point. */
    bool
    takes_flux(const Point<dim> &X) const
    {
      // A point that has the Value takes no flux.
      return flux_where && flux_where->value(X, 0.) > 0. && !is_fixed(X);
    }

    /** The Flux there, 0 where none comes in, in the field's unit times µm/day.
     *  @throws InputError */
    double
    flux(const Point<dim> &X, const double t) const
    {
      return takes_flux(X) ? flux_->value(X, t) : 0.;
    }

  private:
    unsigned int              number;
    bool                      diluted;
    Expression                consumption;
    std::optional<Expression> fixed_where, transfer_, flux_, flux_where;
  };
} // namespace Morula

#endif
