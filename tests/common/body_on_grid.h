// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_body_on_grid_h
#define morula_tests_body_on_grid_h

#include <morula/grid/spline_space.h>
#include <morula/mechanics/equilibrium.h>
#include <morula/mechanics/material_points.h>
#include <morula/mechanics/spline_field.h>
#include <morula/particles/point_store.h>
#include <morula/particles/tissue.h>

#include <deal.II/base/mpi.h>
#include <deal.II/lac/trilinos_vector.h>

#include <cmath>
#include <optional>
#include <random>
#include <vector>

namespace Morula
{
  /** Calls @p check for both dimensions, with the dimension in the messages. */
#define MORULA_BOTH_DIMENSIONS(check) \
  {                                   \
    SCOPED_TRACE("2-D");              \
    check<2>();                       \
  }                                   \
  {                                   \
    SCOPED_TRACE("3-D");              \
    check<3>();                       \
  }

  template <int dim>
  Tensor<2, dim>
  unit_tensor()
  {
    return Tensor<2, dim>(unit_symmetric_tensor<dim>());
  }

  /** By an angle about the z axis. */
  template <int dim>
  Tensor<2, dim>
  rotation(const double angle)
  {
    Tensor<2, dim> Q = unit_tensor<dim>();
    Q[0][0] = Q[1][1] = std::cos(angle);
    Q[0][1]           = -(Q[1][0] = std::sin(angle));
    return Q;
  }

  /** Components in [-1, 1]. */
  template <int rank, int dim>
  Tensor<rank, dim>
  random_tensor(std::mt19937 &generator)
  {
    std::uniform_real_distribution<double> uniform(-1., 1.);
    Tensor<rank, dim>                      t;
    if constexpr (rank == 1)
      for (unsigned int d = 0; d < dim; ++d)
        t[d] = uniform(generator);
    else
      for (unsigned int d = 0; d < dim; ++d)
        t[d] = random_tensor<rank - 1, dim>(generator);
    return t;
  }

  /** The points of a lattice for which @p inside holds, within @p reach of
   *  @p center. */
  template <int dim, typename Inside>
  std::vector<Point<dim>>
  lattice_points(const Point<dim> &center,
                 const double      reach,
                 const double      spacing,
                 const Inside     &inside)
  {
    const int               n = static_cast<int>(std::ceil(reach / spacing));
    std::vector<Point<dim>> points;
    for (int k = dim == 3 ? -n : 0; k <= (dim == 3 ? n : 0); ++k)
      for (int j = -n; j <= n; ++j)
        for (int i = -n; i <= n; ++i)
          {
            const int  index[3] = {i, j, k};
            Point<dim> x        = center;
            for (unsigned int d = 0; d < dim; ++d)
              x[d] += (index[d] + 0.5) * spacing;
            if (inside(x))
              points.push_back(x);
          }
    return points;
  }

  /** All within @p reach in each direction. */
  template <int dim>
  std::vector<Point<dim>>
  lattice_points(const double reach, const double spacing)
  {
    return lattice_points<dim>(Point<dim>(), reach, spacing, [](const auto &) {
      return true;
    });
  }

  template <int dim>
  std::vector<Point<dim>>
  ball_points(const Point<dim> &center,
              const double      radius,
              const double      spacing)
  {
    return lattice_points<dim>(center, radius, spacing, [&](const auto &x) {
      return x.distance(center) < radius;
    });
  }

  /** The grid cells that a cell reaches. */
  template <int dim>
  GridRange<dim>
  range_of(const ParticleDomain<dim> &domain, const BackgroundGrid<dim> &grid)
  {
    const auto [lower, upper] = domain.bounds();
    return {grid.locate(lower), grid.locate(upper)};
  }

  template <int dim>
  std::vector<GridRange<dim>>
  ranges_of(const std::vector<ParticleDomain<dim>> &domains,
            const BackgroundGrid<dim>              &grid)
  {
    std::vector<GridRange<dim>> reached;
    for (const ParticleDomain<dim> &domain : domains)
      reached.push_back(range_of(domain, grid));
    return reached;
  }

  /** The cubes of cells of equal volume. */
  template <int dim>
  std::vector<ParticleDomain<dim>>
  domains_of(const std::vector<Point<dim>> &points, const double V)
  {
    std::vector<ParticleDomain<dim>> domains;
    for (const Point<dim> &x : points)
      domains.emplace_back(x, V);
    return domains;
  }

