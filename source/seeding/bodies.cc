// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/near_tree.h>
#include <morula/seeding/bodies.h>

#include <boost/pending/disjoint_sets.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace Morula
{
  double
  sum_of_all_ranks(const std::vector<double> &mine, const MPI_Comm comm)
  {
    return Utilities::MPI::sum(std::accumulate(mine.begin(), mine.end(), 0.),
                               comm);
  }


  template <int dim>
  double
  longest_length(const Founders<dim> &founders, const MPI_Comm comm)
  {
    double largest = 0.;
    for (const double V : founders.volumes)
      largest = std::max(largest, V);
    return std::pow(Utilities::MPI::max(largest, comm), 1. / dim);
  }


  template <int dim>
  std::vector<unsigned int>
  bodies_apart(const Founders<dim> &founders,
               const MPI_Comm       comm,
               const double         widest)
  {
    // Every rank gets all founders, which takes far less memory than its cells
    // do later, and finds the same bodies: a tree gives the neighbours of each
    // founder, Boost's disjoint sets join them. A set gets its number when its
    // first founder comes along.
    const std::vector<Point<dim>> positions =
      of_all_ranks(founders.positions, comm);
    const std::vector<double> volumes = of_all_ranks(founders.volumes, comm);
    std::vector<double>       lengths;
    for (const double volume : volumes)
      lengths.push_back(std::pow(volume, 1. / dim));
    const double        longest = longest_length(founders, comm);
    const NearTree<dim> tree(positions);
    boost::disjoint_sets_with_storage<> sets(positions.size());
    for (unsigned int i = 0; i < positions.size(); ++i)
      for (const unsigned int j :
           tree.within(positions[i], 0.5 * widest * (lengths[i] + longest)))
        if (positions[i].distance(positions[j]) <=
            0.5 * widest * (lengths[i] + lengths[j]))
          sets.union_set(i, j);
    const unsigned int        no_body = numbers::invalid_unsigned_int;
    std::vector<unsigned int> body_of_set(positions.size(), no_body), mine;
    unsigned int              n_bodies = 0;
    for (unsigned int i = 0; i < positions.size(); ++i)
      {
        unsigned int &body = body_of_set[sets.find_set(i)];
        if (body == no_body)
          body = n_bodies++;
        if (i >= founders.first_id &&
            i < founders.first_id + founders.positions.size())
          mine.push_back(body);
      }
    return mine;
  }


  template <int dim>
  void
  tell_bodies_apart(Tissue<dim> &tissue, PointList<dim> &former)
  {
    // bodies_apart() numbers bodies in the order of ranks. Their lowest ids
    // give them an order of their own, which any number of ranks has.
    const MPI_Comm    comm  = tissue.communicator();
    const Cells<dim> &cells = tissue.cells();
    Founders<dim>     left;
    left.positions = cells.positions();
    for (unsigned int p = 0; p < cells.size(); ++p)
      left.volumes.push_back(cells.volume(p));
    const auto sizes = Utilities::MPI::all_gather(comm, left.volumes.size());
    left.first_id =
      std::accumulate(sizes.begin(),
                      sizes.begin() + Utilities::MPI::this_mpi_process(comm),
                      0ul);
    left.bodies = bodies_apart(left, comm);
    std::vector<double> lowest(number_of_bodies(left, comm),
                               std::numeric_limits<double>::max());
    for (unsigned int p = 0; p < cells.size(); ++p)
      {
        double &least = lowest[left.bodies[p]];
        least         = std::min<double>(least, cells.id(p));
      }
    Utilities::MPI::min(lowest, comm, lowest);
    for (unsigned int p = 0; p < cells.size(); ++p)
      {
        left.bodies[p] =
          std::count_if(lowest.begin(), lowest.end(), [&](const double id) {
            return id < lowest[left.bodies[p]];
          });
        tissue.cell(p).set(cells.columns().body, left.bodies[p]);
      }
    const std::vector<Point<dim>> positions =
      of_all_ranks(left.positions, comm);
    const NearTree<dim>             tree(positions);
    const std::vector<unsigned int> bodies = of_all_ranks(left.bodies, comm);
    const auto &body = tissue.boundary_points().columns().body;
    for (std::size_t i = 0; i < former.size() && !bodies.empty(); ++i)
      body.set(former.row(i), bodies[tree.nearest(former.positions[i])]);
  }


  template <int dim>
  std::vector<unsigned int>
  bodies_of_patches(const SurfacePatches<dim> &patches,
                    const Founders<dim>       &founders,
                    const MPI_Comm             comm)
  {
    // The nearest founder may stand on the other side of a narrow gap, but not
    // behind the patch. A patch without any behind it takes the nearest of all.
    const std::vector<Point<dim>> positions =
      of_all_ranks(founders.positions, comm);
    const std::vector<unsigned int> bodies =
      of_all_ranks(founders.bodies, comm);
    const NearTree<dim>       tree(positions);
    std::vector<unsigned int> list;
    for (std::size_t k = 0; k < patches.positions.size(); ++k)
      {
        const Point<dim> &x      = patches.positions[k];
        const auto        behind = tree.nearest(x, [&](const unsigned int i) {
          return (positions[i] - x) * patches.normals[k] < 0.;
        });
        list.push_back(bodies[behind ? *behind : tree.nearest(x)]);
      }
    return list;
  }


  template <int dim>
  unsigned int
  number_of_bodies(const Founders<dim> &founders, const MPI_Comm comm)
  {
    unsigned int n = 0;
    for (const unsigned int body : founders.bodies)
      n = std::max(n, body + 1);
    return Utilities::MPI::max(n, comm);
  }


  namespace
  {
    /** Moves the patches of a body outwards by one distance, as far as each has
     *  room (µm), so that its surface encloses a volume (µm^dim). */
    template <int dim>
    void
    enclose(const unsigned int         body,
            const double               volume,
            const std::vector<double> &room,
            SurfacePatches<dim>       &patches)
    {
      // Patches keep their areas. So a way along the normals counts by 1/dim of
      // the area, as the flux of x does. Each round shares out what those
      // without more room have left to the others. It is no longer than two
      // patches: a body with little free surface would burst there.
      const auto [begin, end] =
        std::equal_range(patches.bodies.begin(), patches.bodies.end(), body);
      const std::size_t first = begin - patches.bodies.begin(),
                        last  = end - patches.bodies.begin();
      double way              = 0.;
      for (unsigned int round = 0; round < 10; ++round)
        {
          double       missing = volume, area = 0.;
          unsigned int n = 0;
          for (std::size_t b = first; b < last; ++b)
            {
              const double a = patches.areas[b];
              missing -= ((patches.positions[b] - patches.positions[first]) *
                            patches.normals[b] +
                          std::min(way, room[b])) *
                         a / dim;
              area += room[b] > way ? a : 0.;
              n += room[b] > way;
            }
          if (n == 0)
            break;
          way = std::clamp(way + dim * missing / area,
                           0.,
                           2. * std::pow(area / n, 1. / (dim - 1)));
        }
      for (std::size_t b = first; b < last; ++b)
        patches.positions[b] += std::min(way, room[b]) * patches.normals[b];
    }
  } // namespace


  template <int dim>
  void
  part_bodies(const std::vector<double> &volumes, SurfacePatches<dim> &patches)
  {
    // Each pass measures all gaps and moves all patches then, so that the order
    // of the patches does not matter. Halves of the overlaps of both sides add
    // up to all of it; curved and uneven surfaces take some passes more. A tiny
    // patch looks as far as the others.
    constexpr unsigned int most_passes = 10;
    const std::size_t      n           = patches.positions.size();
    const double           mean =
      std::accumulate(patches.areas.begin(), patches.areas.end(), 0.) / n;
    std::vector<double> room(n); // half of the mean gap, µm
    bool                any = true;
    for (unsigned int pass = 0; pass < most_passes && any; ++pass)
      {
        const NearTree<dim> tree(patches.positions);
        any = false;
        for (std::size_t b = 0; b < n; ++b)
          {
            const Point<dim>     &x      = patches.positions[b];
            const Tensor<1, dim> &normal = patches.normals[b];
            const double          l =
              std::pow(std::max(mean, patches.areas[b]), 1. / (dim - 1));
            const double reach = 2. * l;
            double       sum = 0., weights = 0.;
            for (const unsigned int c : tree.within(x, reach))
              {
                if (patches.bodies[c] == patches.bodies[b] ||
                    patches.normals[c] * normal >= 0.)
                  continue;
                const Tensor<1, dim> way = x - patches.positions[c];
                const double gap = 0.5 * (patches.normals[c] - normal) * way;
                const double along =
                  way.norm_square() - (way * normal) * (way * normal);
                const double weight =
                  patches.areas[c] * std::max(0., 1. - along / (reach * reach));
                sum += weight * gap;
                weights += weight;
              }
            room[b] = weights > 0. ? 0.5 * sum / weights :
                                     std::numeric_limits<double>::max();
            any     = any || room[b] < -1e-6 * l;
          }
        for (std::size_t b = 0; b < n; ++b)
          if (room[b] < 0.)
            patches.positions[b] += room[b] * patches.normals[b];
      }
    for (double &way : room)
      way = std::max(0., way);
    for (unsigned int body = 0; body < volumes.size(); ++body)
      enclose(body, volumes[body], room, patches);
  }


  template <int dim>
  std::vector<BodyMeasures>
  measures_of_bodies(const Founders<dim>       &founders,
                     const SurfacePatches<dim> &patches,
                     const MPI_Comm             comm)
  {
    const unsigned int n = number_of_bodies(founders, comm);
    // By body: cells, volume, area, and the components of Σ a n.
    constexpr unsigned int m = 3 + dim;
    std::vector<double>    sums(m * n, 0.);
    for (std::size_t i = 0; i < founders.bodies.size(); ++i)
      {
        sums[m * founders.bodies[i]] += 1.;
        sums[m * founders.bodies[i] + 1] += founders.volumes[i];
      }
    for (std::size_t k = 0; k < patches.bodies.size(); ++k)
      {
        double *const sum = &sums[m * patches.bodies[k]];
        sum[2] += patches.areas[k];
        for (unsigned int d = 0; d < dim; ++d)
          sum[3 + d] += patches.areas[k] * patches.normals[k][d];
      }
    Utilities::MPI::sum(sums, comm, sums);
    std::vector<BodyMeasures> bodies;
    for (unsigned int b = 0; b < n; ++b)
      {
        Tensor<1, dim> opening;
        for (unsigned int d = 0; d < dim; ++d)
          opening[d] = sums[m * b + 3 + d];
        bodies.push_back(
          {sums[m * b], sums[m * b + 1], sums[m * b + 2], opening.norm()});
      }
    return bodies;
  }


  MORULA_INSTANTIATE(longest_length);
  MORULA_INSTANTIATE(number_of_bodies);
  MORULA_INSTANTIATE(part_bodies);
  MORULA_INSTANTIATE(measures_of_bodies);
  MORULA_INSTANTIATE(bodies_apart);
  MORULA_INSTANTIATE(tell_bodies_apart);
  MORULA_INSTANTIATE(bodies_of_patches);
} // namespace Morula
