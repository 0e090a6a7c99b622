// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// A division rule: cells divide along a given direction.

#ifndef own_effects_along_rule_h
#define own_effects_along_rule_h

#include <morula/base/expression_key.h>
#include <morula/effects/division/division_rule.h>

namespace Own
{
  using namespace Morula;

  struct AlongKeys : public EffectKeys
  {
    Key<std::string> direction{{this, "Direction"}, "0, 1, 0", "Of the axis."};
  };

  template <int dim>
  class AlongRule : public DivisionRule<dim>
  {
  public:
    using Parameters = AlongKeys;

    explicit AlongRule(const Parameters &parameters)
      : direction(
          unit_vector<dim>(parameters.direction.path(), parameters.direction))
    {}

    Tensor<1, dim>
    axis(const CellAtOnset<dim> &) const override
    {
      return direction;
    }

  private:
    const Tensor<1, dim> direction;
  };
} // namespace Own

#endif
