// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_watches_h
#define morula_simulation_watches_h

#include <morula/base/announce.h>
#include <morula/grid/piece_watch.h>
#include <morula/grid/spline_space.h>
#include <morula/particles/tissue.h>
#include <morula/scene/tissue_model.h>

#include <cstdint>
#include <map>
#include <string>

namespace Morula
{
  /** Tells the user when a condition on the surface, of the tissue or of a
   *  field, has lost its last point, as the cells there are gone: what it held,
   *  loaded or fed goes on without it. */
  template <int dim>
  class ConditionWatch
  {
  public:
    /** @param model of the run; it must stay */
    ConditionWatch(const TissueModel<dim> &model, const Announce &announce);

    /** Counts the points of each condition, before cells are removed for the
     *  first time. Collective. */
    void
    begin(const Tissue<dim> &tissue);

    /** Counts them anew after boundary points have gone with their cells, at
     *  @p t (day). Collective. */
    void
    look(const Tissue<dim> &tissue, const double t);

  private:
    /** How many points each condition acts on. Collective. */
    std::map<std::string, std::uint64_t>
    count(const Tissue<dim> &tissue) const;

    const TissueModel<dim>              &model;
    const Announce                       announce;
    std::map<std::string, std::uint64_t> before;
    bool                                 has_begun = false;
  };

  /** Tells the user once when pieces of the tissue join, and once when it
   *  parts. */
  template <int dim>
  class PieceWarnings
  {
  public:
    /** @param counts whether to count pieces; only death can part the tissue */
    PieceWarnings(const bool counts, const Announce &announce);

    /** Looks at the splines of a step that begins at @p t (day). */
    void
    look(const SplineSpace<dim>    &space,
         const BackgroundGrid<dim> &grid,
         const double               t);

    /** Counts the pieces, and tells if the tissue has parted. */
    void
    count(const SplineSpace<dim> &space, const MPI_Comm comm, const double t);

    /** The last count. */
    unsigned int
    n_pieces() const
    {
      return n_pieces_;
    }

  private:
    const bool      counts;
    const Announce  announce;
    PieceWatch<dim> watch;
    unsigned int    n_pieces_  = 0;
    bool            has_joined = false; // and the user knows
    bool            has_parted = false; // likewise
  };

  /** Tells the user, once a run, of the first gap of the tissue across which
   *  splines reach: its sides stick together. */
  template <int dim>
  class GapWatch
  {
  public:
    explicit GapWatch(const Announce &announce);

    /** Looks at the tissue at @p t (day) before every tenth step, the first one
     *  included. Collective. */
    void
    look(const Tissue<dim>      &tissue,
         const SplineSpace<dim> &space,
         const double            t);

  private:
    const Announce announce;
    bool           has_told = false;
    unsigned int   n_looks  = 0;
  };
} // namespace Morula

#endif
