// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_condition_keys_h
#define morula_effects_surface_condition_keys_h

#include <morula/base/expression_key.h>
#include <morula/effects/effect.h>

#include <string>

namespace Morula
{
  /** The keys of a condition that acts where an expression is positive. */
  struct ConditionKeys : public EffectKeys
  {
    /**
     * @param path     of the key that says where it acts; without text: nowhere
     * @param anywhere its text if the scene does not set it
     */
    ConditionKeys(const std::string &path,
                  const std::string &documentation,
                  const std::string &anywhere = "")
      : where({this, path}, anywhere, documentation, Evaluated::founder)
    {}

    ExpressionKey where;

    bool
    is_on() const override
    {
      return !where.empty();
    }
    EffectFacts
    facts() const override
    {
      return {&where};
    }
    std::string
    details() const override
    {
      return "";
    }
  };
} // namespace Morula

#endif
