// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_watches_h
#define morula_simulation_watches_h

#include <morula/base/agreement.h>
#include <morula/grid/spline_space.h>
#include <morula/particles/tissue.h>
#include <morula/scene/tissue_model.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace Morula
{
  /** What is looked at while a run goes on, to tell the user. */
  template <int dim>
  class Watches
  {
  public:
    /** @param model of the run; it must stay */
    Watches(const TissueModel<dim> &model, const Announce &announce)
      : model(model)
      , announce(announce)
    {}

    /** Tells when a condition on the surface, of the tissue or of a field, has
     *  lost its last point since the last call, as the cells there are gone:
     *  what it held, loaded or fed goes on without it. To be called at the
     *  beginning and after the surface has lost points, at @p t (day).
     *  Collective. */
    void
    look_at_conditions(const Tissue<dim> &tissue, const double t);

    /** Tells once when pieces of the tissue join, and once when it parts: looks
     *  at the splines of a step that begins at @p t (day). Collective. */
    void
    look_at_pieces(const SplineSpace<dim> &space,
                   const MPI_Comm          comm,
                   const double            t);

    /** How many pieces the last call has seen. */
    unsigned int
    n_pieces() const
    {
      return n_pieces_;
    }

    /** Tells, once a run, of the first gap of the tissue across which splines
     *  reach: its sides stick together. Looks at the tissue at @p t (day).
     *  Collective. */
    void
    look_at_gaps(const Tissue<dim>      &tissue,
                 const SplineSpace<dim> &space,
                 const double            t);

    /** Tells, once a run, of the first neck of the tissue that the grid does
     * not resolve. Looks at the tissue at @p t (day). Collective. */
    void
    look_at_necks(const Tissue<dim> &tissue, const double t);

    /** Looks for cells behind sides that conditions hold, and in obstacles, at
     *  @p t (day), and tells once of the first ones. Collective.
     *  @param walls those of the run as numbers; empty: those of its points
     *  @param with_obstacles whether to look there, too
     *  @return why the run has to end, as too many are outside; or nothing */
    std::string
    look_at_cells(const Tissue<dim>         &tissue,
                  const std::vector<double> &walls,
                  const bool                 with_obstacles,
                  const double               t);

    /** A sentence on what is at @p x (µm) at @p t (day): the nearest cell, and
     *  what acts on the boundary point nearest to it. Collective. */
    std::string
    around(const Tissue<dim> &tissue,
           const Point<dim>  &x,
           const double       t) const;

    /** Tells, once a run, of lives that end at a rate which follows the state
     *  of cells faster than steps of @p dt (day) can follow it. Collective. */
    void
    look_at_losses(const Tissue<dim> &tissue, const double t, const double dt);

  private:
    const TissueModel<dim>              &model;
    const Announce                       announce;
    std::map<std::string, std::uint64_t> points_before; // of conditions
    std::vector<double>                  held;   // walls_of() the surface
    std::optional<std::vector<double>>   planes; // one point of each
    unsigned int                         n_pieces_ = 0;
    bool has_joined = false, has_parted = false, has_told_of_gap = false,
         has_told_of_neck = false, has_told_of_cells = false,
         has_told_of_losses = false;
  };
} // namespace Morula

#endif
