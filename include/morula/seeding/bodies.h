// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_bodies_h
#define morula_seeding_bodies_h

#include <morula/particles/fusion.h>
#include <morula/particles/tissue.h>
#include <morula/seeding/seeding.h>

#include <deal.II/base/mpi.templates.h>

#include <mpi.h>

#include <vector>

namespace Morula
{
  /** What all ranks have, in the order of the ranks, which is that of founders'
   *  and patches' numbers. Collective. */
  template <typename T>
  std::vector<T>
  of_all_ranks(const std::vector<T> &mine, const MPI_Comm comm)
  {
    std::vector<T> all;
    for (const auto &part : dealii::Utilities::MPI::all_gather(comm, mine))
      all.insert(all.end(), part.begin(), part.end());
    return all;
  }


  /** Collective. */
  double
  sum_of_all_ranks(const std::vector<double> &mine, const MPI_Comm comm);

  /** The length V^(1/dim) of the longest cell, µm. Collective. */
  template <int dim>
  double
  longest_length(const Founders<dim> &founders, const MPI_Comm comm);


  /**
   * The body of each of this rank's founders: founders that stand together,
   * each at most so many lengths from some other. Bodies have the numbers 0, 1,
   * ... in the order of their first founders. Collective.
   */
  template <int dim>
  std::vector<unsigned int>
  bodies_apart(const Founders<dim> &founders,
               const MPI_Comm       comm,
               const double         widest = widest_bond);

  /** Tells bodies apart once more when cells have gone at t = 0: the numbers go
   *  by the lowest id in a body. What the surface was before, @p former, takes
   *  the body of the nearest cell that is left. Collective. */
  template <int dim>
  void
  tell_bodies_apart(Tissue<dim> &tissue, PointList<dim> &former);

  /** How many bodies there are, 0 if founders do not know theirs. Collective.
   */
  template <int dim>
  unsigned int
  number_of_bodies(const Founders<dim> &founders, const MPI_Comm comm);

  /**
   * Moves the patches of bodies that touch so that their surfaces do not
   * overlap: surfaces that were made around each body's cells alone may, by
   * part of a cell, and would start with a pressure. Each patch goes back along
   * its normal by half of its mean overlap with the patches that face it. What
   * a body has lost by that, its patches that face no other body make good by
   * one distance along their normals.
   * @param volumes that the bodies shall enclose, µm^dim
   * @param patches all of them
   */
  template <int dim>
  void
  part_bodies(const std::vector<double> &volumes, SurfacePatches<dim> &patches);

  /** The measures of all bodies, by their numbers. Collective. */
  template <int dim>
  std::vector<BodyMeasures>
  measures_of_bodies(const Founders<dim>       &founders,
                     const SurfacePatches<dim> &patches,
                     const MPI_Comm             comm);

  /** The body of each of this rank's patches: that of the nearest founder
   *  behind the patch. Collective. */
  template <int dim>
  std::vector<unsigned int>
  bodies_of_patches(const SurfacePatches<dim> &patches,
                    const Founders<dim>       &founders,
                    const MPI_Comm             comm);
} // namespace Morula

#endif
