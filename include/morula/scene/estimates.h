// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_estimates_h
#define morula_scene_estimates_h

#include <morula/scene/size.h>
#include <morula/seeding/seeding.h>

#include <map>
#include <optional>
#include <string>

namespace Morula
{
  /** What --explain tells of the size of a run. */
  struct SizeEstimate
  {
    double cells             = 0.; // at the end
    double unknowns_at_start = 0.; // as given
    double unknowns          = 0.; // at the end
    double memory            = 0.; // bytes
    double seconds           = 0.; // of one core, all steps, without output
    double steps             = 0.;
    /** Of `seconds` those of effects that take a large part of them, by name.
     */
    std::map<std::string, double> of_effects;
  };

  /**
   * Estimates the size of a run; its time only roughly, fitted to the runs of
   * doc/performance.md ("What --explain expects"). Collective; every rank gives
   * its own founders.
   * @param n_unknowns of the first step; 0: estimated, too
   * @param free_growth what free_growth() says; else growth that depends on
   *        the cells' state counts as none
   * @param cells_per_founder at the end, where only free_growth() knows; 0: it
   *        is estimated
   * @throws InputError, on some ranks only, where an expression has no value
   */
  template <int dim>
  SizeEstimate
  estimated_size(const Scene                 &scene,
                 const Founders<dim>         &founders,
                 const MPI_Comm               comm,
                 const unsigned int           n_unknowns        = 0,
                 const std::optional<double> &free_growth       = {},
                 const double                 cells_per_founder = 0.);

  /**
   * Memory that a run of this size needs on all ranks together, bytes:
   * particles and their copies, matrix and preconditioner on the grid around a
   * compact tissue. An estimate, right within a factor of about two
   * (doc/performance.md, "What --explain expects").
   */
  double
  estimated_memory(const Scene &scene, const SceneSize &size);
} // namespace Morula

#endif
