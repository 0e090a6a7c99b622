// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/seeding/near_bodies.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace Morula
{
  namespace
  {
    /** A place in a lattice of cubes. */
    template <int dim>
    using Place = std::array<int, dim>;

    /** The cubes of a lattice, its lines at @p offset + i @p length (µm), that
     *  hold points. Rank 0 gets those of all ranks. Collective. */
    template <int dim>
    std::set<Place<dim>>
    occupied(const std::vector<Point<dim>> &points,
             const Point<dim>              &offset,
             const double                   length,
             const MPI_Comm                 comm)
    {
      std::set<Place<dim>> mine;
      for (const Point<dim> &X : points)
        {
          Place<dim> place;
          for (unsigned int d = 0; d < dim; ++d)
            place[d] =
              static_cast<int>(std::floor((X[d] - offset[d]) / length));
          mine.insert(place);
        }
      std::set<Place<dim>> all;
      for (const auto &places : Utilities::MPI::gather(
             comm, std::vector<Place<dim>>(mine.begin(), mine.end()), 0))
        all.insert(places.begin(), places.end());
      return all;
    }

    /** The cubes of @p places that stand at most @p reach cubes from @p center
     *  along each axis; they are taken out. */
    template <int dim>
    std::vector<Place<dim>>
    take_around(const Place<dim>     &center,
                const int             reach,
                std::set<Place<dim>> &places)
    {
      std::vector<Place<dim>> found;
      Place<dim>              offset;
      offset.fill(-reach);
      for (bool more = true; more;)
        {
          Place<dim> place = center;
          for (unsigned int d = 0; d < dim; ++d)
            place[d] += offset[d];
          if (const auto it = places.find(place); it != places.end())
            {
              found.push_back(place);
              places.erase(it);
            }
          more = false;
          for (unsigned int d = 0; d < dim && !more; ++d)
            if (++offset[d] <= reach)
              more = true;
            else
              offset[d] = -reach;
        }
      return found;
    }

    /** How many groups the cubes form, of which neighbours stand at most
     *  @p reach cubes apart along each axis. */
    template <int dim>
    unsigned int
    n_groups(std::set<Place<dim>> places, const int reach)
    {
      unsigned int n = 0;
      for (; !places.empty(); ++n)
        {
          std::vector<Place<dim>> rim = {*places.begin()};
          places.erase(places.begin());
          while (!rim.empty())
            {
              const Place<dim> center = rim.back();
              rim.pop_back();
              for (const Place<dim> &place :
                   take_around<dim>(center, reach, places))
                rim.push_back(place);
            }
        }
      return n;
    }
  } // namespace


  template <int dim>
  BodyCounts
  count_bodies(const GridParameters &grid,
               const Founders<dim>  &founders,
               const MPI_Comm        comm)
  {
    double longest = 0.;
    for (const double V : founders.volumes)
      longest = std::max(longest, std::pow(V, 1. / dim));
    longest = Utilities::MPI::max(longest, comm);

    Point<dim>                offset;
    const std::vector<double> of_grid = grid.offset;
    for (unsigned int d = 0; d < dim; ++d)
      offset[d] = of_grid[d];
    const auto of_bodies =
      occupied<dim>(founders.positions, Point<dim>(), longest, comm);
    const auto of_pieces =
      occupied<dim>(founders.positions, offset, grid.spacing, comm);
    const std::array<unsigned int, 2> counts = {
      {n_groups<dim>(of_bodies, 2), n_groups<dim>(of_pieces, 1)}};
    const auto of_root = Utilities::MPI::broadcast(comm, counts, 0);
    return {of_root[0], of_root[1]};
  }


  template <int dim>
  void
  review_bodies(const GridParameters   &grid,
                const TissueParameters &tissue,
                const Founders<dim>    &founders,
                const MPI_Comm          comm,
                Review                 &review)
  {
    const std::string shape = tissue.shape;
    if (shape != "points" && shape != "mesh")
      return;
    const BodyCounts counts = count_bodies(grid, founders, comm);
    if (counts.bodies > counts.pieces)
      review.warn(grid.spacing.path(),
                  as_text(grid.spacing) + " um",
                  "the tissue is " + std::to_string(counts.bodies) +
                    " bodies, and the grid makes " +
                    std::to_string(counts.pieces) +
                    (counts.pieces == 1 ? " piece" : " pieces") +
                    " of them: those within a grid spacing of each other stick "
                    "together from the start, though their cells do not touch "
                    "(doc/faq.md, bodies that stick).",
                  "A Grid/Spacing of less than half the gap between them keeps "
                  "them apart.");
  }


  template BodyCounts
  count_bodies(const GridParameters &, const Founders<2> &, const MPI_Comm);
  template BodyCounts
  count_bodies(const GridParameters &, const Founders<3> &, const MPI_Comm);
  template void
  review_bodies(const GridParameters &,
                const TissueParameters &,
                const Founders<2> &,
                const MPI_Comm,
                Review &);
  template void
  review_bodies(const GridParameters &,
                const TissueParameters &,
                const Founders<3> &,
                const MPI_Comm,
                Review &);
} // namespace Morula
