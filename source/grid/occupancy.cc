// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/send_records.h>
#include <morula/grid/bspline.h>
#include <morula/grid/occupancy.h>

#include <deal.II/base/mpi.h>

namespace Morula
{
  namespace
  {
    /** A row of so many grid cells is as thick as the grid along itself. Then
     *  no rank needs to know a row that runs through the parts of many:
     *  doc/theory.md, section 3.2. */
    constexpr std::size_t long_row = 8;

    /** A row of tissue shorter than so many grid spacings is thin. It may lie
     *  on both sides of one grid plane, and inner grid cells on both sides
     *  would have splines that hardly touch it. */
    constexpr double thin_row = 1.5;

    /** A grid cell with at least this part of the fullest one's volume counts
     *  as equally full, so that noise does not change the side from row to row.
     */
    constexpr double about_equal = 0.8;

    /** Calls visit(row) for the connected rows of nodes with tissue along one
     *  direction. */
    template <int dim, typename Visit>
    void
    for_each_row(const GridContents<dim> &contents,
                 const unsigned int       direction,
                 const Visit             &visit)
    {
      // Along a direction a row begins wherever the coordinate is the first of
      // its box. The window's boxes do not touch, so no row runs through two of
      // them. Where strands of tissue are parted, several rows are open at a
      // time: a node goes on with those that end in a node which it is linked
      // with. One step beyond the end closes the last rows.
      const GridNodes<dim>                  &nodes = contents.nodes();
      std::vector<std::vector<unsigned int>> open, next;
      const auto go_on = [&](const unsigned int node) {
        if (contents.volume(node) == 0)
          return;
        std::vector<unsigned int> row;
        for (std::vector<unsigned int> &before : open)
          if (!before.empty() && nodes.are_linked(before.back(), node))
            {
              if (row.empty())
                row = std::move(before);
              else
                row.insert(row.end(), before.begin(), before.end());
              before.clear();
            }
        row.push_back(node);
        next.push_back(std::move(row));
      };
      for (unsigned int k = 0; k < contents.window().boxes().size(); ++k)
        {
          const GridBox<dim> &box    = contents.window().boxes()[k];
          const unsigned int  begin  = contents.window().begin(k);
          unsigned int        stride = 1;
          for (unsigned int d = 0; d < direction; ++d)
            stride *= box.n()[d];
          const int n = box.n()[direction];
          for (unsigned int first = 0; first < box.size(); ++first)
            if (first / stride % n == 0)
              for (int i = 0; i <= n; ++i)
                {
                  // The next grid cell of a row is `stride` numbers away.
                  next.clear();
                  if (i < n)
                    nodes.for_parts(begin + first + i * stride, go_on);
                  for (const std::vector<unsigned int> &row : open)
                    if (!row.empty())
                      visit(row);
                  std::swap(open, next);
                }
        }
    }

    /** Distance from the first to the last tissue of a row, in units of h. */
    template <int dim>
    double
    length(const std::vector<unsigned int> &row,
           const unsigned int               direction,
           const GridContents<dim>         &contents)
    {
      // The first and the last grid cell count as far as the tissue reaches in
      // them, those in between as a whole.
      return contents.up(row.back(), direction) +
             contents.down(row.front(), direction) + row.size() - 2.;
    }

    template <int dim>
    double
    cross_section(const std::vector<unsigned int> &row,
                  const unsigned int               direction,
                  const GridContents<dim>         &contents)
    {
      // The smallest rectangle around the tissue of the row, from its farthest
      // reaches on either side in all grid cells.
      double area = 1.;
      for (unsigned int d = 0; d < dim; ++d)
        if (d != direction)
          {
            float up = 0.f, down = 0.f;
            for (const unsigned int number : row)
              {
                up   = std::max(up, contents.up(number, d));
                down = std::max(down, contents.down(number, d));
              }
            area *= up + down - 1.;
          }
      return area;
    }

