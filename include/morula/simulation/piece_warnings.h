// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_piece_warnings_h
#define morula_simulation_piece_warnings_h

#include <morula/base/announce.h>
#include <morula/grid/piece_watch.h>

namespace Morula
{
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
} // namespace Morula

#endif
