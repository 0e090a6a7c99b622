// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fields_field_equation_h
#define morula_effects_fields_field_equation_h

#include <morula/grid/spline_space.h>
#include <morula/mechanics/material_points.h>
#include <morula/mechanics/term.h>

#include <deal.II/base/tensor.h>

#include <mpi.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace Morula
{
  /** The coefficients of a field's equation in one cell. */
  struct FieldAtCell
  {
    /** V, µm^dim. */
    double volume;
    /** D, µm²/day. */
    double diffusion;
    /** k: the decay rate of the unknown here, plus 1/dt for a transient field;
     *  1/day. */
    double rate;
    /** s: the source, in the field's unit per day. */
    double load;
  };

  /** The coefficients of a field's equation at one boundary point. */
  template <int dim>
  struct FieldAtSurface
  {
    /** The product a D n, where the field has a value there; else zero. */
    Tensor<1, dim> flux;
    /** The area a times the transfer coefficient, µm^dim/day. */
    double weight;
    /** The product a D, where the field has a value there; else 0. */
    double fixed;
    /** The field that is prescribed or outside. */
    double value;
    /** The area a times the flux that is prescribed, in the field's unit times
     *  µm^dim/day. */
    double inflow;
  };

  /**
   * The equation of a field in a configuration, doc/theory.md (11.2), for
   * Assembly<dim, 1>. The unknown is added to a known field. The matrix belongs
   * to the unknown; the residual is the load minus the known field's diffusion
   * and its exchange at the surface.
   */
  template <int dim>
  struct FieldEquation
  {
    using Local = LocalEquations<dim, 1>;
    using Known = LocalField<dim, 1>;

    /** Adds the equations of an active grid cell. */
    bool
    operator()(const unsigned int grid_cell,
               const Known       &known,
               Local             &local) const;

    /** Whether the field has a value at some boundary point of this rank. */
    bool
    has_fixed_value() const
    {
      return std::any_of(surface.begin(), surface.end(), [](const auto &point) {
        return point.fixed > 0.;
      });
    }

    /** Places of the cells and boundary points in their grid cells. */
    GroupedPoints<dim> cell_places, surface_places;
    /** The coefficients at cells and at boundary points, in the order of the
     *  places. */
    std::vector<FieldAtCell>         cells;
    std::vector<FieldAtSurface<dim>> surface;
    /** By grid cell: 1/sqrt(D/k), the inverse of the length over which a fixed
     *  value falls off, per µm; empty if that is many grid cells everywhere. */
    std::vector<double> steepness;
    /** What the penalty of fixed values is multiplied by. */
    double raised = 1.;
    /** By grid cell: whether N_a N_b is lumped, since the field ends there;
     *  empty: nowhere. */
    std::vector<bool> lumped;

  private:
    /** The penalty of a fixed value in a grid cell or the transfer,
     * doc/theory.md (11.3). */
    double
    weight(const unsigned int         grid_cell,
           const FieldAtSurface<dim> &point) const;

    /** What the cells of a grid cell add. */
    void
    add_cells_matrix(const unsigned int grid_cell, Local &local) const;
    void
    add_cells_load(const unsigned int grid_cell,
                   const Known       &known,
                   Local             &local) const;
  };

  /** Marks the grid cells in which k h² > 6 D, with the means of their cells,
   * but those in which the field has a fixed value; leaves marks that are
   * there. */
  template <int dim>
  void
  mark_lumped(FieldEquation<dim> &equation);

  /** Finds the steepness of each grid cell from the means of its cells. */
  template <int dim>
  void
  find_steepness(FieldEquation<dim> &equation);

  /**
   * Sets negative values of cells to zero, and makes others smaller so that the
   * sum of weights times values stays: those of the same grid cell, and where
   * they do not suffice, those of grid cells with the same splines, and last
   * all. Only a sum that is negative becomes zero. doc/theory.md, section 11.3.
   * Collective.
   * @param values  by cell
   * @param weights by cell, >= 0; where they are 0 nothing is made smaller
   * @param places  of the cells in the grid cells of @p space
   * @return negative values on all ranks
   */
  template <int dim>
  std::uint64_t
  keep_positive(std::vector<double>       &values,
                const std::vector<double> &weights,
                const GroupedPoints<dim>  &places,
                const SplineSpace<dim>    &space,
                const MPI_Comm             comm);
} // namespace Morula

#endif
