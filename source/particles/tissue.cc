// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/send_records.h>
#include <morula/particles/tissue.h>

#include <cmath>
#include <limits>
#include <utility>

namespace Morula
{
  namespace
  {
    /** Load of the fullest rank over the mean that is put up with. All ranks
     *  wait for the fullest, so this is the time that is lost; a new partition
     *  moves cells and makes the next step dearer. */
    constexpr double worst_imbalance = 1.15;

    /** The corners of the smallest box around the domains of cells, which are
     *  cell(i): the grid must reach as far. None if there are no cells. */
    template <int dim, typename Cell>
    std::vector<Point<dim>>
    domain_corners(const std::vector<Point<dim>> &positions, const Cell &cell)
    {
      if (positions.empty())
        return {};
      Point<dim> lower = positions[0], upper = positions[0];
      const auto include = [&](const Point<dim> &first,
                               const Point<dim> &last) {
        for (unsigned int d = 0; d < dim; ++d)
          {
            lower[d] = std::min(lower[d], first[d]);
            upper[d] = std::max(upper[d], last[d]);
          }
      };
      // All positions first: then most cells, which lie inside of that box by
      // more than their size, need no bounds of their own.
      for (const Point<dim> &x : positions)
        include(x, x);
      for (std::size_t i = 0; i < positions.size(); ++i)
        {
          const Point<dim> &x    = positions[i];
          double            room = std::numeric_limits<double>::infinity();
          for (unsigned int d = 0; d < dim; ++d)
            room = std::min({room, x[d] - lower[d], upper[d] - x[d]});
          const DeformedCube<dim> shape = cell_shape<dim>(cell(i));
          if (!shape.is_within(room))
            {
              const auto bounds = shape.at(x).bounds();
              include(bounds.first, bounds.second);
            }
        }
      return {lower, upper};
    }

    template <int dim>
    std::vector<Point<dim>>
    domain_corners(const PointList<dim> &cells, const CellColumns<dim> &columns)
    {
      return domain_corners(cells.positions, [&](const std::size_t i) {
        return CellView<dim, const double>(cells.row(i), columns);
      });
    }
  } // namespace

  template <int dim>
  bool
  Tissue<dim>::balanced(const std::vector<Point<dim>> &positions) const
  {
    const unsigned int n_ranks =
      Utilities::MPI::n_mpi_processes(grid_.communicator());
    if (n_ranks == 1)
      return true;
    double load = 0.;
    // Each owner counts the cells that it would have.
    for (const GridCellCount &count : count_points(positions, grid_))
      load += count.n;
    const auto loads = Utilities::MPI::min_max_avg(load, grid_.communicator());
    const double last_total = grid_.total_weight();
    // A partition of few grid cells may not get any better. So another one is
    // tried only after the number of cells has changed by a twentieth.
    return loads.max * n_ranks <= worst_imbalance * loads.sum ||
           std::abs(loads.sum - last_total) <= 0.05 * last_total;
  }

  template <int dim>
  void
  Tissue<dim>::place(PointList<dim> cells, PointList<dim> boundary_points)
  {
    cells_.clear();
    boundary_points_.clear();
    // The box of the grid must hold all domains and boundary points, of all
    // ranks. A new triangulation is made only if it does not, a new partition
    // also if the load has got out of balance. Either makes the stores empty,
    // and bound to the new triangulation.
    const std::vector<Point<dim>> corners =
      domain_corners(cells, cells_.columns());
    const auto [first, last] =
      extent<dim>({&corners, &boundary_points.positions}, grid_);
    bool made_anew = !grid_.covers(first, last);
    if (made_anew)
      grid_.enclose(first, last);
    if (made_anew || !balanced(cells.positions))
      {
        grid_.partition(count_points(cells.positions, grid_));
        made_anew = true;
      }
    if (made_anew)
      {
        cells_.attach(grid_);
        boundary_points_.attach(grid_);
      }
    cells_.insert(std::move(cells), grid_);
    boundary_points_.insert(std::move(boundary_points), grid_);
  }

