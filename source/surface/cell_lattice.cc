// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/rounded_sums.h>
#include <morula/base/send_records.h>
#include <morula/particles/point_exchange.h>
#include <morula/surface/cell_lattice.h>

#include <deal.II/base/numbers.h>

#include <boost/math/special_functions/erf.hpp>
#include <boost/pending/disjoint_sets.hpp>

#include <limits>

namespace Morula
{
  namespace
  {
    /** exp(-x^2/(2 s^2)) at x = first, first + 1, ..., @p n values. */
    void
    set_gaussian(const double         first,
                 const unsigned int   n,
                 const double         s,
                 std::vector<double> &values)
    {
      // From one to the next the value changes by a factor that itself changes
      // by a constant one.
      values.resize(n);
      const double u = first / s, d = 1. / s;
      const double change = std::exp(-d * d);
      double       value  = std::exp(-0.5 * u * u);
      double       ratio  = std::exp(-d * (u + 0.5 * d));
      for (double &v : values)
        {
          v = value;
          value *= ratio;
          ratio *= change;
        }
    }

    /** Adds cells to the filling. */
    template <int dim>
    void
    fill(const PointList<dim> &cells, CellLattice<dim> &lattice)
    {
      // What is added to this number and subtracted again is rounded to a
      // multiple of 2^-40. Sums of such multiples are exact up to 2^13, so that
      // they do not depend on the order of the cells.
      constexpr double    rounding = 6144.;
      const GridBox<dim> &nodes    = lattice.nodes;
      const double        e = nodes.spacing(), s = lattice.width / e;
      const double        scale =
        std::pow(2. * numbers::PI * lattice.width * lattice.width, -0.5 * dim);
      const Point<dim>                     origin = nodes.corner({});
      std::array<std::vector<double>, dim> along;
      for (std::size_t i = 0; i < cells.size(); ++i)
        {
          GridIndex<dim> first, last;
          for (unsigned int d = 0; d < dim; ++d)
            {
              const double x = (cells.positions[i][d] - origin[d]) / e;
              first[d]       = std::ceil(x - lattice.reach * s);
              last[d]        = std::floor(x + lattice.reach * s);
              set_gaussian(first[d] - x, last[d] - first[d] + 1, s, along[d]);
            }
          // Rows of nodes along x.
          const double weight = scale * cells.numbers[i];
          const int    begin  = std::max(first[0], nodes.first()[0]);
          const int    end =
            std::min(last[0] + 1, nodes.first()[0] + nodes.n()[0]);
          GridIndex<dim> lower = first;
          lower[0] = last[0] = begin;
          if (begin < end)
            nodes.for_overlap(lower,
                              last,
                              [&](const unsigned int row, const auto &index) {
                                double p = weight;
                                for (unsigned int d = 1; d < dim; ++d)
                                  p *= along[d][index[d] - first[d]];
                                const double *value =
                                  &along[0][begin - first[0]];
                                for (int k = 0; k < end - begin; ++k)
                                  lattice.distance[row + k] +=
                                    (p * value[k] + rounding) - rounding;
                              });
        }
    }

    /** The signed distance from the surface of a half-space where its smoothed
     *  filling has this value. */
    double
    distance_of(const double filling, const double width)
    {
      using namespace boost::math::policies;
      constexpr double    least = CellLattice<2>::least;
      static const double most  = -std::erf(least * numbers::SQRT1_2);
      const double        t     = 2. * filling - 1.;
      if (std::abs(t) < most)
        return width * numbers::SQRT2 *
               boost::math::erf_inv(t, policy<promote_double<false>>());
      return t > 0. ? -least * width : least * width;
    }

    /** The rank of a place: beyond the grid's box, where the smoothing may
     *  reach, the next grid cell in it decides. */
    template <int dim>
    unsigned int
    owner(const Point<dim> &x, const BackgroundGrid<dim> &grid)
    {
      const GridBox<dim> &box   = grid.box();
      GridIndex<dim>      index = box.locate(x);
      for (unsigned int d = 0; d < dim; ++d)
        index[d] =
          std::max(box.first()[d],
                   std::min(index[d], box.first()[d] + box.n()[d] - 1));
      return grid.owner(index);
    }