  /** Both rounds, of what this rank adds, on all ranks. */
  template <int dim>
  void
  occupy(Occupancy<dim>                         &occupancy,
         const BackgroundGrid<dim>              &grid,
         const std::vector<ParticleDomain<dim>> &domains,
         const std::vector<Point<dim>>          &boundary = {})
  {
    for (unsigned int i = 0; i < domains.size(); ++i)
      occupancy.add_particle(domains[i], i);
    for (const Point<dim> &x : boundary)
      occupancy.add_boundary_point(x);
    occupancy.sum(grid);
    for (unsigned int i = 0; i < domains.size(); ++i)
      occupancy.add_quadrature_points(domains[i], i);
    occupancy.sum_quadrature_points(grid);
  }

  /** The same of a box on one rank. */
  template <int dim>
  Occupancy<dim>
  occupancy_of(const GridBox<dim>                     &box,
               const std::vector<ParticleDomain<dim>> &domains,
               const std::vector<Point<dim>>          &boundary = {})
  {
    Occupancy<dim> occupancy(box);
    for (const ParticleDomain<dim> &domain : domains)
      occupancy.add_particle(domain);
    for (const Point<dim> &x : boundary)
      occupancy.add_boundary_point(x);
    occupancy.sum();
    for (const ParticleDomain<dim> &domain : domains)
      occupancy.add_quadrature_points(domain);
    return occupancy;
  }

  inline GridParameters
  grid_of_spacing(const double h)
  {
    GridParameters parameters;
    parameters.spacing = h;
    return parameters;
  }

  /**
   * A background grid with particles of given volumes, the same lists on all
   * ranks, and the splines around them.
   */
  template <int dim>
  struct BodyOnGrid
  {
    /** @param V of each particle */
    BodyOnGrid(const std::vector<Point<dim>> &particles,
               const double                   V,
               const GridParameters          &parameters = GridParameters(),
               const std::vector<Point<dim>> &boundary   = {},
               const MPI_Comm                 comm       = MPI_COMM_WORLD)
      : BodyOnGrid(particles,
                   std::vector<double>(particles.size(), V),
                   parameters,
                   boundary,
                   comm)
    {}

    BodyOnGrid(const std::vector<Point<dim>> &particles,
               const std::vector<double>     &volumes,
               const GridParameters          &parameters,
               const std::vector<Point<dim>> &boundary,
               const MPI_Comm                 comm)
      : particles(particles)
      , boundary(boundary)
      , comm(comm)
      , grid(parameters, comm)
    {
      const auto [first, last] = extent<dim>({&particles, &boundary}, grid);
      grid.enclose(first, last);
      const bool     first_rank = Utilities::MPI::this_mpi_process(comm) == 0;
      GridCellCounts weights; // the first rank counts all particles
      if (first_rank)
        for (const Point<dim> &x : particles)
          weights.push_back({grid.box().number(grid.box().locate(x)), 1});
      grid.partition(weights);
      std::vector<ParticleDomain<dim>> domains;
      for (std::size_t i = 0; first_rank && i < particles.size(); ++i)
        domains.emplace_back(particles[i], volumes[i]);
      std::vector<GridRange<dim>> reached = ranges_of(domains, grid);
      if (first_rank)
        for (const Point<dim> &x : boundary)
          reached.push_back({grid.locate(x), grid.locate(x)});
      Occupancy<dim> occupancy(GridWindow<dim>(grid, reached));
      occupy(occupancy,
             grid,
             domains,
             first_rank ? boundary : std::vector<Point<dim>>());
      space.emplace(grid, std::move(occupancy), parameters);
    }

    /** The piece of the body at a place. */
    unsigned int
    piece(const Point<dim> &x) const
    {
      return space->piece(grid.box().number(grid.box().locate(x)));
    }

    /** Those of @p points in active grid cells of this rank. */
    PointGroups
    group(const std::vector<Point<dim>> &points) const
    {
      std::map<unsigned int, std::vector<unsigned int>> by_cell;
      for (unsigned int i = 0; i < points.size(); ++i)
        by_cell[grid.box().number(grid.box().locate(points[i]))].push_back(i);
      PointGroups groups;
      groups.offsets.push_back(0);
      for (const auto &cell : space->grid_cells())
        {
          const auto &list = by_cell[cell.number];
          groups.points.insert(groups.points.end(), list.begin(), list.end());
          groups.offsets.push_back(groups.points.size());
        }
      return groups;
    }

