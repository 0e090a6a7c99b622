// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fate_dividing_fate_h
#define morula_effects_fate_dividing_fate_h

#include <morula/effects/division/division_rule.h>
#include <morula/effects/fate/fate.h>

#include <memory>
#include <vector>

namespace Morula
{
  /** The rules for the axes along which cells divide. */
  template <int dim>
  struct DivisionRules
  {
    std::vector<std::unique_ptr<const DivisionRule<dim>>> list;
    /** The rule of each type of cells, one of these, or null for a random axis;
     *  empty: all types have the first. */
    std::vector<const DivisionRule<dim> *> of_type;

    /** The rule of a type of cells, or null. */
    const DivisionRule<dim> *
    rule(const unsigned int type) const;
  };

  /** A fate that divides cells. */
  template <int dim>
  class DividingFate : public Fate<dim>
  {
  public:
    bool
    divides() const override
    {
      return true;
    }

    /** The rules, or null. */
    virtual const DivisionRules<dim> *
    division_rules() const = 0;

    /** The rule of a type of cells, or null. */
    const DivisionRule<dim> *
    rule(const unsigned int type) const;

    void
    check(const Preview<dim> &scene) const override;

    void
    review(const Preview<dim> &scene, Review &review) const override;

  protected:
    /** Halves the shape of a daughter whose row is still her mother's. */
    void
    halve(const CellView<dim, double> &daughter,
          const StateColumns<dim>     &columns) const;
  };
} // namespace Morula

#endif
