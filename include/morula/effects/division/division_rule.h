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
    /** Unit vector, uniformly distributed and the cell's own: what Division
     *  axis = random would take. */
    Tensor<1, dim> random;
    /** Its state at the beginning of the step; null before there are cells. */
    const PresentCell<dim> *present = nullptr;
    /** Time of that state, day. */
    double time = 0.;
    /** Ratio of a larger to a smaller stretch, >= 1, below which the cell
     *  cannot tell them apart: `Least anisotropy`. */
    double least_anisotropy = 1.;
  };

  /** What the direction of an axis is given in. */
  enum class AxisFrame
  {
    /** The body as it was at t = 0: n_s itself. */
    reference,
    /** The present one: n_s is what the deformation will carry to it, and the
     *  daughters are placed along the direction that n_s is carried to. */
    present
  };

  /**
   * Along which axis a cell grows and divides: n_s of (6.2), for
   * `Proliferation/Cell cycle/Division axis`. A rule keeps nothing between
   * calls.
   */
  template <int dim>
  class DivisionRule : public Effect<dim>
  {
  public:
    /** The axis of the cycle that begins, of any length but zero. Called again
     *  with the same cell where a step is halved. */
    virtual Tensor<1, dim>
    axis(const CellAtOnset<dim> &cell) const = 0;

    /** What axis() is given in. */
    virtual AxisFrame
    frame() const;

    /** Asks for the axes of the founders. */
    void
    check(const Preview<dim> &scene) const override;

    /** Asks for the axis of a founder in its state. */
    void
    check_cell(const PresentCell<dim> &founder,
               const double            step) const override;
  };
} // namespace Morula

#endif
