// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/scene/idle_founders.h>
#include <morula/scene/seeded_tissue.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace Morula
{
  namespace
  {
    /** Warns of a key, if the scene gives it a value that is not the default.
     */
    void
    warn_if_given(const AnyKey      &key,
                  const std::string &why,
                  const std::string &remedy,
                  Review            &review)
    {
      if (review.has_set(key) && !key.is_default())
        review.warn(key.path(),
                    key.text(),
                    "it does nothing here: " + why + '.',
                    remedy);
    }

    /** Whether the column of a state is in the file: a rank may have no cell.
     *  Collective. */
    bool
    has_column(const std::vector<unsigned int> &states, const MPI_Comm comm)
    {
      return Utilities::MPI::max(states.empty() ? 0 : 1, comm) > 0;
    }

    /** Whether some founder has another volume than the spacing gives it.
     *  Collective. */
    template <int dim>
    bool
    has_own_volumes(const Scene         &scene,
                    const Founders<dim> &founders,
                    const MPI_Comm       comm)
    {
      const double V   = std::pow(scene.tissue.cell_spacing.value(), dim);
      const bool   own = std::any_of(founders.volumes.begin(),
                                   founders.volumes.end(),
                                   [V](const double volume) {
                                     return std::abs(volume - V) > 1e-9 * V;
                                   });
      return Utilities::MPI::max(own ? 1 : 0, comm) > 0;
    }

    /** Keys that make, move or change a surface of points. */
    template <int dim>
    void
    review_surface(const Scene &scene, Review &review)
    {
      const TissueParameters &tissue   = scene.tissue;
      const bool              renewed  = tissue.renew_surface > 0.;
      const std::string       no_one   = "there is no surface around the cells";
      const std::string       make_one = "Set " + tissue.points_surface.path() +
                                   " = always, or remove this key.";
      if (!has_surface<dim>(scene))
        for (const AnyKey *key :
             std::vector<const AnyKey *>{&tissue.closed_gap,
                                         &tissue.boundary_points,
                                         &tissue.refine_surface})
          warn_if_given(*key, no_one, make_one, review);
      else if (tissue.has_surface_file() && !renewed)
        warn_if_given(tissue.closed_gap,
                      "the surface is that of " + tissue.points_surface.path(),
                      "Remove this key.",
                      review);
    }
  } // namespace


  template <int dim>
  void
  review_idle_founders(const Scene         &scene,
                       const Founders<dim> &founders,
                       const MPI_Comm       comm,
                       Review              &review)
  {
    // Cells of a lattice have what the keys say. Those of a file may have
    // states of their own: a state that nothing reads is as good as lost, and
    // the key that it stands for is not asked.
    if (!scene.tissue.is_points())
      return;
    const bool has_phases = has_column(founders.phases, comm),
               has_types  = has_column(founders.types, comm);
    if (has_phases && !scene.has_proliferation())
      review.warn(scene.tissue.points_file.path(),
                  scene.tissue.points_file,
                  "nothing reads its column 'phase', as the cells have no "
                  "cycle.",
                  "Set " + scene.proliferation_law.path() +
                    " = cell cycle, or drop the column.");
    if (has_phases && scene.has_proliferation())
      warn_if_given(scene.cell_cycle.start,
                    "the points file says the phase of each cell",
                    "Remove this key, or drop the column 'phase'.",
                    review);
    if (has_types)
      for (const CellTypeKeys &type : scene.cell_types.types)
        if (!type.where.empty())
          warn_if_given(type.where,
                        "the points file says the type of each cell",
                        "Remove this key, or drop the column 'type'.",
                        review);
    if (has_own_volumes(scene, founders, comm))
      warn_if_given(scene.tissue.cell_spacing,
                    "the points file says the volume of each cell, and only "
                    "estimates ask for this",
                    "Set it to the mean length of the cells, or remove it.",
                    review);
    review_surface<dim>(scene, review);
  }


  template void
  review_idle_founders(const Scene &,
                       const Founders<2> &,
                       const MPI_Comm,
                       Review &);
  template void
  review_idle_founders(const Scene &,
                       const Founders<3> &,
                       const MPI_Comm,
                       Review &);
} // namespace Morula
