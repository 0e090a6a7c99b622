// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_equation_h
#define morula_effects_equation_h

#include <morula/base/agreement.h>
#include <morula/effects/effect.h>
#include <morula/effects/tables.h>
#include <morula/mechanics/equilibrium.h>

#include <deal.II/base/timer.h>

#include <functional>
#include <memory>
#include <vector>

namespace Morula
{
  /** What an equation may use in a run, which outlives it. */
  template <int dim>
  struct RunTools
  {
    /** Makes what reads the cells' variables at a time, day. */
    std::function<CellReader<dim>(double)> reader;
    MakeLinearSolver                       make_solver;
    TimerOutput                           &timer;
    Announce                               announce;
  };

  /**
   * An equation in the steps of a run. It may keep what serves several calls,
   * as a solver, but nothing that a resumed run would miss. All calls are
   * collective, and throw InputError and StepFailed on all ranks.
   */
  template <int dim>
  class EquationInRun
  {
  public:
    virtual ~EquationInRun() = default;

    /** Another step begins: counts of the step before are over. */
    virtual void
    begin_step()
    {}

    /** Gives cells what holds in the configuration at @p t, day. */
    virtual void
    settle(Tissue<dim> & /*tissue*/,
           const SplineSpace<dim> & /*space*/,
           const double /*t*/)
    {}

    /** Gives cells what they have at the end of the step from @p t to
     *  @p t_next, day, when they have their new volumes but not yet their new
     *  places. */
    virtual void
    advance(Tissue<dim> & /*tissue*/,
            const SplineSpace<dim> & /*space*/,
            const double /*t*/,
            const double /*t_next*/)
    {}

    /** The splines of the next call will stand elsewhere. */
    virtual void
    forget_configuration()
    {}

    /** Gives the values of the columns of Tables::add_number(). */
    virtual void
    describe(const Tissue<dim> &, NamedNumbers &) const
    {}
  };

  /** Something that the cells of a tissue have by an equation on the splines of
   *  its configurations, as fields that diffuse. */
  template <int dim>
  class Equation : public Effect<dim>
  {
  public:
    /** The equation in a run. */
    virtual std::unique_ptr<EquationInRun<dim>>
    in_run(const RunTools<dim> &tools) const = 0;

    /** Whether settle() changes cells. */
    virtual bool
    is_steady() const = 0;

    /** Whether advance() changes cells. */
    virtual bool
    is_transient() const = 0;

    /** Columns of amounts per volume: the amounts of a cell stay when its
     *  volume changes, and go to cells beside it when it has shrunk away. */
    virtual std::vector<Column<double>>
    densities() const
    {
      return {};
    }

    /** Refuses what the equation cannot have at the boundary points of this
     *  rank, which stand at @p X (µm) at t = 0. Collective.
     *  @throws InputError */
    virtual void
    check_surface(const std::vector<Point<dim>> & /*X*/,
                  const MPI_Comm /*comm*/) const
    {}
  };
} // namespace Morula

#endif