    /** The largest value of a grid cell and its neighbours with tissue. */
    template <int dim>
    float
    largest_around(const std::vector<float> &values,
                   const unsigned int        number,
                   const GridContents<dim>  &contents)
    {
      float largest = values[number];
      contents.nodes().for_linked(
        number, [&](const unsigned int neighbor, const auto &) {
          if (contents.volume(neighbor) > 0)
            largest = std::max(largest, values[neighbor]);
        });
      return largest;
    }
  } // namespace

  template <int dim>
  void
  Occupancy<dim>::find_rows()
  {
    const unsigned int n = nodes().size();
    thicknesses.assign(n, 1.f);
    lengths.assign(n, 2.f);
    n_thin.assign(n, 0);
    candidates.assign(n, 1);
    // Rows in x choose their candidates first, rows in y among what is left,
    // then rows in z. So the order of the directions is part of the rule.
    for (unsigned int d = 0; d < dim; ++d)
      for_each_row(*this, d, [&](const std::vector<unsigned int> &row) {
        measure(row, d);
      });
  }

  template <int dim>
  void
  Occupancy<dim>::measure(const std::vector<unsigned int> &row,
                          const unsigned int               direction)
  {
    // One pass finds the volume and the largest candidate's volume. Then come
    // the two uses of a row: its thickness, volume over cross-section, for the
    // number of quadrature points; and its length, which says whether it is
    // thin. A thin row keeps one candidate, the first that is about as full as
    // the fullest, so that noise does not change sides from row to row
    // (doc/theory.md, section 3.2).
    std::int64_t sum = 0, largest = 0;
    for (const unsigned int number : row)
      {
        sum += this->volume(number);
        if (candidates[number])
          largest = std::max(largest, this->volume(number));
      }
    const float row_length = length(row, direction, *this);
    bool        found      = false;
    // A longer row is not thin along itself, and its ends may lie outside of
    // the window.
    if (row.size() < long_row)
      {
        const float thickness = sum / GridContents<dim>::resolution /
                                cross_section(row, direction, *this);
        for (const unsigned int number : row)
          thicknesses[number] = std::min(thicknesses[number], thickness);
      }
    if (row_length < thin_row)
      for (const unsigned int number : row)
        {
          lengths[number] = std::min(lengths[number], row_length);
          ++n_thin[number];
          candidates[number] = candidates[number] && !found &&
                               this->volume(number) >= about_equal * largest;
          found = found || candidates[number];
        }
  }

  template <int dim>
  double
  Occupancy<dim>::thickness(const unsigned int number) const
  {
    return largest_around(thicknesses, number, *this) *
           window().whole().spacing();
  }

  template <int dim>
  bool
  Occupancy<dim>::is_thin(const unsigned int number) const
  {
    return n_thin[number] > 0 &&
           largest_around(lengths, number, *this) < thin_row;
  }


  namespace
  {
    /** Tissue thinner than so many cells counts as one or two cells thick.
     *  Cells on a lattice have a whole number of layers, so half a cell is the
     *  widest margin on both sides. */
    constexpr double one_layer = 1.5, two_layers = 2.5;
  } // namespace


  template <int dim>
  void
  Occupancy<dim>::sum()
  {
    // The sums of one rank are complete. Rows follow from volumes and reaches;
    // the quadrature points of the second round depend on them.
    this->find_own();
    find_crowded();
    find_rows();
  }

  template <int dim>
  void
  Occupancy<dim>::sum(const BackgroundGrid<dim> &grid)
  {
    if (Utilities::MPI::n_mpi_processes(grid.communicator()) == 1)
      return sum();
    // The same follows as on one rank, but from the sums over ranks.
    GridContents<dim>::sum(grid);
    find_crowded();
    find_rows();
  }

  template <int dim>
  void
  Occupancy<dim>::add_quadrature_points(const ParticleDomain<dim>  &domain,
                                        const types::particle_index id)
  {
    // A point on a grid line may be shared: each share is a point of its own.
    unsigned int n_points = 0;
    domain.for_quadrature_points(
      n_points_per_edge(domain, id), [&](const Point<dim> &point) {
        for_each_share(point, [&](const Point<dim> &share, unsigned int) {
          this->add_quadrature_point(share, id);
          ++n_points;
        });
      });
    subdivides_ = subdivides_ || n_points > 1;
  }


