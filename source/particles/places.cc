// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/grid/grid_box.h>
#include <morula/particles/places.h>
#include <morula/particles/point_exchange.h>

#include <deal.II/base/mpi.h>

#include <cstdint>
#include <tuple>

namespace Morula
{
  namespace
  {
    /** c: the distance that cells keep, in their mean length. Lattices have
     *  their neighbours farther off. */
    constexpr double distance_part = 0.95;

    /** The part of an overlap that goes in a pass, and the farthest way then,
     *  in lengths of the cell. */
    constexpr double pass_part = 0.5, longest_way = 0.25;

    /** Passes in a unit of strain, and the most in a step. */
    constexpr double passes_per_strain = 30.;
    constexpr int    most_passes       = 3;

    /** How far pairs are sought once a step, in their mean length: with room
     *  for the way that they go. */
    constexpr double pair_reach = 1.2 * distance_part;

    /** Nearer than this, in lengths of a cell, is a close neighbour. */
    constexpr double close_part = 0.4;

    /** The depth below the surface, in lengths of the cell, above which a cell
     *  is not moved towards it. */
    constexpr double least_depth = 0.25;

    /** What a cell tells others: volume, share, body, metric M. */
    template <int dim>
    using Grain = std::tuple<double, double, unsigned int, Tensor<2, dim>>;

    /** Outward normal, spacing and body of a patch. */
    template <int dim>
    using Patch = std::tuple<Tensor<1, dim>, double, unsigned int>;

    /** Cells of this rank and those around it, the pairs of them that may push
     *  each other, and the patches that are in their way. */
    template <int dim>
    class CrowdedCells
    {
    public:
      /** Collective. */
      explicit CrowdedCells(const Tissue<dim> &tissue);

      /** Moves the cells of this rank once. Collective. */
      void
      move();

      /** How many cells of this rank have a close neighbour. */
      std::uint64_t
      n_close() const
      {
        std::vector<bool> is_close(cells.size(), false);
        for (const auto &[p, q] : pairs)
          for (const unsigned int one : {p, q})
            if (x[p].distance(x[q]) < close_part * l[one])
              is_close[one] = true;
        return std::count(is_close.begin(), is_close.begin() + n_own, true);
      }

      unsigned int            n_passes = 0;
      std::vector<Point<dim>> x; // own cells, then others, µm

    private:
      void
      find_pairs();
      Tensor<1, dim>
      inside_part(Tensor<1, dim> way, const unsigned int p) const;

      const Tissue<dim>      &tissue;
      const std::size_t       n_own;
      double                  width = 0.; // of the largest cell, µm
      PointList<dim>          patches;
      std::vector<Grain<dim>> cells;                  // as x
      std::vector<double>     l;                      // likewise, µm
      std::vector<std::array<unsigned int, 2>> pairs; // the first one is own
      std::vector<std::vector<unsigned int>>   near_patches; // by own cell
    };


