// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fate_dividing_fate_h
#define morula_effects_fate_dividing_fate_h

#include <morula/effects/division/division_axes.h>
#include <morula/effects/fate/fate.h>

#include <memory>
#include <utility>

namespace Morula
{
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

    void
    set_axes(std::shared_ptr<const DivisionAxes<dim>> axes) override
    {
      this->axes = std::move(axes);
    }

    bool
    stays_inside() const override
    {
      return axes && axes->stay_inside();
    }

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

    /** Null before a scene is complete. */
    std::shared_ptr<const DivisionAxes<dim>> axes;
  };
} // namespace Morula

#endif