  template <int dim>
  void
  Tissue<dim>::move(const std::vector<Point<dim>> &cells,
                    const std::vector<Point<dim>> &boundary_points)
  {
    const std::vector<Point<dim>> corners =
      domain_corners(cells, [&](const std::size_t i) {
        return std::as_const(cells_)[i];
      });
    const auto [first, last] = extent<dim>({&corners, &boundary_points}, grid_);
    // Both questions are answered by all ranks alike. If the box or the
    // partition has to change all points are placed anew; else only those
    // travel that change their grid cell.
    if (!grid_.covers(first, last) || !balanced(cells))
      {
        PointList<dim> all = cells_.copy(), surface = boundary_points_.copy();
        all.positions     = cells;
        surface.positions = boundary_points;
        place(std::move(all), std::move(surface));
        return;
      }
    cells_.move(cells, grid_);
    boundary_points_.move(boundary_points, grid_);
  }

  template <int dim>
  void
  Tissue<dim>::restore(PointList<dim>        cells,
                       PointList<dim>        boundary_points,
                       const GridIndex<dim> &first,
                       const GridIndex<dim> &n,
                       const GridCellCounts &weights)
  {
    // Box and partition come from the snapshot rather than from the points: a
    // run that was not stopped has these, and its sums depend on them.
    grid_.make(first, n);
    grid_.partition(weights);
    cells_.attach(grid_);
    boundary_points_.attach(grid_);
    cells_.insert(std::move(cells), grid_);
    boundary_points_.insert(std::move(boundary_points), grid_);
  }

  template <int dim>
  void
  Tissue<dim>::replace(const std::vector<unsigned int> &mothers,
                       const PointList<dim>            &daughters)
  {
    // Daughters stand next to their mothers, but these may be at the edge of
    // the box.
    const std::vector<Point<dim>> corners =
      domain_corners(daughters, cells_.columns());
    const auto [first, last] = extent<dim>({&corners}, grid_);
    if (!grid_.covers(first, last))
      {
        cells_.replace(mothers, PointList<dim>(daughters.n_numbers), grid_);
        PointList<dim> all = daughters;
        all.append(cells_.take());
        place(std::move(all), boundary_points_.copy());
        return;
      }
    cells_.replace(mothers, daughters, grid_);
  }

  template <int dim>
  SplineSpace<dim>
  Tissue<dim>::splines(const bool share_points) const
  {
    // Each body is put on the grid as if it were alone, so that no rule of the
    // grid (thin tissue, inner grid cells, small pieces, extension) ever sees
    // two of them: doc/theory.md, section 3.3. Their unknowns are numbered
    // together then. Where a body can touch itself all are put on the grid
    // together, part by part.
    if (!cells_.has_bodies())
      return unparted_splines(share_points);
    if (cells_.has_parts())
      return splines_around([](const unsigned int) { return true; },
                            share_points,
                            parting_);
    std::vector<SplineSpace<dim>> spaces;
    for (unsigned int b = 0; b < n_bodies(*this); ++b)
      spaces.push_back(
        splines_around([b](const unsigned int body) { return body == b; },
                       share_points));
    return SplineSpace<dim>(std::move(spaces), communicator());
  }

  template <int dim>
  void
  Tissue<dim>::part()
  {
    if (!cells_.has_parts())
      return;
    parting_ = std::make_shared<const Parting<dim>>(find_parting(*this));
    std::vector<unsigned int> parts;
    for (const auto &grid_cell : cells_.grid_cells())
      for (unsigned int p = grid_cell.begin; p < grid_cell.end; ++p)
        parts.push_back(parting_->part_of_cell(cells_.id(p), grid_cell.number));
    cells_.set_parts(parts, grid_);
    parts.clear();
    for (unsigned int p = 0; p < boundary_points_.size(); ++p)
      parts.push_back(parting_->part_of_patch(boundary_points_.id(p)));
    boundary_points_.set_parts(parts, grid_);
  }

