// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_surface_walls_h
#define morula_surface_walls_h

#include <morula/base/near_tree.h>
#include <morula/particles/boundary_state.h>
#include <morula/particles/tissue.h>

#include <mpi.h>

#include <functional>
#include <optional>
#include <vector>

namespace Morula
{
  /** What a scene says of the surface at a place. */
  template <int dim>
  struct PlaceConditions
  {
    /** What holds or loads a point at X (µm) with the outward unit normal N. */
    std::function<SurfaceCondition(const Point<dim> &, const Tensor<1, dim> &)>
      condition;
    /** The same of patches that no former point hands on to. */
    std::function<SurfaceCondition(const Point<dim> &, const Tensor<1, dim> &)>
      of_new;
    /** Where a fixed point of t = 0 is to be now, minus where it was, µm. */
    std::function<Tensor<1, dim>(const BoundaryView<dim> &)> displacement;
  };


  /** A place at which a condition holds the surface: a point of t = 0. */
  template <int dim>
  struct Wall
  {
    Point<dim>       X; // at t = 0, µm
    Tensor<1, dim>   N; // outward unit normal
    SurfaceCondition condition;
    unsigned int     body;
    Tensor<1, dim>   motion; // since then, µm
  };

  /** The walls of all ranks, in the order of their points' ids: the held points
   *  of a surface as at t = 0, as numbers for Walls. Collective. */
  template <int dim>
  std::vector<double>
  walls_of(const BoundaryPoints<dim> &points, const MPI_Comm comm);


  /** Of the numbers of walls_of(), those of one point of each plane side.
   *  @param spacing of the grid, µm */
  template <int dim>
  std::vector<double>
  one_of_each_plane(const std::vector<double> &walls, const double spacing);


  /**
   * Where tissue that flows is held: a wall stays where the scene has it at
   * t = 0, or moves it to, whichever cells stand at it. doc/theory.md, section
   * 4.5.
   */
  template <int dim>
  class Walls
  {
  public:
    /** Where a patch stands on a wall. */
    struct Foot
    {
      const Wall<dim> *wall;
      Point<dim>       X; // of the patch on the wall of t = 0, µm
    };

    /** @param numbers from walls_of() @param scene is kept as a reference
     *  @param columns of the boundary points */
    Walls(const std::vector<double>  &numbers,
          const PlaceConditions<dim> &scene,
          const BoundaryColumns<dim> &columns);

    /**
     * The foot of a patch of the surface around cells, or nothing if it is not
     * at a wall of its side, where the scene's words still hold.
     * @param x      place of the patch, µm
     * @param n      its outward unit normal
     * @param offset how far outwards the patch stands from the end of the
     *               cells, µm
     * @param edge   spacing of the lattice, µm
     * @param before how far before the wall the cells may end, in spacings
     */
    std::optional<Foot>
    at(const unsigned int    body,
       const Point<dim>     &x,
       const Tensor<1, dim> &n,
       const double          offset,
       const double          edge,
       const double          before) const;

    /** Whether @p x (µm) is behind the plane of some wall. */
    bool
    any_behind(const Point<dim> &x) const
    {
      for (std::size_t i = 0; i < walls.size(); ++i)
        if ((x - places[i]) * walls[i].N > 0.)
          return true;
      return false;
    }

    /** The way along the outward normal from a wall to @p x (µm), if that is
     *  behind it: its foot is less than @p near (µm) from a point of the wall,
     *  and the points there are in a plane. Zero if not. */
    Tensor<1, dim>
    behind(const Point<dim> &x, const double near) const;

  private:
    std::vector<Wall<dim>>       walls;
    const PlaceConditions<dim>  &scene;
    std::vector<Point<dim>>      places; // now
    std::optional<NearTree<dim>> tree;   // of these
  };
} // namespace Morula

#endif
