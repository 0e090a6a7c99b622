// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_division_division_rule_h
#define morula_effects_division_division_rule_h

#include <morula/base/expression_key.h>
#include <morula/effects/effect.h>
#include <morula/effects/state/present_cell.h>

#include <deal.II/base/point.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /** The keys of section "Proliferation/Cell cycle" that say along what cells
   *  divide, and where daughters are placed: with a cycle and without. */
  struct DivisionParameters : public EffectKeys
  {
    DivisionParameters()
    {
      stay_inside.with("paper", "false");
    }

    Key<std::string> axis{
      {this, "Proliferation/Cell cycle/Division axis"},
      "random",
      "n_s, chosen at every onset of S, or at a Division by size: 'random': "
      "uniform on the sphere (2-D: circle); 'fixed': along Fixed axis; in the "
      "present configuration, 'stretch': along the largest elastic stretch, "
      "'stress': along the most tensile stress, 'radial': away from Radial "
      "center, 'surface normal', 'tangential': across or along the surface "
      "that was nearest to the founder at t = 0, 'cell shape': along which the "
      "cell is longest; 'gradient of NAME': along which a field rises fastest.",
      {"random"}};

    /** κ */
    ExpressionKey axis_spread{
      {this, "Proliferation/Cell cycle/Axis spread"},
      "0",
      "kappa: concentration of the axes around Division axis, by the "
      "distribution of von Mises and Fisher: 0.1 is nearly random, 100 "
      "nearly exact. The root mean square angle tends to sqrt(2/kappa), in "
      "2-D sqrt(1/kappa). An expression; not negative; 0: no spread.",
      Evaluated::event,
      not_negative("(a concentration)",
                   "0 means no spread; otherwise, the larger the number, the "
                   "nearer are axes to what Division axis says.")};

    ExpressionKey least_anisotropy{
      {this, "Proliferation/Cell cycle/Least anisotropy"},
      "1.02",
      "Ratio of the two largest elastic stretches below which Division axis "
      "= stretch takes a random axis; for stress, of 1 + (sigma_1 - "
      "sigma_2)/(2 mu). An expression; at least 1.",
      Evaluated::event,
      {[](const double ratio) { return ratio >= 1.; },
       "a ratio of at least 1",
       "1 lets every cell follow its stretch; 1.02 leaves those to chance that "
       "can hardly tell."}};

    Key<bool> axis_follows_rotation{
      {this, "Proliferation/Cell cycle/Axis follows rotation"},
      false,
      "false: daughters are placed along n_s, as in the paper; "
      "true: along F_e n_s. For Division axis = random or fixed; others "
      "place them along the direction that they name."};

    Key<bool> stay_inside{
      {this, "Proliferation/Cell cycle/Stay inside surface"},
      true,
      "true: daughters are placed inside the whole surface; false: only "
      "behind its fixed and slip parts."};
  };

  /** Key of `Division axis = fixed`. */
  struct FixedAxisParameters : public EffectKeys
  {
    FixedAxisParameters();

    ExpressionKey axis{
      {this, "Proliferation/Cell cycle/Fixed axis"},
      "0, 0, 1",
      "Direction of n_s for Division axis = fixed, in the reference "
      "configuration, of any length but zero: 3 expressions separated by ';', "
      "or plain numbers separated by ','. 2-D: the first two components.",
      Evaluated::event,
      3};
  };

  /** What a division rule sees of a cell that enters S. */
  template <int dim>
  struct CellAtOnset
  {
    /** X of the founder, µm. */
    Point<dim> founder_position;
    /** F_e at the beginning of the step; the identity at t = 0. */
    Tensor<2, dim> elastic;
    /** The cell's own random unit vector, uniformly distributed: the axis for
     *  Division axis = random. */
    Tensor<1, dim> random;
    /** Its state at the beginning of the step; null before there are cells. */
    const PresentCell<dim> *present = nullptr;
    /** Time of that state, day. */
    double time = 0.;
    /** Ratio of two stretches, the larger over the smaller, >= 1, below which
     *  the cell cannot tell them apart: `Least anisotropy`. */
    double least_anisotropy = 1.;
  };

  /**
   * Chooses the axis along which a cell grows and divides, n_s of (6.2), for
   * `Proliferation/Cell cycle/Division axis`. A rule keeps nothing between
   * calls.
   */
  template <int dim>
  class DivisionRule : public Effect<dim>
  {
  public:
    /** The axis of the cycle that begins, of any length but zero. Called again
     *  with the same cell if a step is halved. */
    virtual Tensor<1, dim>
    axis(const CellAtOnset<dim> &cell) const = 0;

    /** Whether axis() is given in the present configuration: then n_s is the
     *  direction that the deformation carries to it, and daughters are placed
     *  along the direction to which n_s is carried. Otherwise it is n_s itself.
     */
    virtual bool
    is_present() const
    {
      return false;
    }

    /** Evaluates the axes of the founders, so that errors appear before the
     *  run. */
    void
    check(const Preview<dim> &scene) const override
    {
      // There are no cells yet. A direction stands for the random one, and the
      // undeformed state for theirs; only an error of the rule matters, and the
      // axis is dropped.
      Tensor<1, dim> direction;
      direction[0] = 1.;
      for (const Point<dim> &X : scene.founders)
        axis({X, Tensor<2, dim>(unit_symmetric_tensor<dim>()), direction});
    }

    /** Evaluates the axis of a founder in its state. */
    void
    check_cell(const PresentCell<dim> &founder,
               const double            step) const override;
  };

  /** `Division axis = gradient of NAME`: along the direction in which a field
   *  rises fastest now, and at random where it is uniform. */
  template <int dim>
  std::unique_ptr<const DivisionRule<dim>>
  gradient_axis(const std::string &field, const EffectSetting<dim> &setting);

  /** Along what the cells of a scene divide: the rules of its types, and keys.
   *  Axes are kept in the reference configuration. */
  template <int dim>
  class DivisionAxes
  {
  public:
    using Rules = std::vector<std::unique_ptr<const DivisionRule<dim>>>;

    /** @param of_type the rule of each type of cells, one of these, or null for
     *  a random axis; empty: all types have the first
     *  @throws InputError for expressions that cannot be parsed */
    DivisionAxes(const DivisionParameters                     &keys,
                 StateColumns<dim>                            &state,
                 const std::uint64_t                           seed,
                 Rules                                         rules   = {},
                 const std::vector<const DivisionRule<dim> *> &of_type = {});

    /** The rule of a type of cells, or null. */
    const DivisionRule<dim> *
    rule(const unsigned int type) const
    {
      if (!of_type.empty())
        return of_type[type];
      return rules.empty() ? nullptr : rules.front().get();
    }

    /**
     * The direction of a cell of which there is a rule, of any length but zero,
     * in the rule's configuration: the rule's, and the spread around it,
     * doc/theory.md (6.3d).
     * @param cell   in its state at @p t, day
     * @param random its own random unit vector
     * @param key    of the draw
     */
    Tensor<1, dim>
    direction(const PresentCell<dim> &cell,
              const double            t,
              const Tensor<1, dim>   &random,
              const std::uint64_t     key) const;

    /** The unit vector in the reference configuration along which a cell in its
     *  state at @p t (day) divides. @throws InputError */
    Tensor<1, dim>
    choose(const PresentCell<dim> &cell, const double t) const;

    /** Unit direction along which the daughters of a cell are placed.
     *  @param axis as choose() gave it. @param type of the cell */
    Tensor<1, dim>
    placement(const CellView<dim, const double> &cell,
              const Tensor<1, dim>              &axis,
              const unsigned int                 type) const
    {
      const DivisionRule<dim> *const rule = this->rule(type);
      Tensor<1, dim>                 now  = axis;
      if (rule != nullptr && rule->is_present())
        now = cell.F() * axis;
      else if (follow_rotation)
        now = cell.elastic_deformation() * axis;
      return now / now.norm();
    }

    const Rules rules;
    /** Whether an axis of the reference configuration is placed along F_e n_s,
     *  not n_s. */
    const bool follow_rotation;
    /** Whether daughters stay inside the whole surface, not only inside its
     *  held parts. */
    const bool stay_inside;

  private:
    Expression                             spread; // κ of (6.3d); 0: none
    Expression                             least_anisotropy;
    std::uint64_t                          seed;
    std::vector<const DivisionRule<dim> *> of_type;
  };
} // namespace Morula

#endif
