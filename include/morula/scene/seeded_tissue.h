// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_seeded_tissue_h
#define morula_scene_seeded_tissue_h

#include <morula/effects/development.h>
#include <morula/effects/state/surface_distance.h>
#include <morula/effects/surface/boundary_conditions.h>
#include <morula/scene/checks.h>
#include <morula/scene/tissue_model.h>
#include <morula/seeding/seeding.h>

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace Morula
{
  /** What a condition acts on at t = 0, over all ranks. */
  struct AppliedCondition
  {
    /** Name of the condition in the catalogue. */
    std::string name;
    /** Boundary points on which it acts, those excepted on which another one
     *  wins, and their area, µm^(dim-1). */
    std::uint64_t points = 0;
    double        area   = 0.;
    /** Those that its expression chooses, also where another one wins. */
    std::uint64_t chosen = 0;
    /** Corners of the box around these points, µm. */
    Point<3> lower, upper;
    /** Whether it is a load whose size is known before the run. */
    bool has_force = false;
    /** Sum of its forces at the end of the run on the surface of t = 0, and of
     *  their magnitudes, kPa µm^(dim-1). */
    Tensor<1, 3> force;
    double       magnitude = 0.;
    /** Whether it is a load that is zero at the end of every step. */
    bool is_idle = false;
    /** See BoundaryCondition. */
    bool is_tension = false;
  };

  /**
   * What the conditions on the surface, obstacles excepted, act on: the program
   * says what it applies before it does. Collective.
   * @throws InputError for expressions without a value at the end of the run
   */
  template <int dim>
  std::vector<AppliedCondition>
  applied_conditions(const TissueModel<dim>    &model,
                     const SurfacePatches<dim> &surface,
                     const MPI_Comm             comm);

  /** The components of a vector in the scene's dimension, e.g. "(1 0)". What is
   *  not larger than @p zero is printed as 0: sums that cancel leave rounding.
   */
  std::string
  vector_text(const Scene &scene, const Tensor<1, 3> &v, const double zero);

  /** E.g. "20 boundary points, 100 um, from (50 -48) to (50 48) um; force (2 0)
   *  kPa um at t = 1 day". */
  std::string
  text_of(const Scene &scene, const AppliedCondition &applied);

  /** The law, its constants, and what its energy is counted per. */
  std::string
  material_text(const Scene &scene);

  /** The lines of a run's log: one for the material, one for each condition. */
  std::vector<std::string>
  applied_texts(const Scene                         &scene,
                const std::vector<AppliedCondition> &applied);

  /** Adds warnings of conditions on few points or none and without a load. */
  void
  review_applied(const Scene                         &scene,
                 const std::vector<AppliedCondition> &applied,
                 std::vector<std::string>            &warnings);

  /** The boundary points of this rank that conditions load at t = 0, and the
   *  forces of conditions on them before there is a grid. */
  template <int dim>
  class LoadsAtStart
  {
  public:
    LoadsAtStart(const Scene                   &scene,
                 const BoundaryConditions<dim> &conditions,
                 const SurfacePatches<dim>     &surface);

    /** The points, in the order of patches. */
    const LoadedPoints<dim> &
    points() const;

    /** The number of a point in the patches of this rank. */
    std::size_t
    patch(const std::size_t point) const
    {
      return numbers[point];
    }

    /**
     * The forces of a condition on points() at @p t (day) on the surface of t
     * = 0, kPa µm^(dim-1); none if they are not known before the run.
     * @throws InputError for expressions without a value
     */
    std::optional<std::vector<Tensor<1, dim>>>
    forces(const BoundaryCondition<dim> &condition, const double t) const;

  private:
    LoadedPoints<dim>        loaded;
    std::vector<std::size_t> numbers;
  };

  /** What holds a piece of the tissue at t = 0, and which load is left to its
   *  unsupported rigid motions, over all ranks. */
  struct HeldPiece
  {
    std::uint64_t cells = 0;
    /** Centre of its cells' volume, µm. */
    Point<3> center;
    /** Fixed or slip boundary points on it. */
    std::uint64_t held_points = 0;
    /** Whether friction of cells holds it. */
    bool has_friction = false;
    /** Number of rigid motions that nothing holds, doc/theory.md (4.9). */
    unsigned int free_motions = 0;
    /** Sum of its loads at the end of the run on the configuration of t = 0,
     *  kPa µm^(dim-1), and their moment about the centre, kPa µm^dim; in 2-D
     *  the third component. */
    Tensor<1, 3> force, moment;
    /** Whether a part of the loads acts along a free motion. */
    bool is_unbalanced = false;
  };

  /**
   * The pieces that hold cells, largest first. Collective.
   * @throws InputError for expressions without a value at the end of the run
   */
  template <int dim>
  std::vector<HeldPiece>
  held_pieces(const TissueModel<dim>    &model,
              const Founders<dim>       &founders,
              const SurfacePatches<dim> &surface,
              const MPI_Comm             comm);

  /** E.g. "100 cells around (0 0) um: nothing holds it; inertia balances a
   *  force of (1 0) kPa um", one for each of the first pieces. */
  std::vector<std::string>
  texts_of(const Scene &scene, const std::vector<HeldPiece> &pieces);

  /** Adds a warning of loads that nothing balances but inertia, or the weak
   * drag of scenes with obstacles. */
  void
  review_held(const Scene                  &scene,
              const std::vector<HeldPiece> &pieces,
              std::vector<std::string>     &warnings);

  /** Where founders stand to the surface; empty if nothing asks for it.
   *  Collective. */
  template <int dim>
  std::vector<NearSurface<dim>>
  near_surface_of(const StateColumns<dim>   &state,
                  const Founders<dim>       &founders,
                  const SurfacePatches<dim> &patches,
                  const MPI_Comm             comm);

  /**
   * All columns of founder number @p i, at t = 0.
   * @param surface what near_surface_of() has said
   * @param step    of the run, day, if effects are to refuse what they cannot
   *                do with it; else 0
   * @throws InputError
   */
  template <int dim>
  std::vector<double>
  founder_row(const CellDevelopment<dim>          &development,
              const NamedEffects<Equation<dim>>   &equations,
              const Founders<dim>                 &founders,
              const std::vector<NearSurface<dim>> &surface,
              const std::size_t                    i,
              const double                         step);

  /** The founders of this rank in their state at t = 0, before there is a
   *  tissue: for what is said of a scene before the run. */
  template <int dim>
  class FirstCells
  {
  public:
    /** Collective. @param model and @p founders must outlive this */
    FirstCells(const TissueModel<dim>    &model,
               const Founders<dim>       &founders,
               const SurfacePatches<dim> &patches,
               const MPI_Comm             comm);

    /** The columns of founder number @p i. @throws InputError */
    std::vector<double>
    row(const std::size_t i) const;

    /** Founder number @p i as its expressions see it. @param row its columns,
     *  which must outlive the result, like this */
    PresentCell<dim>
    cell(std::vector<double> &row, const std::size_t i) const;

  private:
    const TissueModel<dim>       &model;
    const Founders<dim>          &founders;
    std::vector<NearSurface<dim>> surface;
    CellReader<dim>               reader;
  };

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
    /** See applied_conditions(). */
    std::vector<AppliedCondition> applied;
    /** What bodies are that interact, by their numbers. */
    std::vector<BodyMeasures> measures;
    /** Of how many bodies and pieces tissue from a file is, and which closed
     *  surfaces its mesh has; empty otherwise. */
    std::string bodies, mesh;

    /** How far the tissue is cut at t = 0; empty if it is not. */
    std::string cuts;
    /** See held_pieces(). */
    std::vector<HeldPiece> pieces;
    /** See scene_warnings(). */
    std::vector<std::string> warnings;
  };

  /** E.g. "2 bodies in 1 piece of the grid". Collective. */
  template <int dim>
  std::string
  bodies_text(const Scene             &scene,
              const SeededTissue<dim> &tissue,
              const MPI_Comm           comm);

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
