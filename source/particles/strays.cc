// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/particles/boundary_state.h>
#include <morula/particles/nearest.h>
#include <morula/particles/strays.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/symmetric_tensor.h>

#include <algorithm>
#include <cmath>

namespace Morula
{
  namespace
  {
    /** How many reaches a boundary point may be away from its nearest cell. */
    constexpr double longest_reach = 4. / 3.;

    /** No reach is shorter than this, in units of h. */
    constexpr double least_reach = 0.25;

    /** Whether a cell of this rank, in the grid cell of @p x or a neighbouring
     *  one, is at most @p near away. */
    template <int dim>
    bool
    has_cell_near(const Point<dim>  &x,
                  const Tissue<dim> &tissue,
                  const double       near)
    {
      const GridBox<dim> &box   = tissue.grid().box();
      const auto         &store = tissue.cells();
      const auto          is_in = [&](const unsigned int number) {
        const auto cell =
          std::lower_bound(store.grid_cells().begin(),
                           store.grid_cells().end(),
                           number,
                           [](const auto &c, const unsigned int n) {
                             return c.number < n;
                           });
        if (cell != store.grid_cells().end() && cell->number == number)
          for (unsigned int p = cell->begin; p < cell->end; ++p)
            if (x.distance_square(store.order()[p]->get_location()) <=
                near * near)
              return true;
        return false;
      };
      const GridIndex<dim> index = box.locate(x);
      if (is_in(box.number(index)))
        return true;
      bool found = false;
      box.for_neighbors(index, 1, [&](const unsigned int number, const auto &) {
        found = found || is_in(number);
      });
      return found;
    }

    /**
     * Numbers of the points that may be farther than @p reaches least reaches
     * from all cells. Nearly all points have a cell near in their own grid
     * cell, so that this is far cheaper than to find the nearest ones.
     */
    template <int dim>
    std::vector<unsigned int>
    far_away(const std::vector<Point<dim>> &points,
             const Tissue<dim>             &tissue,
             const double                   reaches)
    {
      const double near = reaches * least_reach * tissue.grid().box().spacing();
      std::vector<unsigned int> found;
      for (unsigned int p = 0; p < points.size(); ++p)
        if (!has_cell_near(points[p], tissue, near))
          found.push_back(p);
      return found;
    }

    /** What a stray needs to know of its nearest cell: position, F, reach. */
    template <int dim>
    constexpr unsigned int n_landmark = dim + dim * dim + 1;

    template <int dim>
    std::vector<double>
    nearest_landmarks(const std::vector<Point<dim>> &queries,
                      const Tissue<dim>             &tissue)
    {
      const double h    = tissue.grid().box().spacing();
      const auto append = [&](const unsigned int p, std::vector<double> &list) {
        const auto          &particle = tissue.cells().order()[p];
        const auto           cell     = tissue.cell(particle);
        const Point<dim>     x        = particle->get_location();
        const Tensor<2, dim> F        = cell.deformation();
        for (unsigned int d = 0; d < dim; ++d)
          list.push_back(x[d]);
        for (unsigned int d = 0; d < dim; ++d)
          for (unsigned int e = 0; e < dim; ++e)
            list.push_back(F[d][e]);
        list.push_back(surface_reach(cell, h));
      };
      return nearest_properties(queries,
                                tissue.cells(),
                                {n_landmark<dim>, append, false},
                                tissue.grid());
    }

    /** Points that are perhaps strays (far_away()), and the landmarks of the
     *  cells nearest to them. Collective. */
    template <int dim>
    std::pair<std::vector<unsigned int>, std::vector<double>>
    strays(const std::vector<Point<dim>> &points,
           const Tissue<dim>             &tissue,
           const double                   reaches)
    {
      const std::vector<unsigned int> far = far_away(points, tissue, reaches);
      if (!Utilities::MPI::logical_or(!far.empty(), tissue.communicator()))
        return {};
      std::vector<Point<dim>> queries;
      for (const unsigned int p : far)
        queries.push_back(points[p]);
      return {far, nearest_landmarks(queries, tissue)};
    }

