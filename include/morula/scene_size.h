// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_size_h
#define morula_scene_size_h

#include <morula/scene.h>

#include <deal.II/base/point.h>

#include <mpi.h>

#include <vector>

namespace Morula
{
  /** How large a scene is or becomes. */
  struct SceneSize
  {
    double cells  = 0.;
    double volume = 0.; // µm^dim, without stress
  };

  /**
   * Size at t = 0 from the shape and the cell spacing, before anything is
   * seeded; 0 for shapes from files, whose size is not known yet.
   */
  SceneSize
  initial_size(const Scene &scene);

  /**
   * Rate of the exponential growth of the number of cells at long times,
   * 1/day: the root r of 2 exp(-rT) Λ/(Λ+r) = 1 for a cycle of duration
   * @p T after a wait in G0 with the exit rate @p Lambda; 0 for rate 0.
   */
  double
  growth_rate(const double T, const double Lambda);

  /**
   * Size at End time that the descendants of @p founders are expected not to
   * exceed: 2 exp(r t) cells for each founder that proliferates, no more than
   * twice 'Stop at cells' in all. With a size checkpoint, whose effect only
   * the run can tell, the founders alone are counted: a lower bound.
   * Collective; every rank gives its own founders.
   * @throws InputError, on some ranks only, where an expression has no value
   */
  template <int dim>
  SceneSize
  expected_size(const Scene                   &scene,
                const std::vector<Point<dim>> &founders,
                const MPI_Comm                 comm);

  /** What --explain tells of the size of a run. */
  struct SizeEstimate
  {
    double cells             = 0.; // at the end
    double unknowns_at_start = 0.; // exact
    double unknowns          = 0.; // at the end
    double memory            = 0.; // bytes
    double seconds           = 0.; // of one core, all steps, without output
    double steps             = 0.;
  };

  /**
   * Estimates, rough ones of the time, fitted to the runs of doc/performance.md
   * ("What --explain expects"). Collective; every rank gives its own founders.
   * @param n_unknowns of the first step
   * @throws InputError, on some ranks only, where an expression has no value
   */
  template <int dim>
  SizeEstimate
  estimated_size(const Scene         &scene,
                 const Founders<dim> &founders,
                 const unsigned int   n_unknowns,
                 const MPI_Comm       comm);

  /**
   * Memory that a run of this size needs on all ranks together, bytes:
   * particles and what is copied of them, matrix and preconditioner on the
   * grid around a compact tissue. An estimate, right within a factor of about
   * two (doc/performance.md, "What --explain expects").
   */
  double
  estimated_memory(const Scene &scene, const SceneSize &size);

  /** Physical memory of all machines that run ranks, bytes. Collective. */
  double
  physical_memory(const MPI_Comm comm);

  /**
   * Refuses a scene that does not fit into memory. Collective.
   * @throws InputError
   */
  void
  check_memory(const Scene &scene, const SceneSize &size, const MPI_Comm comm);
} // namespace Morula

#endif
