// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_division_division_rule_h
#define morula_effects_division_division_rule_h

#include <morula/effects/effect.h>

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

namespace Morula
{
  using namespace dealii;

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

  /** The configuration in which an axis is given. */
  enum class AxisFrame
  {
    /** That of t = 0: the axis is n_s itself. */
    reference,
    /** The present one: n_s is the direction that the deformation carries to
     *  the axis. The daughters are placed along the direction to which n_s is
     *  carried. */
    present
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

    /** The configuration in which axis() is given. */
    virtual AxisFrame
    frame() const
    {
      return AxisFrame::reference;
    }

    /** Evaluates the axes of the founders, so that errors appear before the
     *  run. */
    void
    check(const Preview<dim> &scene) const override;

    /** Evaluates the axis of a founder in its state. */
    void
    check_cell(const PresentCell<dim> &founder,
               const double            step) const override;
  };
} // namespace Morula

#endif