    /** The blocks around all ranks' cells. Collective. @param blocks any of
     *  them @param rings of blocks beyond the outer cells */
    template <int dim>
    GridBox<dim>
    box_around_all(const PointList<dim> &cells,
                   const GridBox<dim>   &blocks,
                   const int             rings,
                   const MPI_Comm        comm)
    {
      std::vector<int> ends(2 * dim, std::numeric_limits<int>::lowest());
      for (const Point<dim> &x : cells.positions)
        for (unsigned int d = 0; d < dim; ++d)
          {
            const int i   = blocks.locate(x)[d];
            ends[d]       = std::max(ends[d], -i);
            ends[dim + d] = std::max(ends[dim + d], i);
          }
      Utilities::MPI::max(ends, comm, ends);
      GridIndex<dim> first, n;
      for (unsigned int d = 0; d < dim; ++d)
        {
          first[d] = -ends[d] - rings;
          n[d]     = ends[dim + d] + rings + 1 - first[d];
        }
      return {first, n, blocks.spacing(), blocks.corner({})};
    }
    /** Finds this rank's blocks, and makes the box of their nodes. */
    template <int dim>
    void
    find_own(const BackgroundGrid<dim> &grid, CellLattice<dim> &lattice)
    {
      const GridBox<dim> &blocks = lattice.blocks;
      const unsigned int  rank = Utilities::MPI::this_mpi_process(lattice.comm);
      GridIndex<dim>      first, n;
      first.fill(std::numeric_limits<int>::max());
      n.fill(0);
      for (unsigned int block = 0; block < blocks.size(); ++block)
        if (const GridIndex<dim> index = blocks.index(block);
            owner(blocks.center(index), grid) == rank)
          {
            lattice.own.push_back(block);
            for (unsigned int d = 0; d < dim; ++d)
              {
                const int i = 3 * (index[d] - blocks.first()[d]);
                first[d]    = std::min(first[d], i);
                n[d]        = std::max(n[d], i + 4);
              }
          }
      for (unsigned int d = 0; d < dim && !lattice.own.empty(); ++d)
        n[d] -= first[d];
      lattice.nodes = GridBox<dim>(first,
                                   n,
                                   blocks.spacing() / 3.,
                                   blocks.corner(blocks.first()));
      for (unsigned int c = 0; c < lattice.corners.size(); ++c)
        lattice.corners[c] =
          (c & 1) + (c >> 1 & 1) * n[0] + (c >> 2) * n[0] * n[1];
    }

    using Sets = boost::disjoint_sets_with_storage<>;

    constexpr unsigned int nowhere = std::numeric_limits<unsigned int>::max();

    /** A node that blocks of other ranks may have, too: its key and its part.
     */
    using SharedNode = std::array<std::uint64_t, 2>;

    /** Finds the parts of this rank alone, in any order.
     *  @return its shared nodes */
    template <int dim>
    std::vector<SharedNode>
    find_own_parts(const double level, CellLattice<dim> &lattice)
    {
      // Edges go from a node to the other corners of the lattice cell of which
      // it is the lowest one; there it counts, too. A node that others may have
      // is at the corner of fewer own cells than others.
      Sets                      sets(lattice.distance.size());
      std::vector<unsigned int> n_around(lattice.distance.size(), 0);
      const auto                is_inside = [&](const unsigned int node) {
        return lattice.distance[node] > level;
      };
      lattice.for_cells([&](const unsigned int lowest, const auto &) {
        for (const unsigned int corner : lattice.corners)
          {
            ++n_around[lowest + corner];
            if (is_inside(lowest + corner) == is_inside(lowest))
              sets.union_set(lowest, lowest + corner);
          }
      });
      std::vector<SharedNode> shared;
      lattice.parts.clear();
      lattice.part_of.assign(n_around.size(), nowhere);
      for (unsigned int node = 0; node < n_around.size(); ++node)
        if (n_around[node] > 0)
          {
            unsigned int &part = lattice.part_of[sets.find_set(node)];
            if (part == nowhere)
              {
                part = lattice.parts.size();
                lattice.parts.push_back(
                  {is_inside(node), std::numeric_limits<std::uint64_t>::max()});
              }
            lattice.part_of[node] = part;
            if (n_around[node] < lattice.corners.size())
              shared.push_back(
                {{lattice.key(lattice.nodes.index(node)), part}});
          }
      lattice.for_cells([&](const unsigned int lowest, const auto &index) {
        LatticePart &part = lattice.parts[lattice.part_of[lowest]];
        part.first        = std::min(part.first, lattice.key(index));
      });
      return shared;
    }
  } // namespace

