// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_division_division_axes_h
#define morula_effects_division_division_axes_h

#include <morula/effects/division/division_parameters.h>
#include <morula/effects/division/division_rule.h>
#include <morula/effects/state/present_cell.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace Morula
{
  using namespace dealii;

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

  /** What besides the rule decides about an axis. */
  struct AxisDraw
  {
    /** κ of doc/theory.md (6.3d); 0: no spread. */
    double spread;
    /** See CellAtOnset. */
    double least_anisotropy;
    /** Seed of the scene, and key of the draw. */
    std::uint64_t seed, key;
  };

  /**
   * A direction, of any length but zero, in the rule's frame: the rule's, and
   * the spread around it, doc/theory.md (6.3d).
   * @param cell   in its state at @p t, day
   * @param random its own random unit vector
   */
  template <int dim>
  Tensor<1, dim>
  axis_by_rule(const DivisionRule<dim> &rule,
               const PresentCell<dim>  &cell,
               const double             t,
               const Tensor<1, dim>    &random,
               const AxisDraw          &draw);

  /** Along what the cells of a scene divide: the rules of its types, and keys.
   *  Axes are kept in the reference configuration. */
  template <int dim>
  class DivisionAxes
  {
  public:
    /** @throws InputError for expressions that cannot be parsed */
    DivisionAxes(const DivisionParameters &keys,
                 StateColumns<dim>        &state,
                 DivisionRules<dim>        rules,
                 const std::uint64_t       seed);

    /** All rules. */
    const DivisionRules<dim> &
    rules() const
    {
      return all;
    }

    /** What decides about the axis of a cell in its state at @p t (day),
     * besides its rule. @param key of the draw. @throws InputError */
    AxisDraw
    draw(const PresentCell<dim> &cell,
         const double            t,
         const std::uint64_t     key) const
    {
      return {cell.value(spread, t),
              cell.value(least_anisotropy, t),
              seed,
              key};
    }

    /** The unit vector in the reference configuration along which a cell in its
     *  state at @p t (day) divides. @throws InputError */
    Tensor<1, dim>
    choose(const PresentCell<dim> &cell, const double t) const;

    /** Unit direction along which the daughters of a cell are placed.
     *  @param axis as choose() gave it. @param type of the cell */
    Tensor<1, dim>
    placement(const CellView<dim, const double> &cell,
              const Tensor<1, dim>              &axis,
              const unsigned int                 type) const;

    /** Whether an axis of the reference configuration is placed along F_e n_s,
     *  not n_s. */
    bool
    follow_rotation() const
    {
      return follows_rotation;
    }

    /** Whether daughters stay inside the whole surface. */
    bool
    stay_inside() const
    {
      return stay_inside_;
    }

  private:
    Expression         spread, least_anisotropy;
    bool               follows_rotation, stay_inside_;
    DivisionRules<dim> all;
    std::uint64_t      seed;
  };
} // namespace Morula

#endif
