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
    constexpr double longest = 4. / 3.;

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
          std::lower_bound(store.cells().begin(),
                           store.cells().end(),
                           number,
                           [](const auto &c, const unsigned int n) {
                             return c.number < n;
                           });
        if (cell != store.cells().end() && cell->number == number)
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
     * Whether a point of any rank may be farther than @p reaches least reaches
     * from all cells. Nearly all points have a cell near in their own grid
     * cell, so that this is far cheaper than to find the nearest ones.
     */
    template <int dim>
    bool
    any_far_away(const std::vector<Point<dim>> &points,
                 const Tissue<dim>             &tissue,
                 const double                   reaches)
    {
      const double near = reaches * least_reach * tissue.grid().box().spacing();
      bool         far  = false;
      for (const Point<dim> &x : points)
        far = far || !has_cell_near(x, tissue, near);
      return Utilities::MPI::logical_or(far, tissue.communicator());
    }

    /** What a stray needs to know of its nearest cell: position, F, reach. */
    template <int dim>
    PointList<dim>
    landmarks(const Tissue<dim> &tissue)
    {
      const double   h = tissue.grid().box().spacing();
      PointList<dim> list;
      list.n_slots = dim + dim * dim + 1;
      for (const auto &particle : tissue.cells().order())
        {
          const auto           cell = tissue.cell(particle);
          const Point<dim>     x    = particle->get_location();
          const Tensor<2, dim> F    = cell.deformation();
          list.ids.push_back(particle->get_id());
          list.positions.push_back(x);
          for (unsigned int d = 0; d < dim; ++d)
            list.properties.push_back(x[d]);
          for (unsigned int d = 0; d < dim; ++d)
            for (unsigned int e = 0; e < dim; ++e)
              list.properties.push_back(F[d][e]);
          list.properties.push_back(surface_reach(cell, h));
        }
      return list;
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
    const double part = (longest - distance / reach) / (longest - 1.);
    return std::min(1., std::max(0., part));
  }

  template <int dim>
  std::vector<double>
  trust_in_surface(const std::vector<Point<dim>> &points,
                   const Tissue<dim>             &tissue)
  {
    std::vector<double> trust(points.size(), 1.);
    if (!any_far_away(points, tissue, 1.))
      return trust;
    const PointList<dim>      cells = landmarks(tissue);
    const std::vector<double> nearest =
      nearest_properties(points, cells, tissue.grid());
    for (std::size_t p = 0; p < points.size(); ++p)
      {
        const double *const properties = &nearest[p * cells.n_slots];
        Point<dim>          cell;
        for (unsigned int d = 0; d < dim; ++d)
          cell[d] = properties[d];
        trust[p] = trust_in_surface(points[p].distance(cell),
                                    properties[cells.n_slots - 1]);
      }
    return trust;
  }

  template <int dim>
  std::uint64_t
  take_back_strays(Tissue<dim> &tissue)
  {
    const auto             &store = tissue.boundary_points();
    const MPI_Comm          comm  = tissue.communicator();
    std::vector<Point<dim>> queries;
    for (const auto &point : store.order())
      queries.push_back(point->get_location());
    if (Utilities::MPI::sum<std::uint64_t>(queries.size(), comm) == 0 ||
        !any_far_away(queries, tissue, longest))
      return 0;

    const PointList<dim>      cells = landmarks(tissue);
    const std::vector<double> nearest =
      nearest_properties(queries, cells, tissue.grid());
    PointList<dim> points = store.copy();
    std::uint64_t  n      = 0;
    for (std::size_t p = 0; p < points.size(); ++p)
      {
        const double *const cell  = &nearest[p * cells.n_slots];
        const double        leash = longest * cell[cells.n_slots - 1];
        Tensor<1, dim>      way; // to the cell
        for (unsigned int d = 0; d < dim; ++d)
          way[d] = cell[d] - points.positions[p][d];
        if (way.norm() <= leash * (1. + 1e-9))
          continue;
        double *const properties = &points.properties[p * points.n_slots];
        const BoundaryView<dim> point(
          ArrayView<const double>(properties, points.n_slots));
        if (point.condition() == SurfaceCondition::fixed)
          continue;
        ++n;
        points.positions[p] +=
          free_part(point, (1. - leash / way.norm()) * way);
        std::copy(cell + dim,
                  cell + dim + dim * dim,
                  properties + BoundarySlots<dim>::deformation);
      }
    n = Utilities::MPI::sum(n, comm);
    if (n > 0)
      tissue.place(tissue.cells().copy(), points);
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
