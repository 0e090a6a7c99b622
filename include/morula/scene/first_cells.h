// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_first_cells_h
#define morula_scene_first_cells_h

#include <morula/effects/development.h>
#include <morula/effects/state/surface_distance.h>
#include <morula/scene/tissue_model.h>
#include <morula/seeding/seeding.h>

#include <mpi.h>

#include <vector>

namespace Morula
{
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
} // namespace Morula

#endif