    /** The part of a motion that the point's condition leaves free. */
    template <int dim>
    Tensor<1, dim>
    free_part(const BoundaryView<dim> &point, const Tensor<1, dim> &motion)
    {
      if (point.condition() == SurfaceCondition::slip)
        return motion -
               (motion * point.initial_normal()) * point.initial_normal();
      return motion;
    }
  } // namespace

  template <int dim>
  double
  surface_reach(const CellView<dim, const double> &cell, const double h)
  {
    const Tensor<2, dim> F_g = cell.growth();
    const Tensor<2, dim> F_e = cell.deformation() * invert(F_g);
    // An upper bound, which is exact without shear; the eigenvalues of nearly
    // isotropic tensors may come out as no numbers.
    const double stretch = std::sqrt(l1_norm(F_e * transpose(F_e)));
    const double width =
      std::pow(cell.initial_volume() * determinant(F_g), 1. / dim);
    return std::max(1.5 * stretch * width, least_reach * h);
  }

  double
  trust_in_surface(const double distance, const double reach)
  {
    const double part =
      (longest_reach - distance / reach) / (longest_reach - 1.);
    return std::min(1., std::max(0., part));
  }

  template <int dim>
  std::vector<double>
  trust_in_surface(const std::vector<Point<dim>> &points,
                   const Tissue<dim>             &tissue)
  {
    const auto [far, nearest] = strays(points, tissue, 1.);
    std::vector<double> trust(points.size(), 1.);
    for (std::size_t k = 0; k < far.size(); ++k)
      {
        const double *const landmark = &nearest[k * n_landmark<dim>];
        Point<dim>          cell;
        for (unsigned int d = 0; d < dim; ++d)
          cell[d] = landmark[d];
        trust[far[k]] = trust_in_surface(points[far[k]].distance(cell),
                                         landmark[n_landmark<dim> - 1]);
      }
    return trust;
  }

  template <int dim>
  std::uint64_t
  take_back_strays(Tissue<dim> &tissue)
  {
    const auto             &store = tissue.boundary_points();
    std::vector<Point<dim>> positions;
    for (const auto &point : store.order())
      positions.push_back(point->get_location());
    const auto [far, nearest] = strays(positions, tissue, longest_reach);

    std::uint64_t n = 0;
    for (std::size_t k = 0; k < far.size(); ++k)
      {
        const unsigned int  p     = far[k];
        const double *const cell  = &nearest[k * n_landmark<dim>];
        const double        leash = longest_reach * cell[n_landmark<dim> - 1];
        Tensor<1, dim>      way; // to the cell
        for (unsigned int d = 0; d < dim; ++d)
          way[d] = cell[d] - positions[p][d];
        if (way.norm() <= leash * (1. + 1e-9))
          continue;
        const BoundaryView<dim> point(
          boundary_properties<dim>(store.order()[p]));
        if (point.condition() == SurfaceCondition::fixed)
          continue;
        ++n;
        positions[p] += free_part(point, (1. - leash / way.norm()) * way);
        std::copy(cell + dim,
                  cell + dim + dim * dim,
                  tissue.boundary_properties(p).begin() +
                    BoundarySlots<dim>::deformation);
      }
    n = Utilities::MPI::sum(n, tissue.communicator());
    if (n > 0)
      {
        std::vector<Point<dim>> cells;
        for (const auto &cell : tissue.cells().order())
          cells.push_back(cell->get_location());
        tissue.move(cells, positions);
      }
    return n;
  }

#define INSTANTIATE(dim)                                             \
  template double surface_reach(const CellView<dim, const double> &, \
                                const double);                       \
  template std::vector<double> trust_in_surface(                     \
    const std::vector<Point<dim>> &, const Tissue<dim> &);           \
  template std::uint64_t take_back_strays(Tissue<dim> &);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
