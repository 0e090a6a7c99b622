// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_division_axis_rules_h
#define morula_effects_division_axis_rules_h

#include <morula/base/expression_key.h>
#include <morula/effects/division/division_rule.h>
#include <morula/effects/state/state_columns.h>

/**
 * The library's own division rules, for `Proliferation/Cell cycle/Division
 * axis`. If a cell has no state yet, or its state singles out no direction,
 * they take its random direction.
 */
namespace Morula
{
  using namespace dealii;

  /** Key of `Division axis = fixed`. */
  struct FixedAxisParameters : public EffectKeys
  {
    FixedAxisParameters();

    ExpressionKey axis{
      {this, "Proliferation/Cell cycle/Fixed axis"},
      "0, 0, 1",
      "Direction of n_s for Division axis = fixed, in the reference "
      "configuration, of any length but zero: 3 expressions separated by "
      "';', or plain numbers separated by ','. 2-D: the first two "
      "components.",
      Evaluated::event,
      3};
  };

  /** `Division axis = fixed`: along a vector in the reference configuration.
   *  @throws InputError from axis() if the vector is zero */
  template <int dim>
  class FixedAxis : public DivisionRule<dim>
  {
  public:
    using Parameters = FixedAxisParameters;

    FixedAxis(const Parameters &parameters, const EffectSetting<dim> &setting);

    Tensor<1, dim>
    axis(const CellAtOnset<dim> &cell) const override;

    /** Does nothing: check_cell() checks the founders that proliferate. */
    void
    check(const Preview<dim> &) const override
    {}

  private:
    const Expression direction;
  };

  /** A rule that has no keys of its own. */
  struct NoAxisKeys : public EffectKeys
  {
    using Keys::list;
    KeyList
    list() override
    {
      return {};
    }
  };

  /** The common base of rules that give the axis in the present configuration.
   */
  template <int dim>
  class PresentAxis : public DivisionRule<dim>
  {
  public:
    using Parameters = NoAxisKeys;

    AxisFrame
    frame() const override
    {
      return AxisFrame::present;
    }
  };

  /** `Division axis = stretch`: along the largest elastic stretch, (6.3a). */
  template <int dim>
  class StretchAxis : public PresentAxis<dim>
  {
  public:
    explicit StretchAxis(const NoAxisKeys &) {}

    Tensor<1, dim>
    axis(const CellAtOnset<dim> &cell) const override;
  };

  /** `Division axis = stress`: along the most tensile stress, (6.3b). */
  template <int dim>
  class StressAxis : public PresentAxis<dim>
  {
  public:
    explicit StressAxis(const NoAxisKeys &) {}

    Tensor<1, dim>
    axis(const CellAtOnset<dim> &cell) const override;
  };

  /** Key of `Division axis = radial`. */
  struct RadialAxisParameters : public EffectKeys
  {
    ExpressionKey center{
      {this, "Proliferation/Cell cycle/Radial center"},
      "0; 0; 0",
      "Point from which n_s points away for Division axis = radial. "
      "Expressions; 2-D: the first two. Units: um.",
      Evaluated::event,
      3};
  };

  /** `Division axis = radial`: from a point to where the cell is now. */
  template <int dim>
  class RadialAxis : public PresentAxis<dim>
  {
  public:
    using Parameters = RadialAxisParameters;

    RadialAxis(const Parameters &parameters, const EffectSetting<dim> &setting);

    Tensor<1, dim>
    axis(const CellAtOnset<dim> &cell) const override;

  private:
    const Expression center;
  };

  /** `Division axis = surface normal`: along the normal n of (6.3c). */
  template <int dim>
  class SurfaceNormalAxis : public PresentAxis<dim>
  {
  public:
    SurfaceNormalAxis(const NoAxisKeys &, const EffectSetting<dim> &setting);

    Tensor<1, dim>
    axis(const CellAtOnset<dim> &cell) const override;
  };

  /** `Division axis = tangential`: along the surface, uniform, m of (6.3c). */
  template <int dim>
  class TangentialAxis : public PresentAxis<dim>
  {
  public:
    TangentialAxis(const NoAxisKeys &, const EffectSetting<dim> &setting);

    Tensor<1, dim>
    axis(const CellAtOnset<dim> &cell) const override;
  };

  /** `Division axis = gradient of NAME`: along the direction in which a field
   *  rises fastest now. */
  template <int dim>
  class GradientAxis : public PresentAxis<dim>
  {
  public:
    /** @param field its name */
    GradientAxis(const std::string &field, const EffectSetting<dim> &setting);

    /** The axis is the random one where the field is uniform. */
    Tensor<1, dim>
    axis(const CellAtOnset<dim> &cell) const override;

  private:
    const unsigned int number; // of the field
  };
} // namespace Morula

#endif
