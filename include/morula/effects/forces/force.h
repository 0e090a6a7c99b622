// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_forces_force_h
#define morula_effects_forces_force_h

#include <morula/effects/effect.h>
#include <morula/effects/state/present_cell.h>
#include <morula/mechanics/material_points.h>
#include <morula/mechanics/term.h>
#include <morula/particles/tissue.h>

#include <memory>
#include <optional>
#include <vector>

namespace Morula
{
  /** A force on the cells, as a term of the momentum balance. */
  template <int dim>
  class Force : public Effect<dim>
  {
  public:
    /**
     * The term at the end @p t1 (day) of a step from @p t0. Collective: all
     * ranks ask at once.
     * @param tissue    at the beginning of the step
     * @param reader    for its cells: present_cell(tissue, p, reader) is cell p
     *                  with its state, which evaluates expressions
     * @param positions of the cells in their grid cells, in the order of
     *                  Tissue::cells()
     * @throws InputError if an expression has no value
     */
    virtual std::unique_ptr<Term<dim>>
    term(const Tissue<dim>        &tissue,
         const CellReader<dim>    &reader,
         const GroupedPoints<dim> &positions,
         const double              t0,
         const double              t1) const = 0;

    /**
     * Friction with surroundings that stand still, which the term has in a step
     * from @p t0 (day) on: the force per V⁰ over the velocity, kPa day/µm², of
     * each of Tissue::cells(). Empty: none. No rigid motion against it is taken
     * out of the step: doc/theory.md, section 4.4. Not collective.
     * @throws InputError if an expression has no value
     */
    virtual std::vector<double>
    friction(const Tissue<dim> & /*tissue*/,
             const CellReader<dim> & /*reader*/,
             const double /*t0*/) const
    {
      return {};
    }

    /** The load on a cell per V⁰ at time @p t (day), kPa/µm, if its own state
     *  tells that. For what is said before the run. @throws InputError */
    virtual std::optional<Tensor<1, dim>>
    load_of(const PresentCell<dim> & /*cell*/, const double /*t*/) const
    {
      return {};
    }

    /** friction() of a cell, if the force has any. @throws InputError */
    virtual std::optional<double>
    friction_of(const PresentCell<dim> & /*cell*/, const double /*t0*/) const
    {
      return {};
    }
  };

} // namespace Morula

#endif
