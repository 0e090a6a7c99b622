// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_seeded_tissue_h
#define morula_scene_seeded_tissue_h

#include <morula/effects/development.h>
#include <morula/effects/state/state_columns.h>
#include <morula/effects/surface/boundary_conditions.h>
#include <morula/scene/checks.h>
#include <morula/scene/tissue_model.h>
#include <morula/seeding/seeding.h>

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <mpi.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace Morula
{
  /** The components of a vector, e.g. "(1 0)". What is
   *  not larger than @p zero is printed as 0: sums that cancel leave rounding.
   */
  template <int dim>
  std::string
  vector_text(const Tensor<1, dim> &v, const double zero);

  /** The law, its constants, and what its energy is counted per. */
  std::string
  material_text(const Scene &scene);

  /** `Method`, and which of the keys that it stands for have other values. */
  std::string
  method_text(const Scene &scene);

  /** The boundary points of this rank that conditions load at t = 0, before
   *  there is a grid. @param patches gets their numbers as patches */
  template <int dim>
  LoadedPoints<dim>
  loaded_at_start(const TissueModel<dim>    &model,
                  const SurfacePatches<dim> &surface,
                  std::vector<std::size_t>  *patches = nullptr);

  /**
   * The forces of a condition on such points at @p t (day) on the surface of t
   * = 0, kPa µm^(dim-1); none if they are not known before the run.
   * @throws InputError for expressions without a value
   */
  template <int dim>
  std::optional<std::vector<Tensor<1, dim>>>
  forces_at_start(const BoundaryCondition<dim> &condition,
                  const LoadedPoints<dim>      &loaded,
                  const double                  t);

  /**
   * Calls @p action for each founder of this rank in its state at t = 0: with
   * its number, its columns and the cell as expressions see it. Collective; all
   * throw together.
   * @param step of the run, day, if effects are to refuse what they cannot do
   *             with it; 0 for what is said of a scene before the run
   * @throws InputError
   */
  template <int dim>
  void
  for_first_cells(
    const TissueModel<dim>                                           &model,
    const Founders<dim>                                              &founders,
    const SurfacePatches<dim>                                        &patches,
    const double                                                      step,
    const MPI_Comm                                                    comm,
    const std::function<void(
      std::size_t, std::vector<double> &, const PresentCell<dim> &)> &action);

  /** The tissue of a scene at t = 0, on this rank, and what the checks of the
   *  scene have found there. */
  template <int dim>
  struct SeededTissue
  {
    Founders<dim>       founders;
    SurfacePatches<dim> surface;
    /** Founders that proliferate, over all ranks. */
    types::particle_index n_proliferating = 0;
    ConditionCounts       counts;
    /** What conditions that act somewhere act on: names and texts. */
    std::vector<std::pair<std::string, std::string>> applied;
    /** What bodies are that interact, by their numbers. */
    std::vector<BodyMeasures> measures;
    /** Which closed surfaces its mesh has; empty without a mesh. */
    std::string mesh;
    /** How far the tissue is cut at t = 0; empty if it is not. */
    std::string cuts;
    /** Number of pieces that hold cells, and what holds the largest ones. */
    std::size_t              n_pieces = 0;
    std::vector<std::string> pieces;
    /** See scene_warnings(). */
    std::vector<std::string> warnings;
  };

  /**
   * Describes what the conditions on the surface, obstacles excepted, act on:
   * the program says what it applies before it does. Collective.
   * @return warnings of conditions on few points or none and without a load
   * @throws InputError for expressions without a value at the end of the run
   */
  template <int dim>
  std::vector<std::string>
  describe_conditions(const TissueModel<dim> &model,
                      SeededTissue<dim>      &tissue,
                      const MPI_Comm          comm);

  /**
   * Describes the pieces that hold cells, largest first. Collective.
   * @return warnings of loads that nothing balances but inertia, or the weak
   *         drag of scenes with obstacles
   * @throws InputError for expressions without a value at the end of the run
   */
  template <int dim>
  std::vector<std::string>
  describe_pieces(const TissueModel<dim> &model,
                  SeededTissue<dim>      &tissue,
                  const MPI_Comm          comm);

  /** Whether the tissue of a scene has boundary points. */
  template <int dim>
  bool
  has_surface(const TissueModel<dim> &model);

  /**
   * Seeds the tissue, with a surface around cells from a file if Tissue/Points
   * surface or a boundary condition asks for one, and lets all effects check
   * it. This is the longest work before the first step, so --explain and the
   * run share its result. Collective, and all throw together.
   * @throws InputError for a scene that cannot be run
   */
  template <int dim>
  SeededTissue<dim>
  seed_tissue(const TissueModel<dim> &model, const MPI_Comm comm);
} // namespace Morula

#endif
