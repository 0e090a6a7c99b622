// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fields_field_parameters_h
#define morula_effects_fields_field_parameters_h

#include <morula/base/expression_key.h>
#include <morula/effects/effect.h>

#include <deque>
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
    Key<std::string> time;
    ExpressionKey    diffusion;
    ExpressionKey    production;
    ExpressionKey    consumption;
    ExpressionKey    initial;
    ExpressionKey    fixed_where;
    ExpressionKey    value;
    ExpressionKey    transfer;
    ExpressionKey    flux;
    ExpressionKey    flux_where;
    Key<bool>        dilution;
    Key<bool>        exchanged;

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

    /** What --explain says of it. */
    std::string
    details() const;

    /**
     * Refuses what contradicts itself.
     * @throws InputError
     */
    void
    check(const unsigned int dim) const;

    using Keys::list;
    KeyList
    list() override;
  };

  /** Section "Fields": names first, then a section for each of them. */
  struct FieldsParameters : public EffectKeys
  {
    FieldsParameters();

    Key<std::string>      names;
    std::deque<FieldKeys> fields;

    bool
    is_on() const override
    {
      return !fields.empty();
    }
    void
    check_with(const RestOfScene &scene) const override;
    bool
    needs_surface() const override;
    std::vector<const ExpressionKey *>
    places() const override;
    std::string
    details() const override
    {
      return names;
    }
    std::string
    further_lines(const RestOfScene &) const override;
    std::vector<NamedField>
    named_fields() const override;

    const AnyKey *
    names_key() const override
    {
      return &names;
    }
    /** Refuses names that expressions or tables cannot have, or that are given
     *  twice, as well. */
    void
    declare_sections(const std::string &names) override;

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
} // namespace Morula

#endif
