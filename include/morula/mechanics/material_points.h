// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_material_points_h
#define morula_mechanics_material_points_h

#include <morula/grid/spline_space.h>
#include <morula/mechanics/material.h>
#include <morula/mechanics/term.h>
#include <morula/particles/tissue.h>

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <vector>

namespace Morula
{
  /** Something of a point or pool with the growth at t and at t + dt; they are
   *  the same if nothing grows. */
  struct Grown
  {
    double before = 0., after = 0.;

    double
    at(const GrowthAt growth) const
    {
      return growth == GrowthAt::previous ? before : after;
    }
  };

  /** Like points [first, last) of a pool: all have one J_e. */
  struct PoolGroup
  {
    unsigned int first = 0, last = 0;
    /** Number of their phase, which is that of their stiffness and relaxation.
     */
    unsigned int phase = 0;
    /** Λ = Σ W k, kPa µm^dim. */
    Grown modulus = {};
    /** G = Σ V⁰ det F_g, µm^dim. */
    Grown grown = {};
  };

  /** Points [first, last) of a grid cell whose volumes count as one sum, and
   *  their groups in Pools::groups: more than one if it is mixed. */
  struct Pool
  {
    unsigned int first, last, first_group, last_group;
  };

  /** The pools of the active grid cells: those of grid cell c are [offsets[c],
   *  offsets[c+1]). None is empty. */
  struct Pools
  {
    std::vector<unsigned int> offsets;
    std::vector<Pool>         list;
    std::vector<PoolGroup>    groups;
  };

  /** What the volume of a pool costs, and what its groups have of it. */
  struct PoolEnergy
  {
    /** U of the energy Λ U(ϑ) with ϑ = ln v/G, the modulus Λ (kPa µm^dim), and
     *  derivatives by ϑ. */
    Volumetric<double> U;
    /** ln J_e by group. */
    std::vector<double> theta;
  };

  /**
   * Φ(v) of doc/theory.md (2.7): of all that the groups can have, J_e is what
   * makes the energy least, so that there is one pressure.
   * @param theta ϑ = ln v/G
   */
  PoolEnergy
  pool_energy(const Pools    &pools,
              const Pool     &pool,
              const GrowthAt  growth,
              const double    theta,
              const Material &material);

  class Material;

  /**
   * What the momentum balance needs of a point's growth and elastic state: the
   * elastic deformation before the step's own, so that F_e = f A.
   */
  template <int dim>
  struct ElasticState
  {
    /** A = F_t F_g⁻¹, so that F_e = f A: doc/theory.md (1.3), equation (12) of
     *  the paper. */
    Tensor<2, dim> A;
    /**
     * Material points: W, the volume the energy is counted per, µm^dim.
     * Boundary points: W / V_t, the volume per volume of the configuration
     * at t.
     */
    double W;
  };

  /**
   * Positions of points in their grid cells, by active grid cell: the points
   * of grid cell c are [offsets[c], offsets[c+1]).
   */
  template <int dim>
  struct GroupedPoints
  {
    std::vector<unsigned int> offsets;
    std::vector<Point<dim>>   xi;
    double                    h; // grid spacing, µm

    /** Whether there are any in a grid cell. */
    bool
    any(const unsigned int grid_cell) const
    {
      return offsets[grid_cell] < offsets[grid_cell + 1];
    }
  };

  /** The positions in their grid cells of a selection of a store's points. */
  template <int dim>
  GroupedPoints<dim>
  grouped_places(const PointStore<dim>  &store,
                 const SplineSpace<dim> &space,
                 const PointGroups      &groups)
  {
    GroupedPoints<dim> places;
    places.offsets = groups.offsets;
    places.h       = space.box().spacing();
    places.xi.reserve(groups.points.size());
    for (unsigned int c = 0; c < space.grid_cells().size(); ++c)
      {
        const GridIndex<dim> index =
          space.box().index(space.grid_cells()[c].number);
        for (unsigned int k = groups.offsets[c]; k < groups.offsets[c + 1]; ++k)
          places.xi.push_back(
            space.box().unit_position(store.position(groups.points[k]), index));
      }
    return places;
  }

  /**
   * The particles as quadrature points of one step (doc/theory.md, section 2).
   * The configuration at t is the reference.
   */
  template <int dim>
  struct MaterialPoints : public GroupedPoints<dim>
  {
    /** Their material; it must outlive them. */
    const Material *material = nullptr;
    /** One for each point, or a single one for all. */
    std::vector<Lame> lame;
    /** Growth at t + dt. */
    std::vector<ElasticState<dim>> current;
    /** Whether some cells are several points. */
    bool subdivided = false;
    /** Growth at t; empty if nothing grows. */
    std::vector<ElasticState<dim>> previous;
    /** c at t, µm^dim: the volumes that points bring into their pools. Empty if
     *  volumes are pointwise, and so are the next two. */
    std::vector<double> carried;
    /** V⁰ det F_g, µm^dim, with the growth at t and at t + dt. */
    std::vector<Grown> grown;
    /** Whose volumes are one sum. Points of a pool follow each other. */
    Pools pools;

    /** Lamé's constants of a point. */
    const Lame &
    lame_of(const unsigned int p) const
    {
      return lame.size() == 1 ? lame[0] : lame[p];
    }

    /** The elastic states with the growth at t or at t + Δt. */
    const std::vector<ElasticState<dim>> &
    states(const GrowthAt growth) const
    {
      return growth == GrowthAt::previous && !previous.empty() ? previous :
                                                                 current;
    }
  };

  /**
   * Sorts the points of each grid cell by phases, and makes their pools
   * (doc/theory.md, section 2.4): a phase has pools of its own where it alone
   * fills two grid cells among a grid cell and its neighbours; the others share
   * one. Collective.
   * @param phases by point; the list is empty if all are alike
   */
  template <int dim>
  void
  make_pools(const SplineSpace<dim>          &space,
             const std::vector<unsigned int> &phases,
             MaterialPoints<dim>             &points);

  /** The same with one pool a grid cell, for points that are alike. */
  template <int dim>
  void
  make_pools_of_grid_cells(MaterialPoints<dim> &points);
} // namespace Morula

#endif
