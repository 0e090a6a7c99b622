// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_checks_h
#define morula_scene_checks_h

#include <morula/base/review.h>
#include <morula/scene/tissue_model.h>
#include <morula/seeding/seeding.h>

#include <mpi.h>

#include <map>
#include <string>
#include <vector>

namespace Morula
{
  /** The size of a scene at t = 0. */
  struct SceneSize
  {
    double cells  = 0.;
    double volume = 0.; // µm^dim
    // of the box around the tissue; 0: not known (few for compact tissue)
    double grid_cells = 0.;
  };

  /**
   * Size at t = 0 from the shape and the cell spacing, before anything is
   * seeded; 0 for shapes from files, whose size is not known yet.
   */
  SceneSize
  initial_size(const Scene &scene);

  /** Physical memory of all machines that run ranks, bytes. Collective. */
  double
  physical_memory(const MPI_Comm comm);

  /**
   * Refuses a scene that does not fit into memory. Collective.
   * @throws InputError
   */
  void
  check_memory(const Scene &scene, const SceneSize &size, const MPI_Comm comm);

  /** What effects may inspect before the run: founders and boundary points of
   *  this rank, which must outlive the result. Collective. */
  template <int dim>
  Preview<dim>
  preview(const TissueModel<dim>            &model,
          const std::vector<Point<dim>>     &founders,
          const std::vector<Point<dim>>     &boundary_points,
          const std::vector<Tensor<1, dim>> &normals,
          const MPI_Comm                     comm);

  /** The types of this rank's founders by number, those of the file if it has
   *  any; empty without types. @param founders initial positions, µm
   *  @param given what the file says. @throws InputError */
  template <int dim>
  std::vector<unsigned int>
  types_of(const TissueModel<dim>          &model,
           const std::vector<Point<dim>>   &founders,
           const std::vector<unsigned int> &given);

  /** Number of founders, over all ranks, of each type of cells; empty without
   *  types. Collective. @param founders initial positions, µm
   *  @param given their types, if their file says them */
  template <int dim>
  std::vector<types::particle_index>
  founders_of_types(const TissueModel<dim>          &model,
                    const std::vector<Point<dim>>   &founders,
                    const MPI_Comm                   comm,
                    const std::vector<unsigned int> &given = {});

  /**
   * Lets growth, division, forces and the material check all founders: growth
   * stretch and stiffness are positive, the cycle fits the step, forces are
   * finite, and with a cell cycle some founder proliferates. Refuses a scene
   * that does not fit into memory. Collective; every rank gives its own
   * founders, and all throw together.
   * @param founders initial positions, µm
   * @return number of founders, over all ranks, that proliferate
   * @throws InputError
   */
  template <int dim>
  types::particle_index
  check_at_cells(const TissueModel<dim>        &model,
                 const std::vector<Point<dim>> &founders,
                 const MPI_Comm                 comm);

  /** The number of boundary points, over all ranks, at which conditions win. */
  struct ConditionCounts
  {
    types::particle_index points = 0;
    types::particle_index fixed  = 0;
    /** The number of points at which each condition does something, by its
     *  name; 0 for those that are off. */
    std::map<std::string, types::particle_index> acting;
  };

  /**
   * Lets the conditions check all boundary points, and evaluates the stiffness
   * at held points. Refuses a condition that acts nowhere. Collective; every
   * rank gives its own points, and all throw together.
   * @throws InputError
   */
  template <int dim>
  ConditionCounts
  check_at_surface(const TissueModel<dim>    &model,
                   const SurfacePatches<dim> &surface,
                   const MPI_Comm             comm);

  /** Warns of values that the scene sets and nothing reads, as the keys alone
   *  tell: of effects that it switches off, and of keys that only some scenes
   *  read. Values of an effect whose switch it does not set are refused. */
  void
  review_idle_keys(const Scene &scene, Review &review);

  /**
   * Warnings of what is legal in a scene but unwise. Each is a line with key,
   * value, what was measured and where, and what to do. A warning needs a
   * measurement in doc/, or must follow from what the keys say. Empty if there
   * is nothing to warn of. Collective: the scene has passed all checks, every
   * rank gives its own founders and boundary points, and all get the same
   * warnings.
   * @param counts what check_at_surface() has returned
   */
  template <int dim>
  std::vector<std::string>
  scene_warnings(const TissueModel<dim>    &model,
                 const Founders<dim>       &founders,
                 const SurfacePatches<dim> &surface,
                 const ConditionCounts     &counts,
                 const MPI_Comm             comm);
} // namespace Morula

#endif
