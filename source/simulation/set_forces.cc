// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/near_tree.h>
#include <morula/particles/nearest.h>
#include <morula/particles/point_exchange.h>
#include <morula/simulation/step_equilibrium.h>

#include <deal.II/base/mpi.h>

#include <cmath>
#include <tuple>

namespace Morula
{
  namespace
  {
    /** The cosine of the angle between normals of points of one face: more than
     *  this. */
    constexpr double one_face = 0.5;

    /** What nothing touches. */
    constexpr unsigned int nobody = numbers::invalid_unsigned_int;

    /** What a point tells: the normal force on it, a body that touches it or
     *  nobody, its body, its area vector. */
    template <int dim>
    using Patch =
      std::tuple<double, unsigned int, unsigned int, Tensor<1, dim>>;

    /** For each pressed point the pressed points of its face within the radius
     *  (µm), with itself; nothing for others. */
    template <int dim>
    std::vector<std::vector<unsigned int>>
    pressed_around(const PointList<dim>          &points,
                   const std::vector<Patch<dim>> &patches,
                   const double                   radius)
    {
      // Every point within the radius of one that is touched is reached. Of
      // these the ones around which all are reached are pressed: holes narrower
      // than twice the radius close, and the outer edge stays where it is.
      const NearTree<dim>                    tree(points.positions);
      std::vector<std::vector<unsigned int>> around(points.size());
      std::vector<bool> reached(points.size()), pressed(points.size());
      const auto        find =
        [&](const std::size_t i) -> const std::vector<unsigned int> & {
        const auto &[normal, other, body, area] = patches[i];
        if (around[i].empty())
          for (const unsigned int j : tree.within(points.positions[i], radius))
            if (const auto &there = std::get<3>(patches[j]);
                std::get<2>(patches[j]) == body &&
                there * area > one_face * there.norm() * area.norm())
              around[i].push_back(j);
        return around[i];
      };
      for (std::size_t i = 0; i < points.size(); ++i)
        if (std::get<1>(patches[i]) != nobody)
          for (const unsigned int j : find(i))
            reached[j] = true;
      for (std::size_t i = 0; i < points.size(); ++i)
        if (reached[i])
          {
            const auto &list = find(i);
            pressed[i]       = std::all_of(list.begin(),
                                     list.end(),
                                     [&](const auto j) { return reached[j]; });
          }
      for (std::size_t i = 0; i < points.size(); ++i)
        around[i].erase(std::remove_if(around[i].begin(),
                                       around[i].end(),
                                       [&](const auto j) {
                                         return !pressed[i] || !pressed[j];
                                       }),
                        around[i].end());
      return around;
    }


    /** Gives the points the pressure of what touches them, doc/theory.md
     * (4.8n), and its points and area to the rows of bodies that touch.
     * Collective. */
    template <int dim>
    void
    set_pressure(const SurfaceForces<dim> &forces,
                 Tissue<dim>              &tissue,
                 std::vector<ForceRow>    &rows)
    {
      // Points have their new areas, but stand where they were at t. All that
      // decides about a point is at most two grid spacings away. A point counts
      // to what touches the nearest one that is touched; a row has the points
      // of its second body.
      const BoundaryPoints<dim> &store = tissue.boundary_points();
      const double               h     = tissue.grid().box().spacing();
      std::vector<double>        normal(store.size(), 0.);
      std::vector<unsigned int>  other(store.size(), nobody);
      for (const ForceBetween<dim> &one : forces.between)
        {
          normal[one.p] += one.normal;
          other[one.p] = one.other;
        }
      const auto append = [&](const unsigned int p, std::vector<double> &list) {
        append_flat(
          list,
          Patch<dim>(normal[p], other[p], store.body(p), store.area_vector(p)));
      };
      const PointList<dim> near =
        by_id(near_points(store.positions(),
                          store,
                          {Flat<Patch<dim>>::n, append, Ties::lowest_id},
                          tissue.grid(),
                          2));
      std::vector<Patch<dim>> patches;
      std::vector<double>     a, sums_of_a, sums(2 * rows.size(), 0.);
      for (std::size_t i = 0; i < near.size(); ++i)
        {
          patches.push_back(near.template value<Patch<dim>>(i));
          a.push_back(std::get<3>(patches.back()).norm());
        }
      const auto around = pressed_around(near, patches, 0.5 * h);
      for (const auto &list : around)
        {
          sums_of_a.push_back(0.);
          for (const unsigned int j : list)
            sums_of_a.back() += a[j];
        }
      for (unsigned int p = 0; p < store.size(); ++p)
        {
          const std::size_t i =
            std::lower_bound(near.ids.begin(), near.ids.end(), store.id(p)) -
            near.ids.begin();
          const double f        = normal[p] / a[i];
          double       pressure = f, nearest = h;
          unsigned int by = nobody;
          for (const unsigned int j : around[i])
            {
              const auto  &patch = patches[j];
              const double distance =
                near.positions[i].distance(near.positions[j]);
              pressure += a[j] / std::max(sums_of_a[i], sums_of_a[j]) *
                          (std::get<0>(patch) / a[j] - f);
              if (std::get<1>(patch) != nobody && distance < nearest)
                {
                  nearest = distance;
                  by      = std::get<1>(patch);
                }
            }
          if (around[i].empty())
            continue;
          tissue.boundary_point(p).set(store.columns().contact_pressure,
                                       pressure);
          if (const auto row = forces.touching.find({by, store.body(p)});
              row != forces.touching.end())
            {
              sums[2 * row->second] += 1.;
              sums[2 * row->second + 1] += a[i];
            }
        }
      Utilities::MPI::sum(sums, tissue.communicator(), sums);
      for (const auto &[bodies, row] : forces.touching)
        {
          rows[row].points = std::llround(sums[2 * row]);
          rows[row].area   = sums[2 * row + 1];
        }
    }
  } // namespace


  template <int dim>
  std::vector<ForceRow>
  set_forces(const SurfaceForces<dim> &forces, Tissue<dim> &tissue)
  {
    std::vector<ForceRow> rows    = forces.rows;
    const auto           &columns = tissue.boundary_points().columns();
    for (unsigned int p = 0; p < tissue.boundary_points().size(); ++p)
      {
        const BoundaryView<dim, double> point = tissue.boundary_point(p);
        if (columns.force.exists())
          point.set(columns.force, forces.of_points[p]);
        if (columns.contact_pressure.exists())
          point.set(columns.contact_pressure, 0.);
      }
    if (!forces.touching.empty())
      set_pressure(forces, tissue, rows);
    return rows;
  }


  MORULA_INSTANTIATE(set_forces);
} // namespace Morula
