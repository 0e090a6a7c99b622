// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/scene/reviews.h>
#include <morula/scene/seeded_tissue.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <string>
#include <vector>

namespace Morula
{
  namespace
  {
    /** Numbers of Time that leave nothing to do. */
    void
    review_time(const Scene                &scene,
                const types::particle_index n_founders,
                Review                     &review)
    {
      // Each number is compared with the end of the run, but for that of cells,
      // which is compared with the founders. Lengths of a step that are equal
      // to the run's but for rounding are no mistake.
      const double end = scene.time.end_time;
      if (scene.time.step > (1. + 1e-9) * end)
        review.warn(scene.time.step.path(),
                    as_text(scene.time.step) + " day",
                    "it is longer than the run, which ends at " + as_text(end) +
                      " day: there is one step of that length.",
                    "Shorten the step, or raise Time/End time.");
      if (review.has_set(scene.output.interval) &&
          scene.output.interval > (1. + 1e-9) * end)
        review.warn(scene.output.interval.path(),
                    as_text(scene.output.interval) + " day",
                    "it is longer than the run, which ends at " + as_text(end) +
                      " day: only its begin and its end are written.",
                    "Lower it, or set it to 0 if that is meant.");
      if (end > 365.)
        review.warn(scene.time.end_time.path(),
                    as_text(end) + " day",
                    "that is more than a year. Is it in hours or seconds?",
                    "If it is meant so, all is well.");
      if (scene.time.stop_at_cells > 0 &&
          n_founders >= scene.time.stop_at_cells)
        review.warn(scene.time.stop_at_cells.path(),
                    scene.time.stop_at_cells.text(),
                    "the tissue begins with " + std::to_string(n_founders) +
                      " cells: the run ends at its first step.",
                    "Raise it, or set it to 0 for a run to the end.");
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
          review.warn_of_idle(*key, no_one, make_one);
      else if (tissue.has_surface_file() && !renewed)
        review.warn_of_idle(tissue.closed_gap,
                            "the surface is that of " +
                              tissue.points_surface.path(),
                            "Remove this key.");
    }

    /** Warns of columns of a points file that nothing reads in the scene, and
     * of keys that its columns stand for. Collective. */
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
      for (const EffectKeys *const keys : scene.effect_keys())
        if (has_phases && !keys->is_on() &&
            !keys->said_by_column("phase").empty())
          review.warn(scene.tissue.points_file.path(),
                      scene.tissue.points_file,
                      "nothing reads its column 'phase', as the cells have no "
                      "cycle.",
                      keys->how_to_switch_on() + ", or drop the column.");
      for (const auto &[column, is_there] :
           {std::pair("phase", has_phases), std::pair("type", has_types)})
        for (const EffectKeys *const keys : scene.keys_in_use())
          for (const AnyKey *const key : keys->said_by_column(column))
            if (is_there)
              review.warn_of_idle(*key,
                                  std::string("the points file says the ") +
                                    column + " of each cell",
                                  std::string("Remove this key, or drop the "
                                              "column '") +
                                    column + "'.");
      if (has_own_volumes(scene, founders, comm))
        review.warn_of_idle(
          scene.tissue.cell_spacing,
          "the points file says the volume of each cell, and only "
          "estimates ask for this",
          "Set it to the mean length of the cells, or remove it.");
      review_surface<dim>(scene, review);
    }
  } // namespace


  template <int dim>
  void
  review_idle_keys(const Scene         &scene,
                   const Founders<dim> &founders,
                   const MPI_Comm       comm,
                   Review              &review)
  {
    // What keys alone tell comes first, then what founders and the surface of
    // all ranks tell. The sums are collective, and all ranks go through the
    // same lists.
    review_time(scene, founders.n_global, review);
    review_idle_founders(scene, founders, comm, review);
  }


  MORULA_INSTANTIATE(review_idle_keys);
} // namespace Morula
