// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/grid/small_pieces.h>

#include <algorithm>
#include <cstdint>

namespace Morula
{
  namespace
  {
    /** Extent and content of a piece. */
    template <int dim>
    struct Extent
    {
      bool           inner        = false;
      std::uint64_t  n_particles  = 0;
      unsigned int   n_grid_cells = 0;
      Point<dim>     lower, upper;   // of the tissue, µm
      Tensor<1, dim> sum_of_centers; // of the grid cells, µm
    };

    /** The extent of each piece. */
    template <int dim>
    std::vector<Extent<dim>>
    extents(const Occupancy<dim>             &occupancy,
            const std::vector<GridCellClass> &classes,
            const SplineCopies<dim>          &copies)
    {
      const GridBox<dim>      &box = occupancy.box();
      std::vector<Extent<dim>> list(copies.n_pieces());
      for (unsigned int number = 0; number < box.size(); ++number)
        if (is_active(classes[number]))
          {
            Extent<dim> &extent       = list[copies.piece(number)];
            const auto [lower, upper] = occupancy.bounds(number);
            for (unsigned int d = 0; d < dim; ++d)
              {
                extent.lower[d] = extent.n_grid_cells == 0 ?
                                    lower[d] :
                                    std::min(extent.lower[d], lower[d]);
                extent.upper[d] = extent.n_grid_cells == 0 ?
                                    upper[d] :
                                    std::max(extent.upper[d], upper[d]);
              }
            extent.inner |= classes[number] == GridCellClass::inner;
            extent.n_particles += occupancy.n_particles(number);
            extent.sum_of_centers +=
              box.center(box.index(number)) - Point<dim>();
            ++extent.n_grid_cells;
          }
      return list;
    }
  } // namespace

  template <int dim>
  unsigned int
  PiecePolynomial<dim>::n_unknowns() const
  {
    return quadratic ? (dim + 1) * (dim + 2) / 2 : dim + 1;
  }

  template <int dim>
  std::vector<std::pair<unsigned int, double>>
  PiecePolynomial<dim>::expression(const Point<dim> &x, const double h) const
  {
    std::vector<std::pair<unsigned int, double>> terms;
    const Tensor<1, dim>                         xi      = (x - center) / h;
    unsigned int                                 unknown = first_unknown;
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
                    const SplineCopies<dim>          &copies)
  {
    const double h    = occupancy.box().spacing();
    const auto   list = extents(occupancy, classes, copies);
    std::map<unsigned int, PiecePolynomial<dim>> result;
    for (unsigned int piece = 0; piece < list.size(); ++piece)
      {
        const Extent<dim> &extent  = list[piece];
        double             largest = 0.;
        for (unsigned int d = 0; d < dim; ++d)
          largest = std::max(largest, extent.upper[d] - extent.lower[d]);
        const bool few = extent.n_particles < BSpline<dim>::n;
        if (!extent.inner || largest < (few ? 2. : 1.) * h)
          {
            PiecePolynomial<dim> &polynomial = result[piece];
            polynomial.center =
              Point<dim>(extent.sum_of_centers / extent.n_grid_cells);
            polynomial.quadratic = !few && largest < h;
          }
      }
    return result;
  }

  template struct PiecePolynomial<2>;
  template struct PiecePolynomial<3>;
  template std::map<unsigned int, PiecePolynomial<2>>
  find_small_pieces(const Occupancy<2> &,
                    const std::vector<GridCellClass> &,
                    const SplineCopies<2> &);
  template std::map<unsigned int, PiecePolynomial<3>>
  find_small_pieces(const Occupancy<3> &,
                    const std::vector<GridCellClass> &,
                    const SplineCopies<3> &);
} // namespace Morula
