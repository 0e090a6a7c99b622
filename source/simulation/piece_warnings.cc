// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/simulation/piece_warnings.h>

#include <optional>
#include <sstream>

namespace Morula
{
  template <int dim>
  PieceWarnings<dim>::PieceWarnings(const bool counts, const Announce &announce)
    : counts(counts)
    , announce(announce)
  {}


  template <int dim>
  void
  PieceWarnings<dim>::look(const SplineSpace<dim>    &space,
                           const BackgroundGrid<dim> &grid,
                           const double               t)
  {
    // The user is told of the first place only. After that no step looks for
    // another one, which would cost a search; all ranks know the same.
    const auto place = has_joined ? std::nullopt : watch.joined(space, grid);
    if (place)
      {
        has_joined = true;
        std::ostringstream text;
        text << "Warning: at t = " << t
             << " day two parts of the tissue have come within a grid spacing "
                "of each other near ("
             << *place
             << ") um. From now on they stick together there, though their "
                "cells may not touch yet (doc/faq.md, bodies that stick). A "
                "smaller Grid/Spacing lets them come closer. Later ones are "
                "not told of.";
        announce(text.str());
      }
    count(space, grid.communicator(), t);
  }


  template <int dim>
  void
  PieceWarnings<dim>::count(const SplineSpace<dim> &space,
                            const MPI_Comm          comm,
                            const double            t)
  {
    // Only pieces with cells count. The count of the first step has nothing to
    // be compared with.
    if (!counts)
      return;
    const unsigned int n = pieces_with_cells(space, comm);
    if (n_pieces_ > 0 && n > n_pieces_ && !has_parted)
      {
        has_parted = true;
        std::ostringstream text;
        text << "Warning: at t = " << t << " day the tissue has parted: it has "
             << n << " pieces now, and had " << n_pieces_
             << ". Each of them moves on its own. The column pieces of "
                "statistics.csv has their number; later ones are not told of.";
        announce(text.str());
      }
    n_pieces_ = n;
  }


  template class PieceWarnings<2>;
  template class PieceWarnings<3>;
} // namespace Morula
