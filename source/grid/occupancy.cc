// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/grid/occupancy.h>
#include <morula/grid/particle_domain.h>

#include <deal.II/base/mpi.h>

namespace Morula
{
  namespace
  {
    /** Fill in units of 2^-40; a grid cell can be overfull a million times. */
    constexpr double resolution = 1099511627776.;
  } // namespace

  template <int dim>
  Occupancy<dim>::Occupancy(const GridBox<dim> &box,
                            const unsigned int  points_per_cell)
    : box_(box)
    , points_per_cell(points_per_cell)
    , volumes(box.size(), 0)
    , quadrature_points(box.size(), 0)
    , others(box.size(), 0)
  {}

  template <int dim>
  void
  Occupancy<dim>::add_particle(const Point<dim> &x, const double V)
  {
    const ParticleDomain<dim> domain(x, V);
    const Point<dim>          lower = domain.lower(), upper = domain.upper();
    GridIndex<dim> first = box_.locate(lower), last = box_.locate(upper);
    for (unsigned int d = 0; d < dim; ++d)
      {
        first[d] = std::max(first[d], box_.first()[d]);
        last[d]  = std::min(last[d], box_.first()[d] + box_.n()[d] - 1);
      }
    box_.for_range(
      first, last, [&](const unsigned int number, const GridIndex<dim> &index) {
        const Point<dim> corner  = box_.corner(index);
        double           overlap = 1.;
        for (unsigned int d = 0; d < dim; ++d)
          overlap *= std::max(0.,
                              std::min(upper[d], corner[d] + box_.spacing()) -
                                std::max(lower[d], corner[d])) /
                     box_.spacing();
        volumes[number] += std::llround(overlap * resolution);
      });
    domain.for_quadrature_points(
      domain.n_per_direction(box_.spacing(), points_per_cell),
      [&](const Point<dim> &point) {
        ++quadrature_points[box_.number(box_.locate(point))];
      });
    ++others[box_.number(box_.locate(x))];
  }

  template <int dim>
  void
  Occupancy<dim>::add_boundary_point(const Point<dim> &x)
  {
    ++others[box_.number(box_.locate(x))];
  }

  template <int dim>
  void
  Occupancy<dim>::sum(const MPI_Comm comm)
  {
    for (auto *table : {&volumes, &quadrature_points, &others})
      Utilities::MPI::sum(*table, comm, *table);
  }

  template <int dim>
  double
  Occupancy<dim>::fill(const unsigned int number) const
  {
    return volumes[number] / resolution;
  }

  template <int dim>
  unsigned int
  Occupancy<dim>::n_quadrature_points(const unsigned int number) const
  {
    return quadrature_points[number];
  }

  template <int dim>
  bool
  Occupancy<dim>::active(const unsigned int number) const
  {
    return quadrature_points[number] > 0 || others[number] > 0;
  }

  template <int dim>
  const GridBox<dim> &
  Occupancy<dim>::box() const
  {
    return box_;
  }

  template <int dim>
  std::vector<GridCellClass>
  classify(const Occupancy<dim> &occupancy, const double occupation_parameter)
  {
    const GridBox<dim>        &box = occupancy.box();
    std::vector<GridCellClass> classes(box.size(), GridCellClass::inactive);
    for (unsigned int number = 0; number < box.size(); ++number)
      {
        if (!occupancy.active(number))
          continue;
        double largest = 0.;
        box.for_neighbors(box.index(number),
                          1,
                          [&](const unsigned int neighbor, const auto &) {
                            largest =
                              std::max(largest, occupancy.fill(neighbor));
                          });
        const double threshold = occupation_parameter * std::min(1., largest);
        const bool   inner     = occupancy.fill(number) >= threshold - 1e-9 &&
                           occupancy.n_quadrature_points(number) >= (1u << dim);
        classes[number] = inner ? GridCellClass::inner : GridCellClass::cut;
      }
    return classes;
  }

  template class Occupancy<2>;
  template class Occupancy<3>;
  template std::vector<GridCellClass>
  classify(const Occupancy<2> &, const double);
  template std::vector<GridCellClass>
  classify(const Occupancy<3> &, const double);
} // namespace Morula