    GroupedPoints<dim>
    grouped(const std::vector<Point<dim>> &points,
            const PointGroups             &groups) const
    {
      GroupedPoints<dim> result;
      result.offsets = groups.offsets;
      result.h       = grid.box().spacing();
      for (const unsigned int i : groups.points)
        result.xi.push_back(
          grid.box().unit_position(points[i], grid.box().locate(points[i])));
      return result;
    }

    /** All pieces' coefficients of the affine field a + A x: field(centre). */
    std::vector<double>
    affine(const Tensor<1, dim> &a, const Tensor<2, dim> &A) const
    {
      std::vector<double> sum(dim * space->owned().n_elements(), 0.);
      for (unsigned int piece = 0; piece < space->n_pieces(); ++piece)
        {
          const auto part = affine_displacement(*space, piece, a, A);
          for (std::size_t i = 0; i < sum.size(); ++i)
            sum[i] += part[i];
        }
      return sum;
    }

    /**
     * The coefficient vector with value(centre of the spline) at each unknown
     * spline. Not for pieces without inner grid cells.
     */
    template <typename Value>
    Equilibrium::Vector
    interpolate(const Value &value) const
    {
      const std::vector<double> centers =
        affine(Tensor<1, dim>(), unit_tensor<dim>());
      std::vector<double> values(centers.size());
      for (std::size_t s = 0; s < centers.size() / dim; ++s)
        {
          Point<dim> center;
          for (unsigned int d = 0; d < dim; ++d)
            center[d] = centers[s * dim + d];
          const Tensor<1, dim> v = value(center);
          for (unsigned int d = 0; d < dim; ++d)
            values[s * dim + d] = v[d];
        }
      return vector_of(values);
    }

    /** @param values of FieldUnknowns::owned(), in order */
    Equilibrium::Vector
    vector_of(const std::vector<double> &values) const
    {
      return FieldUnknowns<dim>(*space, comm).vector(values);
    }

    /** The field on each active grid cell of this rank, straight from the
     *  weights of SplineSpace::grid_cells(). */
    std::vector<LocalField<dim>>
    fields(const Equilibrium::Vector &u) const
    {
      constexpr unsigned int   n = BSpline<dim>::n;
      const FieldUnknowns<dim> unknowns(*space, comm);
      Equilibrium::Vector ghosted(unknowns.owned(), unknowns.relevant(), comm);
      ghosted = u;
      std::vector<LocalField<dim>> result;
      for (const auto &cell : space->grid_cells())
        {
          const unsigned int m = cell.unknowns.size();
          LocalField<dim>    field;
          for (unsigned int i = 0; i < dim; ++i)
            for (unsigned int a = 0; a < n; ++a)
              {
                field.coefficient[i][a] = 0.;
                for (unsigned int s = 0; s < m; ++s)
                  {
                    const double weight = cell.weights.empty() ?
                                            (s == a ? 1. : 0.) :
                                            cell.weights[a * m + s];
                    if (weight != 0.)
                      field.coefficient[i][a] +=
                        weight * ghosted(space->relevant().nth_index_in_set(
                                           cell.unknowns[s]) *
                                           dim +
                                         i);
                  }
              }
          result.push_back(field);
        }
      return result;
    }

    /** Calls visit(i, field, splines) for those of @p points on this rank. */
    template <typename Visit>
    void
    at_points(const std::vector<Point<dim>> &points,
              const Equilibrium::Vector     &u,
              const Visit                   &visit) const
    {
      const PointGroups        groups = group(points);
      const GroupedPoints<dim> list   = grouped(points, groups);
      const auto               all    = fields(u);
      for (unsigned int c = 0; c < all.size(); ++c)
        for (unsigned int k = groups.offsets[c]; k < groups.offsets[c + 1]; ++k)
          visit(groups.points[k],
                all[c],
                SplineValues<dim>(list.xi[k], list.h));
    }

    const std::vector<Point<dim>>   particles, boundary;
    const MPI_Comm                  comm;
    BackgroundGrid<dim>             grid;
    std::optional<SplineSpace<dim>> space;
  };
} // namespace Morula

#endif
