// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_following_surface_h
#define morula_simulation_following_surface_h

#include <morula/scene/tissue_model.h>
#include <morula/simulation/run_state.h>
#include <morula/surface/surface_from_cells.h>

#include <deal.II/base/timer.h>

#include <functional>
#include <optional>

namespace Morula
{
  /**
   * Lets the surface follow the tissue, doc/theory.md, section 4.5: of each
   * body it is made from the cells anew, or tracked, as the scene asks. Keeps
   * references to the model, the state of the run and the timer.
   */
  template <int dim>
  class FollowingSurface
  {
  public:
    FollowingSurface(const TissueModel<dim> &model,
                     RunState               &state,
                     TimerOutput            &timer,
                     const MPI_Comm          comm);

    /** Whether the scene has boundary points. */
    bool
    exists() const
    {
      return exists_;
    }

    /** Splits patches that are too long at the start of a run, and remembers
     *  its walls and what the surface encloses. Collective. */
    void
    begin(Tissue<dim> &tissue);

    /** Closes the surface of a tissue that was carved at t = 0, and begins with
     *  it. Collective. @param former as from before_losses() */
    void
    close_cuts(Tissue<dim> &tissue, const PointList<dim> &former);

    /** A copy of the points, to be taken before a step loses any. */
    PointList<dim>
    before_losses(const Tissue<dim> &tissue) const
    {
      return may_make() ? tissue.boundary_points().copy() : PointList<dim>();
    }

    /** Finds the walls of a run whose snapshot has none, as those of older
     *  versions: its held points now. Collective. */
    void
    resume(const Tissue<dim> &tissue)
    {
      if (may_make() && state.walls.empty())
        state.walls = walls_of(tissue.boundary_points(), comm);
    }

    /** Whether the surface of some body is tracked. */
    bool
    is_tracked() const
    {
      return tracks;
    }

    /**
     * Makes the surface from the cells where that is due, closes cuts and
     * splits and merges patches elsewhere. Collective.
     * @param space  of the step
     * @param former as from before_losses()
     * @param t      its end, day
     * @param dt     its length, day
     * @return whether points had gone with their cells
     */
    bool
    follow(Tissue<dim>            &tissue,
           const SplineSpace<dim> &space,
           const PointList<dim>   &former,
           const double            t,
           const double            dt);

  private:
    /** Whether a step may make some surface from cells. */
    bool
    may_make() const
    {
      return exists_ && (remakes || model.development.is_mortal());
    }

    /** Chooses bodies by their numbers. */
    using Bodies = std::function<bool(unsigned int)>;

    /** Makes the surfaces of the bodies that @p select chooses from their
     *  cells. Collective. @param former points, which hand on what they are
     *  over a distance of @p reach spacings of the grid @param keeps whether
     *  tracked surfaces keep their points if they have no cut */
    void
    make_from_cells(Tissue<dim>                &tissue,
                    const PointList<dim>       &former,
                    const double                reach,
                    const Bodies               &select,
                    const bool                  keeps,
                    const PlaceConditions<dim> &scene);
    /** Lets bodies fuse that have touched each other for long enough, and gives
     *  them one surface. Collective. */
    void
    fuse_what_touches(Tissue<dim> &tissue, const double t, const double dt);
    void
    refine(Tissue<dim>                                   &tissue,
           const double                                   t,
           const std::function<bool(const Point<dim> &)> &crowded);
    /** What the scene's words say of places at @p t (day): beside the walls
     *  none is held. */
    PlaceConditions<dim>
    words(const double t) const;

    const TissueModel<dim> &model;
    RunState               &state;
    TimerOutput            &timer;
    const MPI_Comm          comm;
    const double            longest_edge; // of a patch, µm
    const bool              exists_;
    // Whether surfaces of some bodies are made from cells, or tracked.
    const bool remakes, tracks;
  };
} // namespace Morula

#endif