  template <int dim>
  typename ParticleDomain<dim>::Numbers
  Occupancy<dim>::n_points_per_edge(const ParticleDomain<dim>  &domain,
                                    const types::particle_index id) const
  {
    // Thin tissue needs more points than its volume asks for, doc/theory.md,
    // section 3.2: two across a sheet, three across a rod, two where a rod is
    // two cells thick.
    const unsigned int number =
      nodes().node_of_cell(window().whole().locate(domain.position()), id);
    const double h = window().whole().spacing(), side = domain.side();
    const bool   rod   = n_thin[number] > 1; // or a cluster
    const auto   below = [&](const double n_layers) {
      // Most tissue is thick: the first test spares the neighbours' one.
      return thicknesses[number] * h < n_layers * side &&
             thickness(number) < n_layers * side;
    };
    unsigned int least = points_per_cell;
    if (below(one_layer))
      least = std::max(rod ? 3u : 2u, least);
    else if (rod && below(two_layers))
      least = std::max(2u, least);
    return domain.n_per_edge(h, least);
  }


  template class Occupancy<2>;
  template class Occupancy<3>;


  namespace
  {
    /** Whether an active grid cell is inner. */
    template <int dim>
    bool
    is_inner(const Occupancy<dim> &occupancy,
             const unsigned int    number,
             const double          occupation_parameter)
    {
      // Thin tissue goes first, as there only one grid cell of each thin row
      // may be inner. Then doc/theory.md (3.2): the threshold is measured by
      // the fullest neighbour that could be inner itself, so that sheets and
      // small clusters, which fill no grid cell, have inner ones. Last, there
      // must be enough quadrature points that the splines can be told apart.
      // All numbers are those of the window, which has seen the sums over all
      // ranks.
      const bool thin = occupancy.is_thin(number);
      if (thin && !occupancy.is_inner_candidate(number))
        return false;
      double       largest  = 0.;
      unsigned int n_points = 0;
      occupancy.nodes().for_linked(
        number, [&](const unsigned int neighbor, const auto &) {
          if (!thin || occupancy.is_inner_candidate(neighbor))
            largest = std::max(largest, occupancy.fill(neighbor));
          n_points += occupancy.n_quadrature_points(neighbor);
        });
      // 1e-9 absorbs the rounding of the product, as fills are exact multiples
      // of 2⁻⁴⁰.
      const double threshold = occupation_parameter * std::min(1., largest);
      return occupancy.fill(number) >= threshold - 1e-9 &&
             (thin || occupancy.n_quadrature_points(number) >= (1u << dim)) &&
             n_points >= BSpline<dim>::n;
    }
  } // namespace

  template <int dim>
  std::vector<GridCellClass>
  classify(const Occupancy<dim> &occupancy, const double occupation_parameter)
  {
    // Only grid cells far enough inside of the window get a class: the others'
    // neighbours are not known here. For them other ranks find it.
    std::vector<GridCellClass> classes(occupancy.nodes().size(),
                                       GridCellClass::empty);
    const auto                 set_class = [&](const unsigned int number) {
      if (!occupancy.active(number))
        {
          if (occupancy.fill(number) > 0.)
            classes[number] = GridCellClass::reached;
        }
      else
        classes[number] = is_inner(occupancy, number, occupation_parameter) ?
                                            GridCellClass::inner :
                                            GridCellClass::cut;
    };
    for (const GridRange<dim> &known :
         occupancy.window().inner(reach_of_classes<dim>()))
      occupancy.window().for_range(
        known, [&](const unsigned int number, const auto &) {
          occupancy.nodes().for_parts(number, set_class);
        });
    return classes;
  }

  MORULA_INSTANTIATE(classify);
} // namespace Morula