    template <int dim>
    CrowdedCells<dim>::CrowdedCells(const Tissue<dim> &tissue)
      : tissue(tissue)
      , n_own(tissue.cells().size())
      , patches(Flat<Patch<dim>>::n)
    {
      // The largest strain of all ranks says how many passes there are, and so
      // the share of each cell. The largest cell and patch say how far others
      // can matter.
      const Cells<dim>          &own    = tissue.cells();
      const BoundaryPoints<dim> &points = tissue.boundary_points();
      const MPI_Comm             comm   = tissue.communicator();
      double                     most = 0., spacing = 0.;
      const auto                 strain_of = [&own](const unsigned int p) {
        return passes_per_strain * own.get(own.columns().step_strain, p);
      };
      for (unsigned int p = 0; p < n_own; ++p)
        {
          most  = std::max(most, strain_of(p));
          width = std::max(width, own.volume(p));
        }
      for (unsigned int b = 0; b < points.size(); ++b)
        {
          const Tensor<1, dim> area = points.area_vector(b);
          spacing                   = std::max(spacing, points[b].spacing());
          patches.add_value(points.id(b),
                            points.position(b),
                            Patch<dim>(area / area.norm(),
                                       points[b].spacing(),
                                       points.body(b)));
        }
      most     = Utilities::MPI::max(most, comm);
      width    = std::pow(Utilities::MPI::max(width, comm), 1. / dim);
      spacing  = Utilities::MPI::max(spacing, comm);
      n_passes = std::min<double>(most_passes, std::ceil(most - 1e-9));
      PointList<dim> all(Flat<Grain<dim>>::n);
      all.reserve(n_own);
      for (unsigned int p = 0; p < n_own; ++p)
        {
          const Tensor<2, dim> F_e = own[p].elastic_deformation();
          all.add_value(
            own.id(p),
            own.position(p),
            Grain<dim>(own.volume(p),
                       std::min(1., strain_of(p) / std::max(1u, n_passes)),
                       own.body(p),
                       std::pow(determinant(F_e), 1. / dim) * invert(F_e)));
        }
      all.append(halo(all, tissue.grid(), pair_reach * width));
      patches.append(halo(patches, tissue.grid(), 2. * (width + spacing)));
      x = all.positions;
      cells.reserve(x.size());
      l.reserve(x.size());
      for (std::size_t i = 0; i < all.size(); ++i)
        {
          cells.push_back(all.template value<Grain<dim>>(i));
          l.push_back(std::pow(std::get<0>(cells.back()), 1. / dim));
        }
      near_patches.resize(n_own);
      if (n_own > 0)
        find_pairs();
    }


    template <int dim>
    void
    CrowdedCells<dim>::find_pairs()
    {
      // Most cells have no patch near them, so that patches look for cells.
      // The motion of a cell depends on their order, so that the nearest come
      // first: ids would tell a surface from its mirror image. Each pair is
      // listed once. A place where folds touch is looked at from both of them,
      // so that patches are known as far as pairs reach there.
      const bool           has_folds = tissue.cells().has_parts();
      const GridBox<dim>   box       = box_around(x, pair_reach * width);
      const PointBins<dim> bins(box, x);
      for (unsigned int b = 0; b < patches.size(); ++b)
        {
          const auto [normal, spacing, body] =
            patches.template value<Patch<dim>>(b);
          bins.visit_within(patches.positions[b],
                            has_folds ? pair_reach * width + spacing :
                                        0.5 * width + std::max(width, spacing),
                            [&, of = body](const unsigned int p) {
                              if (p < n_own && std::get<2>(cells[p]) == of)
                                near_patches[p].push_back(b);
                            });
        }
      for (unsigned int p = 0; p < n_own; ++p)
        std::sort(near_patches[p].begin(),
                  near_patches[p].end(),
                  [&](const auto a, const auto b) {
                    const double to_a =
                                   x[p].distance_square(patches.positions[a]),
                                 to_b =
                                   x[p].distance_square(patches.positions[b]);
                    return std::tie(to_a, patches.ids[a]) <
                           std::tie(to_b, patches.ids[b]);
                  });
      // Whether the surface passes between two cells, the first of which is one
      // of this rank: then they belong to folds that face each other.
      const auto are_parted = [&](const unsigned int p, const unsigned int q) {
        return std::any_of(
          near_patches[p].begin(), near_patches[p].end(), [&](const auto b) {
            const auto [normal, spacing, body] =
              patches.template value<Patch<dim>>(b);
            const Tensor<1, dim> to_patch = patches.positions[b] - x[p];
            const double         depth    = normal * to_patch;
            const double         step     = normal * (x[q] - x[p]);
            return depth * (depth - step) < 0. &&
                   (depth / step * (x[q] - x[p]) - to_patch).norm() <= spacing;
          });
      };
      for (unsigned int p = 0; p < n_own; ++p)
        bins.visit_within(
          x[p], 0.5 * pair_reach * (l[p] + width), [&](const unsigned int q) {
            if (q > p && std::get<2>(cells[p]) == std::get<2>(cells[q]) &&
                x[p].distance(x[q]) < 0.5 * pair_reach * (l[p] + l[q]) &&
                !(has_folds && are_parted(p, q)))
              pairs.push_back({{p, q}});
          });
    }


