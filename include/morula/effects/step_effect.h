// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_step_effect_h
#define morula_effects_step_effect_h

#include <morula/effects/effect.h>
#include <morula/effects/state/present_cell.h>
#include <morula/effects/tables.h>

namespace Morula
{
  /** A moment of a run. */
  template <int dim>
  struct MomentOfRun
  {
    /** The time of the cells' state, day. */
    double t;
    /** Length of the step, day; 0 at the start of a run. */
    double dt;
    /** Reads the cells' variables. */
    const CellReader<dim> &reader;
    /** What outlives a step, of those declared by Tables::keep_number(). The
     *  same on all ranks. */
    NamedNumbers &kept;
    /** Values of the columns of Tables::add_number(), likewise. */
    NamedNumbers &of_step;
    /** Adds a line to the log. Collective. */
    std::function<void(const std::string &)> say = {};
  };

  /**
   * The moments of a run at which an effect may act on the tissue as a whole,
   * or keep account of it. They see a tissue that is whole: no attempt is under
   * way, so that a step that is halved calls nothing twice. Collective.
   */
  template <int dim>
  class Moments
  {
  public:
    virtual ~Moments() = default;

    /** The run begins at t = 0: may write the cells' columns, but for
     *  deformation and growth. Not called where a run is resumed. */
    virtual void
    settle(Tissue<dim> &, const MomentOfRun<dim> &) const
    {}

    /** The cells have moved, divided and been removed, at @p moment.t the end
     * of the step: may let cells change places, before the surface follows. */
    virtual void
    rearrange(Tissue<dim> &, const MomentOfRun<dim> &) const
    {}

    /** The surface has its points at @p moment.t, which the next step begins
     *  with: at t = 0, and at the end of each step, before after(). May write
     *  columns likewise. */
    virtual void
    surfaced(Tissue<dim> &, const MomentOfRun<dim> &) const
    {}

    /** The step is done, at @p moment.t its end: cells have moved, divided and
     *  been removed. May write columns likewise. */
    virtual void
    after(Tissue<dim> &, const MomentOfRun<dim> &) const
    {}

    /** Gives the values of the columns of Tables::add_number() that follow from
     *  the state at @p moment.t. Nothing is to be kept. */
    virtual void
    describe(const Tissue<dim> &, const MomentOfRun<dim> &) const
    {}
  };

  /** Something that happens to the tissue as a whole once a step. */
  template <int dim>
  class StepEffect : public Effect<dim>, public Moments<dim>
  {};

  /**
   * What a cell has besides its growth and its fates: a state in columns of its
   * own, which other effects may read by the columns' names. The columns
   * declare what a daughter inherits.
   */
  template <int dim>
  class Trait : public Effect<dim>
  {
  public:
    void
    advance(const PresentCell<dim>      &before,
            const CellView<dim, double> &after,
            const double                 t0,
            const double                 t1) const override = 0;
  };
} // namespace Morula

#endif
