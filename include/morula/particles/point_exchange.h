// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_point_exchange_h
#define morula_particles_point_exchange_h

#include <morula/grid/background_grid.h>
#include <morula/particles/point_list.h>

#include <map>
#include <vector>

namespace Morula
{
  /**
   * Sends every point to the rank that owns its grid cell; returns this rank's.
   * Give long lists away by std::move: their memory is free afterwards.
   * Unlike the ParticleHandler's own exchange this does not lose points that
   * cross more than one layer of grid cells in a step. Collective.
   */
  template <int dim>
  PointList<dim>
  send_to_owners(PointList<dim> points, const BackgroundGrid<dim> &grid);

  /**
   * Sends points to ranks; returns those that other ranks send to this one, in
   * the order of these ranks. Collective.
   * @param n_numbers length of the points' rows, equal on all ranks
   */
  template <int dim>
  PointList<dim>
  exchange(const std::map<unsigned int, PointList<dim>> &points_to,
           const unsigned int                            n_numbers,
           const MPI_Comm                                comm);

  /** The points in the order of their ids. */
  template <int dim>
  PointList<dim>
  by_id(const PointList<dim> &points);

  /** The points of all ranks, by id. Collective. */
  template <int dim>
  PointList<dim>
  of_all_ranks(const PointList<dim> &own, const MPI_Comm comm);

  /**
   * Copies of other ranks' points that may lie within @p reach (µm) of a
   * position in one of this rank's grid cells. Collective.
   */
  template <int dim>
  PointList<dim>
  halo(const PointList<dim>      &points,
       const BackgroundGrid<dim> &grid,
       const double               reach);

  /** A box of grid cells of the edge @p spacing (µm) around @p positions, of
   *  which there is at least one. */
  template <int dim>
  GridBox<dim>
  box_around(const std::vector<Point<dim>> &positions, const double spacing);
} // namespace Morula

#endif