  template <int dim>
  CellLattice<dim>::CellLattice(const PointList<dim>      &cells,
                                const BackgroundGrid<dim> &grid)
    : comm(grid.communicator())
  {
    // The volume gives the spacing and the width, and with the reach of the
    // cells the blocks; this rank then fills the nodes of its own ones. Volumes
    // are rounded to a part of the largest one, so that their sum does not
    // depend on the order.
    double largest = 0.;
    for (const double V : cells.numbers)
      largest = std::max(largest, V);
    int exponent = 0;
    std::frexp(Utilities::MPI::max(largest, comm), &exponent);
    RoundedSums sums(2, comm);
    for (const double V : cells.numbers)
      {
        sums.add(0, std::ldexp(V, 4 - exponent));
        sums.add(1, 1.);
      }
    const auto all = sums.all();
    volume         = std::ldexp(all[0], exponent - 4);
    n_cells        = all[1];
    if (n_cells == 0.)
      return;

    // The lattice and the smoothing are finer around a body that is smaller
    // than a grid cell.
    const double h = grid.box().spacing(), size = std::pow(volume, 1. / dim);
    const int    n_parts = std::max(1., std::ceil(h / size));
    width                = 0.6 * std::max(size / std::pow(n_cells, 1. / dim),
                           std::min(h / 2., size / 3.));
    blocks = GridBox<dim>({}, {}, h / n_parts, grid.box().corner({}));
    blocks =
      box_around_all(cells,
                     blocks,
                     2 + static_cast<int>(reach * width / blocks.spacing()),
                     comm);
    find_own(grid, *this);

    distance.assign(nodes.size(), 0.);
    fill(cells, *this);
    fill(halo(cells, grid, reach * width + 1e-6 * h), *this);
    for (double &value : distance)
      value = distance_of(value, width);
  }

  template <int dim>
  void
  CellLattice<dim>::find_parts(const double level)
  {
    // Each rank finds the parts of its own nodes. All ranks then unite alike
    // those that have a node in common.
    std::vector<SharedNode>   shared = find_own_parts(level, *this);
    std::vector<LatticePart>  all;
    std::vector<unsigned int> before; // parts of lower ranks
    for (const auto &list : gather_everywhere(parts, comm))
      {
        before.push_back(all.size());
        all.insert(all.end(), list.begin(), list.end());
      }
    const unsigned int here = before[Utilities::MPI::this_mpi_process(comm)];
    for (SharedNode &node : shared)
      node[1] += here;
    Sets                                   sets(all.size());
    std::map<std::uint64_t, std::uint64_t> part_at;
    if (before.size() > 1)
      for (const auto &list : gather_everywhere(shared, comm))
        for (const auto &[key, part] : list)
          sets.union_set(part, part_at.emplace(key, part).first->second);

    std::map<std::uint64_t, unsigned int> roots; // by the first node
    for (unsigned int i = 0; i < all.size(); ++i)
      if (LatticePart &root = all[sets.find_set(i)]; &root != &all[i])
        root.first = std::min(root.first, all[i].first);
    for (unsigned int i = 0; i < all.size(); ++i)
      if (sets.find_set(i) == i)
        roots[all[i].first] = i;
    std::vector<unsigned int> numbers(all.size());
    parts.clear();
    for (const auto &[first, root] : roots)
      {
        numbers[root] = parts.size();
        parts.push_back(all[root]);
      }
    for (unsigned int &part : part_of)
      part = part == nowhere ? 0 : numbers[sets.find_set(here + part)];
  }

  template struct CellLattice<2>;
  template struct CellLattice<3>;
} // namespace Morula