    /** What is left of a motion of own cell @p p where patches are in its way.
     */
    template <int dim>
    Tensor<1, dim>
    CrowdedCells<dim>::inside_part(Tensor<1, dim>     way,
                                   const unsigned int p) const
    {
      for (const unsigned int b : near_patches[p])
        {
          const auto [normal, spacing, body] =
            patches.template value<Patch<dim>>(b);
          const Tensor<1, dim> to_patch = patches.positions[b] - x[p];
          const double         depth    = to_patch * normal;
          const double         room = std::max(0., depth - least_depth * l[p]);
          if ((to_patch - depth * normal).norm() <= spacing && depth > -l[p] &&
              way * normal > room)
            way -= (way * normal - room) * normal;
        }
      return way;
    }


    template <int dim>
    void
    CrowdedCells<dim>::move()
    {
      // All motions of a pass are those of the same places. They are summed as
      // integers, so that the order of the pairs, which depends on the ranks,
      // does not matter. Then no cell goes farther than a quarter of its
      // length, nor out of its body. Sent by their first places, the new ones
      // of other ranks come in the order in which they were known.
      constexpr int                              bits = 46;
      std::vector<std::array<std::int64_t, dim>> sums(cells.size());
      for (const auto &[p, q] : pairs)
        {
          const auto &[V_p, s_p, body_p, M_p] = cells[p];
          const auto &[V_q, s_q, body_q, M_q] = cells[q];
          const Tensor<1, dim> r              = x[p] - x[q];
          const double         rest = 0.5 * distance_part * (l[p] + l[q]);
          const double         d    = (0.5 * ((M_p + M_q) * r)).norm();
          if (!(d < rest) || d == 0.)
            continue;
          const Tensor<1, dim> way = 0.5 * (s_p + s_q) * pass_part *
                                     (rest / d - 1.) / (V_p + V_q) / width * r;
          for (unsigned int k = 0; k < dim; ++k)
            {
              sums[p][k] += std::llround(std::ldexp(V_q * way[k], bits));
              sums[q][k] -= std::llround(std::ldexp(V_p * way[k], bits));
            }
        }
      PointList<dim> now(Flat<Point<dim>>::n);
      now.reserve(n_own);
      for (unsigned int p = 0; p < n_own; ++p)
        {
          Tensor<1, dim> way;
          for (unsigned int k = 0; k < dim; ++k)
            way[k] = width * std::ldexp(double(sums[p][k]), -bits);
          if (const double far = way.norm(); far > longest_way * l[p])
            way *= longest_way * l[p] / far;
          now.add_value(tissue.cells().id(p),
                        tissue.cells().position(p),
                        Point<dim>(x[p] + inside_part(way, p)));
        }
      now.append(halo(now, tissue.grid(), pair_reach * width));
      for (std::size_t i = 0; i < x.size(); ++i)
        x[i] = now.template value<Point<dim>>(i);
    }
  } // namespace


  template <int dim>
  double
  keep_apart(Tissue<dim> &tissue)
  {
    const MPI_Comm    comm = tissue.communicator();
    CrowdedCells<dim> crowd(tissue);
    for (unsigned int pass = 0; pass < crowd.n_passes; ++pass)
      crowd.move();
    const double n_close = Utilities::MPI::sum(crowd.n_close(), comm);
    const double n       = Utilities::MPI::sum(tissue.cells().size(), comm);
    crowd.x.resize(tissue.cells().size());
    if (Utilities::MPI::logical_or(crowd.x != tissue.cells().positions(), comm))
      tissue.move(crowd.x, tissue.boundary_points().positions());
    return n > 0. ? n_close / n : 0.;
  }

  MORULA_INSTANTIATE(keep_apart);
} // namespace Morula
