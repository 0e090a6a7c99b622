// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_surface_forces_h
#define morula_simulation_surface_forces_h

#include <morula/effects/interaction.h>
#include <morula/effects/surface/boundary_conditions.h>
#include <morula/mechanics/spline_field.h>
#include <morula/mechanics/term.h>
#include <morula/output/rows.h>
#include <morula/particles/tissue.h>

#include <functional>
#include <string>
#include <vector>

namespace Morula
{
  /** What conditions and forces do to the tissue at the end of a step. */
  template <int dim>
  struct SurfaceForces
  {
    /** The rows of forces.csv: they are equal on all ranks. */
    std::vector<ForceRow> rows;
    /** The sum of all conditions' forces on each of this rank's boundary
     * points, in the order of the store, kPa µm^(dim-1). */
    std::vector<Tensor<1, dim>> of_points;
    /** The pressure there of what touches, kPa: the normal force on the points
     *  of their body within half a grid spacing over the area of these. The
     *  pressure of single points is no measure of accuracy, as facets of two
     *  surfaces do not match. Empty where nothing touches. */
    std::vector<double> contact_pressures;
  };

  /** Gives the boundary points their forces and the pressure of contact, if
   * they have columns for them. */
  template <int dim>
  void
  set_forces(const SurfaceForces<dim> &forces, Tissue<dim> &tissue);

  /**
   * Adds up the forces at the end of a step with this displacement, point by
   * point. They are those of the terms in whose sum Newton's method has found
   * the equilibrium.
   * Keeps references to all that it is given.
   */
  template <int dim>
  class ForceSums
  {
  public:
    /** @param tissue at the beginning of the step, as @p space. Collective. */
    ForceSums(const Tissue<dim>                   &tissue,
              const SplineSpace<dim>              &space,
              const TrilinosWrappers::MPI::Vector &u,
              const MPI_Comm                       comm);

    /** Adds a row for a force on the cells. Any term will do, as the row is a
     * sum over splines. */
    void
    add_force(const std::string &name, const Term<dim> &term);

    /** Adds a row for each condition that holds points, with the points at
     * which it wins. */
    void
    add_held(const BoundaryConditions<dim> &conditions, const Term<dim> &term);

    /** Adds rows for the conditions that load the surface, at the end @p t
     * (day) of the step. */
    void
    add_loads(const BoundaryConditions<dim> &conditions,
              const LoadedPoints<dim>       &points,
              const double                   t);

    /** Adds a row for a force that an effect has as a whole. */
    void
    add_part(const ForceOnPoints<dim> &force);

    /** Adds a row of this kind for each two bodies that touch, with the force
     *  of the one with the lower number on the other, and the pressure at all
     *  points. Collective. */
    void
    add_between(const std::string                    &kind,
                const std::vector<ForceBetween<dim>> &forces);

    /** The rows as sums over all ranks, and this rank's forces of points.
     *  Collective. */
    SurfaceForces<dim>
    result() const;

  private:
    /** Adds a row for the points of @p groups for which selects(p, force)
     * holds.
     *  @param term of all of these points */
    void
    add_row(
      const std::string                                               &kind,
      const std::string                                               &name,
      const PointGroups                                               &groups,
      const Term<dim>                                                 &term,
      const double                                                     factor,
      const std::function<bool(unsigned int, const Tensor<1, dim> &)> &selects);

    const Tissue<dim>           &tissue;
    const SplineSpace<dim>      &space;
    const DisplacementField<dim> displacement;
    const MPI_Comm               comm;
    SurfaceForces<dim>           mine; // of this rank
  };
} // namespace Morula

#endif
