// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_following_surface_h
#define morula_simulation_following_surface_h

#include <morula/scene/tissue_model.h>
#include <morula/seeding/points_surface.h>

#include <deal.II/base/timer.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace Morula
{
  /**
   * Lets the surface follow the tissue, as the scene asks: patches split where
   * it stretches and merge where it shrinks, and it is made anew when tissue
   * was lost. Keeps references to the model, the id and the timer.
   */
  template <int dim>
  class FollowingSurface
  {
  public:
    /** @param next_id the first id that no boundary point has had; advanced */
    FollowingSurface(const TissueModel<dim> &model,
                     types::particle_index  &next_id,
                     TimerOutput            &timer,
                     const MPI_Comm          comm);

    /** Whether the scene has boundary points. */
    bool
    exists() const
    {
      return exists_;
    }

    /**
     * Splits patches that are too long at the start of a run. Collective.
     * @return the volume that the surface encloses over that of the cells;
     *         nothing if it is not closed, or there is none
     */
    std::optional<double>
    begin(Tissue<dim> &tissue);

    /** Closes the surface of a tissue that was carved at t = 0, and splits its
     *  patches. Collective. @return as begin() */
    std::optional<double>
    close_cuts(Tissue<dim> &tissue);

    /** Whether the surface stays open: a step has lost more than one in a
     * hundred points, and the scene never renews them. @param n_before, n_left
     * numbers of points of all ranks before and after the loss */
    bool
    is_cut(const std::uint64_t n_before, const std::uint64_t n_left) const;

    /** Whether follow() keeps the surface of flowing tissue near its cells.
     *  @param share as of follow() */
    bool
    restores(const std::optional<double> &share) const
    {
      return flows && share && !renews();
    }

    /** A copy of the points, to be taken before a step loses any; empty if the
     *  scene never renews the surface. */
    PointList<dim>
    before_losses(const Tissue<dim> &tissue) const
    {
      return renews() ? tissue.boundary_points().copy() : PointList<dim>();
    }

    /**
     * Makes the surface anew if that is due, or if the step has lost too many
     * points or stretched one too much; splits and merges patches. Collective.
     * @param space  of the step
     * @param former as from before_losses()
     * @param share  of the cells' volume that the surface encloses, at t = 0;
     *        nothing if it is not closed
     * @param t      end of the step, day
     * @param dt     its length, day
     * @throws SurfaceTorn on all ranks
     */
    void
    follow(Tissue<dim>                 &tissue,
           const SplineSpace<dim>      &space,
           const PointList<dim>        &former,
           const std::optional<double> &share,
           const double                 t,
           const double                 dt);

  private:
    /** Lets @p change write the deformation of the cells, while the amounts of
     *  fields in them stay. */
    void
    change_volumes(Tissue<dim>                 &tissue,
                   const std::function<void()> &change) const
    {
      std::vector<double> before;
      if (!model.densities.empty())
        for (unsigned int p = 0; p < tissue.cells().size(); ++p)
          before.push_back(tissue.cells().volume(p));
      change();
      for (std::size_t p = 0; p < before.size(); ++p)
        model.dilute(tissue.cell(p), tissue.cells().volume(p) / before[p]);
    }
    bool
    renews() const
    {
      return model.scene.tissue.renew_surface > 0.;
    }

    /** renew() for those bodies that have @p selects, body by body. */
    bool
    renew_bodies(Tissue<dim>                             &tissue,
                 const PointList<dim>                    &former,
                 const SurfaceWish                       &wish,
                 const std::function<bool(unsigned int)> &selects);
    /** Lets bodies fuse that have touched each other for long enough, and gives
     *  them one surface. Collective. */
    void
    fuse_what_touches(Tissue<dim> &tissue, const double dt);
    void
    renew_if_due(Tissue<dim>          &tissue,
                 const PointList<dim> &former,
                 const double          t,
                 const double          dt);
    /**
     * Makes the surface of flowing tissue anew where it does not fit its cells
     * any more: doc/theory.md (4.12f). Its points are carried along for as long
     * as the tissue flows, and nothing brings them back. Collective.
     */
    void
    restore_fit(Tissue<dim> &tissue, const double share, const bool is_torn);
    /** Makes the surface anew. @return whether that was possible. Collective.
     */
    bool
    renew(Tissue<dim>          &tissue,
          const PointList<dim> &former,
          const SurfaceWish    &wish);
    void
    refine(Tissue<dim>                                   &tissue,
           const std::function<bool(const Point<dim> &)> &crowded);

    const TissueModel<dim> &model;
    types::particle_index  &next_id;
    TimerOutput            &timer;
    const MPI_Comm          comm;
    const double            longest_edge; // of a patch, µm
    const bool              flows;        // whether shear relaxes
    const bool              grows;        // whether cells grow or divide
    const bool              spreads; // whether their volumes are pooled, too
    const bool              exists_;
  };
} // namespace Morula

#endif
