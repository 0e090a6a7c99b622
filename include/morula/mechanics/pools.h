// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_pools_h
#define morula_mechanics_pools_h

#include <morula/grid/spline_space.h>
#include <morula/mechanics/material.h>
#include <morula/mechanics/term.h>

#include <vector>

namespace Morula
{
  template <int dim>
  struct MaterialPoints;

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
