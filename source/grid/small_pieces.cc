// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/grid/small_pieces.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cstdint>
#include <limits>

namespace Morula
{
  namespace
  {
    /** Extents and contents of all pieces. */
    template <int dim>
    struct Extents
    {
      /** The extent of the tissue, µm: for each piece the upper corner, and the
       *  lower one with a minus, so that one maximum over ranks finds both. */
      std::vector<double> corners;
      /** For each piece the numbers of inner grid cells, of particles, of grid
       *  cells, and the sum of the coordinates of these: integers, so that the
       *  order of the ranks does not matter. */
      std::vector<std::int64_t> counts;

      static constexpr unsigned int n_counts = 3 + dim;
    };

    template <int dim>
    Extents<dim>
    extents(const Occupancy<dim>             &occupancy,
            const std::vector<GridCellClass> &classes,
            const SplineCopies<dim>          &copies,
            const MPI_Comm                    comm)
    {
      // Each rank looks at its own grid cells. A maximum and a sum over all
      // ranks give all pieces at once; the lower corners carry a minus, so that
      // one maximum serves both.
      Extents<dim> all;
      all.corners.assign(copies.n_pieces() * 2 * dim,
                         std::numeric_limits<double>::lowest());
      all.counts.assign(copies.n_pieces() * Extents<dim>::n_counts, 0);
      for (const unsigned int number : copies.own_nodes())
        {
          const unsigned int   piece  = copies.piece(number);
          const GridIndex<dim> index  = occupancy.nodes().index(number);
          const auto [lower, upper]   = occupancy.bounds(number);
          double *const       corners = &all.corners[piece * 2 * dim];
          std::int64_t *const counts =
            &all.counts[piece * Extents<dim>::n_counts];
          counts[0] += classes[number] == GridCellClass::inner;
          counts[1] += occupancy.n_particles(number);
          ++counts[2];
          for (unsigned int d = 0; d < dim; ++d)
            {
              corners[d]       = std::max(corners[d], upper[d]);
              corners[dim + d] = std::max(corners[dim + d], -lower[d]);
              counts[3 + d] += index[d];
            }
        }
      Utilities::MPI::max(all.corners, comm, all.corners);
      Utilities::MPI::sum(all.counts, comm, all.counts);
      return all;
    }
  } // namespace

  template <int dim>
  std::vector<std::pair<unsigned int, double>>
  PiecePolynomial<dim>::expression(const Point<dim> &x, const double h) const
  {
    std::vector<std::pair<unsigned int, double>> terms;
    // The terms of doc/theory.md (3.4) in the order of the unknowns: the
    // constant, the linear ones, and products of two coordinates.
    const Tensor<1, dim> xi      = (x - center) / h;
    unsigned int         unknown = first_unknown;
    terms.emplace_back(unknown++, 1.);
    for (unsigned int d = 0; d < dim; ++d)
      terms.emplace_back(unknown++, xi[d]);
    // The spline coefficient of ξ² is its value at the centre minus 1/4.
    if (quadratic)
      for (unsigned int d = 0; d < dim; ++d)
        for (unsigned int e = d; e < dim; ++e)
          terms.emplace_back(unknown++, xi[d] * xi[e] - (d == e ? 0.25 : 0.));
    return terms;
  }

  template <int dim>
  std::map<unsigned int, PiecePolynomial<dim>>
  find_small_pieces(const Occupancy<dim>             &occupancy,
                    const std::vector<GridCellClass> &classes,
                    const SplineCopies<dim>          &copies,
                    const MPI_Comm                    comm)
  {
    // A piece is judged by its extent and by what it holds, doc/theory.md,
    // section 3.5. All ranks have all pieces' sums, so they find the same small
    // pieces and the same polynomials, also of pieces of which they hold
    // nothing.
    const double     h         = occupancy.boxes().spacing();
    const Point<dim> grid_line = occupancy.boxes().corner(GridIndex<dim>{});
    const auto       all       = extents(occupancy, classes, copies, comm);
    std::map<unsigned int, PiecePolynomial<dim>> result;
    for (unsigned int piece = 0; piece < copies.n_pieces(); ++piece)
      {
        const auto corners = all.corners.begin() + piece * 2 * dim;
        const auto counts = all.counts.begin() + piece * Extents<dim>::n_counts;
        double     largest = 0.;
        for (unsigned int d = 0; d < dim; ++d)
          largest = std::max(largest, corners[d] + corners[dim + d]);
        const bool has_inner = counts[0] > 0;
        const bool few       = counts[1] < std::int64_t(BSpline<dim>::n);
        if (!has_inner || largest < (few ? 2. : 1.) * h)
          {
            PiecePolynomial<dim> &polynomial = result[piece];
            for (unsigned int d = 0; d < dim; ++d)
              // The mean of the grid cells' centres, from sums of integers.
              polynomial.center[d] =
                grid_line[d] + (1. * counts[3 + d] / counts[2] + 0.5) * h;
            polynomial.quadratic = !few && largest < h;
          }
      }
    return result;
  }

  template struct PiecePolynomial<2>;
  template struct PiecePolynomial<3>;
  MORULA_INSTANTIATE(find_small_pieces);
} // namespace Morula