  template <int dim>
  SplineSpace<dim>
  Tissue<dim>::unparted_splines(const bool share_points) const
  {
    return splines_around([](const unsigned int) { return true; },
                          share_points);
  }


  template <int dim>
  template <typename Belongs>
  SplineSpace<dim>
  Tissue<dim>::splines_around(const Belongs            &belongs,
                              const bool                share_points,
                              const SharedParting<dim> &parting) const
  {
    // The first round of the occupancy takes all cells and boundary points, and
    // sums over ranks. It shows where tissue is thin, and so how many
    // quadrature points the cells need; these make the second round:
    // doc/theory.md, sections 3.1 and 3.2. Grid cells, classes and splines
    // follow from both.
    std::vector<ParticleDomain<dim>>   domains;
    std::vector<types::particle_index> ids;
    domains.reserve(cells_.size());
    for (unsigned int p = 0; p < cells_.size(); ++p)
      if (belongs(cells_.body(p)))
        {
          domains.push_back(domain(p));
          ids.push_back(cells_.id(p));
        }
    Occupancy<dim> occupancy(GridWindow<dim>(grid_, reached(domains, belongs)),
                             parameters.points_per_cell,
                             share_points,
                             parting);
    for (std::size_t i = 0; i < domains.size(); ++i)
      occupancy.add_particle(domains[i], ids[i]);
    const bool has_parts = parting != nullptr && !parting->is_trivial();
    for (unsigned int p = 0; p < boundary_points_.size(); ++p)
      if (belongs(boundary_points_.body(p)))
        occupancy.add_boundary_point(boundary_points_.position(p),
                                     has_parts ? boundary_points_.part(p) : 0);
    occupancy.sum(grid_);
    for (std::size_t i = 0; i < domains.size(); ++i)
      occupancy.add_quadrature_points(domains[i], ids[i]);
    occupancy.sum_quadrature_points(grid_);
    return SplineSpace<dim>(grid_, std::move(occupancy), parameters);
  }

  /** The grid cells that this rank's points reach with their domains, and
   *  others near them. */
  template <int dim>
  template <typename Belongs>
  std::vector<GridRange<dim>>
  Tissue<dim>::reached(const std::vector<ParticleDomain<dim>> &domains,
                       const Belongs                          &belongs) const
  {
    double farthest = 0.; // from a cell's position, along a coordinate
    for (const ParticleDomain<dim> &domain : domains)
      {
        const auto [lower, upper] = domain.bounds();
        for (unsigned int d = 0; d < dim; ++d)
          farthest = std::max(farthest, upper[d] - domain.position()[d]);
      }
    // One distance for all cells of the rank: a few grid cells more in the
    // window cost less than bounds of each cell would.
    const GridBox<dim> &box = grid_.box();
    const int rings = static_cast<int>(std::ceil(farthest / box.spacing()));
    std::vector<GridRange<dim>> ranges;
    const auto add = [&](const unsigned int number, const int rings) {
      const GridIndex<dim> index = box.index(number);
      ranges.push_back(GridRange<dim>{index, index}.grown(rings, box));
    };
    for (const auto &grid_cell : cells_.grid_cells())
      if (belongs(cells_.body(grid_cell.begin)))
        add(grid_cell.number, rings);
    for (const auto &grid_cell : boundary_points_.grid_cells())
      if (belongs(boundary_points_.body(grid_cell.begin)))
        add(grid_cell.number, 0);
    return ranges;
  }

  template <int dim>
  unsigned int
  n_bodies(const Tissue<dim> &tissue)
  {
    unsigned int n = 0;
    for (const unsigned int body : tissue.cells().bodies())
      n = std::max(n, body + 1);
    for (const unsigned int body : tissue.boundary_points().bodies())
      n = std::max(n, body + 1);
    return Utilities::MPI::max(n, tissue.communicator());
  }

