// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/grid/spline_space.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

// The part of SplineSpace that puts the spaces of bodies together.

namespace Morula
{
  namespace
  {
    /** The numbers of one body's unknowns in the common space. */
    class CommonNumbers
    {
    public:
      /** A body's unknowns from begins[r] on, which are those of rank r, get
       *  the numbers from targets[r] on. */
      std::vector<unsigned int> begins, targets;

      unsigned int
      operator()(const unsigned int unknown) const
      {
        // Of several ranks with one begin all but the last own nothing.
        const auto rank =
          std::upper_bound(begins.begin(), begins.end(), unknown) -
          begins.begin() - 1;
        return targets[rank] + (unknown - begins[rank]);
      }
    };

    /** The common numbers of all bodies, and their sum over ranks before this
     *  one. Unknowns run rank by rank, on each rank body by body. Collective.
     */
    std::vector<CommonNumbers>
    number_together(const std::vector<unsigned int> &n_own, const MPI_Comm comm)
    {
      const auto of_ranks = Utilities::MPI::all_gather(comm, n_own);
      std::vector<CommonNumbers> numbers(n_own.size());
      std::vector<unsigned int>  begins(n_own.size(), 0);
      unsigned int               target = 0;
      for (const auto &of_rank : of_ranks)
        for (std::size_t b = 0; b < of_rank.size(); ++b)
          {
            numbers[b].begins.push_back(begins[b]);
            numbers[b].targets.push_back(target);
            begins[b] += of_rank[b];
            target += of_rank[b];
          }
      return numbers;
    }
  } // namespace


  template <int dim>
  SplineSpace<dim>::SplineSpace(std::vector<SplineSpace> spaces,
                                const MPI_Comm           comm)
    : occupancy_(spaces.at(0).occupancy_)
    , extend(spaces[0].extend)
    , bodies(std::move(spaces))
  {
    // Each body's unknowns are numbered from 0. They get numbers in the common
    // space, by which the bodies' grid cells are written anew; then these are
    // sorted and the unknowns that they use become the relevant ones. Pieces
    // and counts of the bodies follow one another.
    std::vector<unsigned int> n_own;
    for (const SplineSpace &body : bodies)
      n_own.push_back(body.owned().n_elements());
    const std::vector<CommonNumbers> numbers = number_together(n_own, comm);
    unsigned int                     n_all   = 0;
    for (const SplineSpace &body : bodies)
      n_all += body.n_unknowns();
    owned_ = IndexSet(n_all);
    first_piece.assign(1, 0);
    for (unsigned int b = 0; b < bodies.size(); ++b)
      {
        const SplineSpace &body = bodies[b];
        if (n_own[b] > 0)
          {
            const unsigned int first =
              numbers[b](body.owned().nth_index_in_set(0));
            owned_.add_range(first, first + n_own[b]);
          }
        for (const unsigned int piece : body.pieces_)
          pieces_.push_back(first_piece[b] + piece);
        first_piece.push_back(first_piece[b] + body.n_pieces());
        for (GridCell grid_cell : body.grid_cells_)
          {
            for (unsigned int &unknown : grid_cell.unknowns)
              unknown = numbers[b](body.relevant().nth_index_in_set(unknown));
            grid_cell.part = b;
            grid_cells_.push_back(std::move(grid_cell));
          }
        n_active += body.n_active;
        n_inner += body.n_inner;
        n_outer += body.n_outer;
      }
    owned_.compress();
    std::sort(grid_cells_.begin(),
              grid_cells_.end(),
              [](const GridCell &a, const GridCell &b) {
                return std::tie(a.number, a.part) < std::tie(b.number, b.part);
              });
    find_relevant();
  }


  template <int dim>
  unsigned int
  SplineSpace<dim>::entry(const unsigned int number,
                          const unsigned int part) const
  {
    const auto found =
      std::lower_bound(grid_cells_.begin(),
                       grid_cells_.end(),
                       std::make_pair(number, is_parted() ? part : 0u),
                       [](const GridCell &grid_cell, const auto &wanted) {
                         return std::make_pair(grid_cell.number,
                                               grid_cell.part) < wanted;
                       });
    Assert(found != grid_cells_.end() && is_at(*found, number, part),
           ExcInternalError());
    return found - grid_cells_.begin();
  }


  template <int dim>
  void
  SplineSpace<dim>::add_relevant(const IndexSet &unknowns)
  {
    const IndexSet before = relevant_;
    relevant_.add_indices(unknowns);
    relevant_.compress();
    for (GridCell &grid_cell : grid_cells_)
      for (unsigned int &unknown : grid_cell.unknowns)
        unknown = relevant_.index_within_set(before.nth_index_in_set(unknown));
  }


  template <int dim>
  std::vector<double>
  SplineSpace<dim>::affine_coefficients_of_body(
    const unsigned int    piece,
    const double          a,
    const Tensor<1, dim> &gradient) const
  {
    // The unknowns of this rank stand body by body. Those of other bodies stay
    // at 0.
    std::vector<double> coefficients(owned().n_elements(), 0.);
    std::size_t         first = 0;
    for (unsigned int b = 0; b < bodies.size(); ++b)
      {
        if (piece >= first_piece[b] && piece < first_piece[b + 1])
          {
            const auto of_body =
              bodies[b].affine_coefficients(piece - first_piece[b],
                                            a,
                                            gradient);
            std::copy(of_body.begin(),
                      of_body.end(),
                      coefficients.begin() + first);
          }
        first += bodies[b].owned().n_elements();
      }
    return coefficients;
  }


#define INSTANTIATE(dim)                                                          \
  template SplineSpace<dim>::SplineSpace(std::vector<SplineSpace<dim>>,           \
                                         const MPI_Comm);                         \
  template unsigned int        SplineSpace<dim>::entry(const unsigned int,        \
                                                const unsigned int) const; \
  template void                SplineSpace<dim>::add_relevant(const IndexSet &);  \
  template std::vector<double> SplineSpace<dim>::affine_coefficients_of_body(     \
    const unsigned int, const double, const Tensor<1, dim> &) const;
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
