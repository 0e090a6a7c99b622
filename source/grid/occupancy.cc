// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/grid/occupancy.h>

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace Morula
{
  namespace
  {
    /** Units of fill per full grid cell, 2^40. A grid cell can be overfull a
     *  million times before the integers overflow. */
    constexpr double resolution = 1099511627776.;

    /** Tissue thinner than so many cells counts as one or two cells thick. */
    constexpr double one_layer = 1.5, two_layers = 2.5;

    /** A row of so many grid cells is as thick as the grid along itself. */
    constexpr std::size_t long_row = 8;

    /** A row of tissue shorter than so many grid spacings is thin. */
    constexpr double thin_row = 1.5;

    /** A grid cell with at least this part of the fullest one's volume counts
     *  as equally full. */
    constexpr double about_equal = 0.8;
  } // namespace

  template <int dim>
  Occupancy<dim>::Occupancy(const GridWindow<dim> &window,
                            const unsigned int     points_per_cell,
                            const bool             share_points)
    : window_(window)
    , points_per_cell(points_per_cell)
    , share_points(share_points)
  {
    resize();
  }

  template <int dim>
  Occupancy<dim>::Occupancy(const GridBox<dim> &box)
    : Occupancy(GridWindow<dim>(box))
  {}

  template <int dim>
  void
  Occupancy<dim>::resize()
  {
    box_ = window_.box();
    for (auto *table :
         {&volumes, &quadrature_points, &particles, &boundary_points})
      table->assign(box_.size(), 0);
    reaches.assign(box_.size() * 2 * dim, 0.f);
  }

  template <int dim>
  void
  Occupancy<dim>::add_particle(const ParticleDomain<dim> &domain)
  {
    const Point<dim> lower = domain.lower(), upper = domain.upper();
    GridIndex<dim>   first = box_.locate(lower), last = box_.locate(upper);
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
          {
            const double from =
              std::max(0., (lower[d] - corner[d]) / box_.spacing());
            const double to =
              std::min(1., (upper[d] - corner[d]) / box_.spacing());
            overlap *= std::max(0., to - from);
            float *const reach = &reaches[(number * dim + d) * 2];
            reach[0]           = std::max(reach[0], static_cast<float>(to));
            reach[1] = std::max(reach[1], static_cast<float>(1. - from));
          }
        volumes[number] += std::llround(overlap * resolution);
      });
    ++particles[box_.number(box_.locate(domain.position()))];
  }

  template <int dim>
  void
  Occupancy<dim>::add_boundary_point(const Point<dim> &x)
  {
    ++boundary_points[box_.number(box_.locate(x))];
  }

  template <int dim>
  void
  Occupancy<dim>::sum()
  {
    find_own();
    find_crowded();
    measure_rows();
  }

  template <int dim>
  void
  Occupancy<dim>::sum(const BackgroundGrid<dim> &grid)
  {
    if (Utilities::MPI::n_mpi_processes(grid.communicator()) == 1)
      return sum();
    spread(window_.to_owners(records(), grid));
    find_crowded();
    measure_rows();
  }

  template <int dim>
  void
  Occupancy<dim>::sum_quadrature_points(const BackgroundGrid<dim> &grid)
  {
    if (Utilities::MPI::n_mpi_processes(grid.communicator()) == 1)
      return;
    struct Count
    {
      unsigned int number, n;
    };
    std::vector<Count> counts, own;
    for (unsigned int number = 0; number < box_.size(); ++number)
      if (quadrature_points[number] > 0)
        counts.push_back(
          {window_.whole().number(box_.index(number)),
           static_cast<unsigned int>(quadrature_points[number])});
    const auto place = [&](const Count &count) {
      return box_.number(window_.whole().index(count.number));
    };
    std::fill(quadrature_points.begin(), quadrature_points.end(), 0);
    for (const Count &count : window_.to_owners(counts, grid))
      quadrature_points[place(count)] += count.n;
    for (unsigned int number = 0; number < box_.size(); ++number)
      if (quadrature_points[number] > 0)
        own.push_back({window_.whole().number(box_.index(number)),
                       static_cast<unsigned int>(quadrature_points[number])});
    for (const Count &count : window_.to_windows(own))
      quadrature_points[place(count)] = count.n;
  }

  template <int dim>
  void
  Occupancy<dim>::widen(const BackgroundGrid<dim> &grid)
  {
    const unsigned int rank =
      Utilities::MPI::this_mpi_process(grid.communicator());
    std::vector<Record> own;
    for (const Record &record : records())
      if (grid.owner(record.number) == rank)
        own.push_back(record);
    window_.widen();
    spread(own);
    measure_rows();
  }

  template <int dim>
  void
  Occupancy<dim>::spread(const std::vector<Record> &list)
  {
    resize();
    for (const Record &record : list)
      add(record);
    find_own();
    for (const Record &record : window_.to_windows(records()))
      add(record);
  }

  /** Takes all that is there for this rank's. */
  template <int dim>
  void
  Occupancy<dim>::find_own()
  {
    own_.clear();
    for (unsigned int number = 0; number < box_.size(); ++number)
      if (holds_something(number))
        own_.push_back(number);
  }

  template <int dim>
  bool
  Occupancy<dim>::holds_something(const unsigned int number) const
  {
    const auto reach = reaches.begin() + number * 2 * dim;
    return volumes[number] > 0 || active(number) ||
           std::any_of(reach, reach + 2 * dim, [](const float r) {
             return r > 0.f;
           });
  }

  template <int dim>
  typename Occupancy<dim>::Record
  Occupancy<dim>::record(const unsigned int number) const
  {
    Record record{window_.whole().number(box_.index(number)),
                  {},
                  {{volumes[number],
                    quadrature_points[number],
                    particles[number],
                    boundary_points[number]}}};
    std::copy_n(reaches.begin() + number * 2 * dim,
                2 * dim,
                record.reaches.begin());
    return record;
  }

  template <int dim>
  std::vector<typename Occupancy<dim>::Record>
  Occupancy<dim>::records() const
  {
    std::vector<Record> list;
    for (unsigned int number = 0; number < box_.size(); ++number)
      if (holds_something(number))
        list.push_back(record(number));
    return list;
  }

  template <int dim>
  void
  Occupancy<dim>::add(const Record &record)
  {
    const unsigned int number =
      box_.number(window_.whole().index(record.number));
    volumes[number] += record.counts[0];
    quadrature_points[number] += record.counts[1];
    particles[number] += record.counts[2];
    boundary_points[number] += record.counts[3];
    for (unsigned int k = 0; k < 2 * dim; ++k)
      {
        float &reach = reaches[number * 2 * dim + k];
        reach        = std::max(reach, record.reaches[k]);
      }
  }

  template <int dim>
  void
  Occupancy<dim>::find_crowded()
  {
    std::vector<unsigned int> found;
    for (const unsigned int number : own_)
      if (boundary_points[number] > Utilities::pow(4, dim))
        found.push_back(window_.whole().number(box_.index(number)));
    crowded_.clear();
    for (const auto &list : gather_everywhere(found, window_.communicator()))
      crowded_.insert(crowded_.end(), list.begin(), list.end());
    std::sort(crowded_.begin(), crowded_.end());
  }

  template <int dim>
  void
  Occupancy<dim>::measure_rows()
  {
    thicknesses.assign(box_.size(), 1.f);
    lengths.assign(box_.size(), 2.f);
    n_thin.assign(box_.size(), 0);
    candidates.assign(box_.size(), 1);
    unsigned int              stride = 1;
    std::vector<unsigned int> row;
    for (unsigned int d = 0; d < dim; ++d)
      {
        for (unsigned int first = 0; first < box_.size(); ++first)
          {
            if (first / stride % box_.n()[d] != 0)
              continue;
            for (int i = 0; i <= box_.n()[d]; ++i)
              {
                const unsigned int number = first + i * stride;
                if (i < box_.n()[d] && volumes[number] > 0)
                  row.push_back(number);
                else if (!row.empty())
                  {
                    measure_row(row, d);
                    row.clear();
                  }
              }
          }
        stride *= box_.n()[d];
      }
  }

  template <int dim>
  void
  Occupancy<dim>::measure_row(const std::vector<unsigned int> &row,
                              const unsigned int               direction)
  {
    std::int64_t sum = 0, largest = 0;
    for (const unsigned int number : row)
      {
        sum += volumes[number];
        if (candidates[number])
          largest = std::max(largest, volumes[number]);
      }
    const float thickness  = sum / resolution / cross_section(row, direction);
    const float row_length = length(row, direction);
    bool        found      = false;
    for (const unsigned int number : row)
      {
        if (row.size() < long_row)
          thicknesses[number] = std::min(thicknesses[number], thickness);
        if (!(row_length < thin_row))
          continue;
        lengths[number] = std::min(lengths[number], row_length);
        ++n_thin[number];
        candidates[number] = candidates[number] && !found &&
                             volumes[number] >= about_equal * largest;
        found = found || candidates[number];
      }
  }

  /** Distance from the first to the last tissue of a row, in units of h. */
  template <int dim>
  double
  Occupancy<dim>::length(const std::vector<unsigned int> &row,
                         const unsigned int               direction) const
  {
    return reaches[(row.back() * dim + direction) * 2] +
           reaches[(row.front() * dim + direction) * 2 + 1] + row.size() - 2.;
  }

  template <int dim>
  double
  Occupancy<dim>::cross_section(const std::vector<unsigned int> &row,
                                const unsigned int direction) const
  {
    double area = 1.;
    for (unsigned int d = 0; d < dim; ++d)
      if (d != direction)
        {
          float up = 0.f, down = 0.f;
          for (const unsigned int number : row)
            {
              up   = std::max(up, reaches[(number * dim + d) * 2]);
              down = std::max(down, reaches[(number * dim + d) * 2 + 1]);
            }
          area *= up + down - 1.;
        }
    return area;
  }

  template <int dim>
  void
  Occupancy<dim>::add_quadrature_points(const ParticleDomain<dim> &domain)
  {
    domain.for_quadrature_points(
      n_points_per_edge(domain), [&](const Point<dim> &point) {
        for_each_share(point, [&](const Point<dim> &share, unsigned int) {
          ++quadrature_points[box_.number(box_.locate(share))];
        });
      });
  }

  template <int dim>
  typename ParticleDomain<dim>::Numbers
  Occupancy<dim>::n_points_per_edge(const ParticleDomain<dim> &domain) const
  {
    const unsigned int number = box_.number(box_.locate(domain.position()));
    const double       side   = domain.side();
    const bool         rod    = n_thin[number] > 1; // or a cluster
    const auto         below  = [&](const double n_layers) {
      // Most tissue is thick: the first test spares the neighbours' one.
      return thicknesses[number] * box_.spacing() < n_layers * side &&
             thickness(number) < n_layers * side;
    };
    unsigned int least = points_per_cell;
    if (below(one_layer))
      least = std::max(rod ? 3u : 2u, least);
    else if (rod && below(two_layers))
      least = std::max(2u, least);
    return domain.n_per_edge(box_.spacing(), least);
  }

  template <int dim>
  double
  Occupancy<dim>::fill(const unsigned int number) const
  {
    return volumes[number] / resolution;
  }

  template <int dim>
  double
  Occupancy<dim>::thickness(const unsigned int number) const
  {
    return largest_around(thicknesses, number) * box_.spacing();
  }

  template <int dim>
  bool
  Occupancy<dim>::is_thin(const unsigned int number) const
  {
    return n_thin[number] > 0 && largest_around(lengths, number) < thin_row;
  }

  /** The largest value of a grid cell and its neighbours with tissue. */
  template <int dim>
  float
  Occupancy<dim>::largest_around(const std::vector<float> &values,
                                 const unsigned int        number) const
  {
    float largest = values[number];
    box_.for_neighbors(box_.index(number),
                       1,
                       [&](const unsigned int neighbor, const auto &) {
                         if (volumes[neighbor] > 0)
                           largest = std::max(largest, values[neighbor]);
                       });
    return largest;
  }

  template <int dim>
  std::pair<Point<dim>, Point<dim>>
  Occupancy<dim>::bounds(const unsigned int number) const
  {
    Point<dim> lower = box_.corner(box_.index(number)), upper = lower;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const float *const reach = &reaches[(number * dim + d) * 2];
        upper[d] += reach[0] * box_.spacing();
        lower[d] += (1. - reach[1]) * box_.spacing();
      }
    return {lower, upper};
  }

  template <int dim>
  std::uint64_t
  Occupancy<dim>::n_particles(const unsigned int number) const
  {
    return particles[number];
  }

  template <int dim>
  unsigned int
  Occupancy<dim>::n_quadrature_points(const unsigned int number) const
  {
    return quadrature_points[number];
  }

  template <int dim>
  bool
  Occupancy<dim>::crowded(const Point<dim> &x) const
  {
    const GridBox<dim>  &whole = window_.whole();
    const GridIndex<dim> index = whole.locate(x);
    return whole.contains(index) && std::binary_search(crowded_.begin(),
                                                       crowded_.end(),
                                                       whole.number(index));
  }

  template <int dim>
  bool
  Occupancy<dim>::active(const unsigned int number) const
  {
    return quadrature_points[number] > 0 || particles[number] > 0 ||
           boundary_points[number] > 0;
  }

  template <int dim>
  bool
  Occupancy<dim>::is_inner_candidate(const unsigned int number) const
  {
    return candidates[number];
  }

  template <int dim>
  const GridBox<dim> &
  Occupancy<dim>::box() const
  {
    return box_;
  }

  template <int dim>
  const GridWindow<dim> &
  Occupancy<dim>::window() const
  {
    return window_;
  }

  template <int dim>
  const std::vector<unsigned int> &
  Occupancy<dim>::own() const
  {
    return own_;
  }

  template class Occupancy<2>;
  template class Occupancy<3>;
} // namespace Morula