  MORULA_INSTANTIATE(n_bodies);
  template class Tissue<2>;
  template class Tissue<3>;


  namespace
  {
    /** Patches that overlap more than this, in units of h, are the sides of a
     *  sheet and not two surfaces that have met: as deep as pairs of points act
     *  on each other, doc/theory.md (4.8k). */
    constexpr double deepest_overlap = 0.4;

    /** All records of all ranks, by id. Collective. */
    template <typename Record>
    std::vector<Record>
    of_all_by_id(const std::vector<Record> &own, const MPI_Comm comm)
    {
      std::vector<Record> all = in_one(gather_everywhere(own, comm));
      std::sort(all.begin(), all.end(), [](const Record &a, const Record &b) {
        return a.id < b.id;
      });
      return all;
    }

    /** The box of the cell, with its edges however many points it has. */
    template <int dim>
    PartedCell<dim>
    parted_cell(const Cells<dim> &cells, const unsigned int p)
    {
      const ParticleDomain<dim> box =
        cell_domain<dim>(cells.position(p), cells[p]);
      const auto [lower, upper] = box.bounds();
      return {cells.id(p),
              cells.body(p),
              cells.position(p),
              invert(box.edge_vectors()),
              lower,
              upper};
    }
  } // namespace


  template <int dim>
  Parting<dim>
  find_parting(const Tissue<dim> &tissue)
  {
    // Every rank gets the whole surface, and finds the same contested grid
    // cells. Then all ranks get the cells that reach into the surroundings of
    // these, and part them alike: the parts of a grid cell must have the same
    // numbers wherever they are known, and a window reaches far. What travels
    // is in proportion to the surface, and to the part of the tissue that
    // touches.
    const MPI_Comm                comm   = tissue.communicator();
    const GridBox<dim>           &box    = tissue.grid().box();
    const BoundaryPoints<dim>    &points = tissue.boundary_points();
    std::vector<PartedPatch<dim>> own;
    for (unsigned int p = 0; p < points.size(); ++p)
      own.push_back({points.id(p),
                     points.body(p),
                     points.position(p),
                     points.area_vector(p) / points.area_vector(p).norm(),
                     points[p].spacing()});
    std::vector<PartedPatch<dim>>   patches = of_all_by_id(own, comm);
    const std::vector<unsigned int> contested =
      contested_grid_cells(box, patches, deepest_overlap * box.spacing());
    if (contested.empty())
      return {};

    // By grid cell: 2 where a domain may be cut, 1 where patches may cut bonds.
    std::vector<char> near(box.size(), 0);
    for (const int rings : {3, 1})
      for (const unsigned int number : contested)
        box.for_neighbors(box.index(number),
                          rings,
                          [&](const unsigned int neighbor, const auto &) {
                            near[neighbor] = rings == 1 ? 2 : 1;
                          });
    patches.erase(
      std::remove_if(patches.begin(),
                     patches.end(),
                     [&](const PartedPatch<dim> &patch) {
                       return near[box.number(box.locate(patch.x))] == 0;
                     }),
      patches.end());
    std::vector<PartedCell<dim>> cells;
    for (const auto &grid_cell : tissue.cells().grid_cells())
      for (unsigned int p = grid_cell.begin; p < grid_cell.end; ++p)
        {
          const PartedCell<dim> cell    = parted_cell(tissue.cells(), p);
          bool                  reaches = false;
          box.for_overlap(box.locate(cell.lower),
                          box.locate(cell.upper),
                          [&](const unsigned int number, const auto &) {
                            reaches = reaches || near[number] == 2;
                          });
          if (reaches)
            cells.push_back(cell);
        }
    return Parting<dim>(box, contested, of_all_by_id(cells, comm), patches);
  }


  MORULA_INSTANTIATE(find_parting);
} // namespace Morula
