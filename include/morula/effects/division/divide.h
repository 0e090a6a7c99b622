// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_division_divide_h
#define morula_effects_division_divide_h

#include <morula/effects/development.h>
#include <morula/grid/grid_box.h>
#include <morula/particles/cell_event.h>
#include <morula/particles/tissue.h>

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>
#include <deal.II/particles/property_pool.h>

#include <array>
#include <tuple>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /** A cell about to divide, in the configuration that all divisions of a
   *  step see. */
  template <int dim>
  struct DividingCell
  {
    types::particle_index id;
    Point<dim>            position; // µm
    Tensor<1, dim>        axis;     // unit vector
    double                length;   // V^(1/dim), µm
  };

  /** A fixed or slip boundary point, as a half-space that daughters may not
   *  enter. */
  template <int dim>
  struct WallPoint
  {
    Point<dim>     position; // µm
    Tensor<1, dim> normal;   // outward unit vector
    double         spacing;  // a^(1/(dim-1)), µm
  };

  /**
   * Distances of the daughters from their mother along -axis and +axis
   * (d⁻ and d⁺ of equations (16), (19), (20) of the paper), for each dividing
   * cell: half the distance of the Voronoi wall or the Dirichlet boundary. A
   * wall farther than the cell's length counts as absent.
   *
   * The Voronoi wall along the unit vector n, doc/theory.md (6.5), is at
   * min_q |q-p|² / (2 (q-p)·n) over the cells q with (q-p)·n > 0; the cells
   * within two lengths make all walls that count, so the result is exact and
   * local. Dirichlet boundary points act as half-spaces, each within one point
   * spacing of where the ray hits it. If only one side has a wall, the other
   * daughter takes its distance, (19); without walls both are at a quarter of
   * the length, (20).
   *
   * Daughters keep away from each other and from walls: another cell within
   * 1e-3 lengths counts as coinciding and bounds nothing, and a cell that is
   * nearer than 1e-3 lengths to the plane of a Dirichlet half-space, or up to
   * 0.1 lengths beyond it, counts as 1e-3 lengths inside (farther beyond, the
   * boundary is that of another part of the body). So no distance is below
   * 2.5e-4 lengths, and a daughter crosses the plane by at most 5e-4 lengths.
   *
   * The result for a cell does not depend on the order of the points, nor on
   * which other cells divide.
   *
   * @param ids, positions all cells that could matter: this rank's and those
   *        of other ranks within twice the largest length; the dividing cells
   *        are known by their ids, and copies of a cell do no harm
   * @param walls all that could matter: within length + spacing of a cell
   * @param box the grid cells, which hold all these; only the search uses them
   */
  template <int dim>
  std::vector<std::array<double, 2>>
  daughter_distances(const std::vector<DividingCell<dim>>     &dividing,
                     const std::vector<types::particle_index> &ids,
                     const std::vector<Point<dim>>            &positions,
                     const std::vector<WallPoint<dim>>        &walls,
                     const GridBox<dim>                       &box);

  /** The division of a cell; ordered by time, then by the mother's id. */
  struct DivisionEvent
  {
    double                time;   // day, exact
    types::particle_index mother; // id

    friend bool
    operator<(const DivisionEvent &a, const DivisionEvent &b)
    {
      return std::tie(a.time, a.mother) < std::tie(b.time, b.mother);
    }
  };

  /**
   * Ids of the daughters of this rank's divisions: all ranks' divisions are
   * ordered by (time, mother's id) and get two ids each from @p next_id on, the
   * -n_s daughter first. Returns the first daughter's id for each event; the
   * second's is one more. @p next_id is advanced by twice the global number of
   * divisions. Collective.
   */
  std::vector<types::particle_index>
  number_daughters(const std::vector<DivisionEvent> &events,
                   types::particle_index            &next_id,
                   const MPI_Comm                    comm);

  /** Positions, in the order of Tissue::cells(), of this rank's cells that
   *  divide at or before @p t (day). Only where cells divide. */
  template <int dim>
  std::vector<unsigned int>
  cells_due(const Tissue<dim>          &tissue,
            const CellDevelopment<dim> &development,
            const double                t);

  /**
   * Divides each of these cells into two. daughter_distances() gives the
   * daughters' places. They inherit every column by its rule: F, equation (17)
   * of the paper, F_g and half of V⁰, equation (18), and what their fates say.
   * All divisions see the same configuration. Collective.
   * @param t1 end of the step, day
   * @param next_id first free id, the same on all ranks; advanced
   * @param events  gets what happens to daughters before the end of the step
   * @return the daughters born on this rank
   */
  template <int dim>
  std::vector<Birth<dim>>
  divide(Tissue<dim>                     &tissue,
         const CellDevelopment<dim>      &development,
         const std::vector<unsigned int> &due,
         const double                     t1,
         types::particle_index           &next_id,
         std::vector<CellEvent>          &events);
} // namespace Morula

#endif
