// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/mechanics/material_points.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace Morula
{
  namespace
  {
    /** A phase fills a grid cell if it has this part of its volume, and a grid
     *  cell counts if it is full to the second part. */
    constexpr double alone = 0.9, full = 0.5;

    /** So many grid cells have to be filled by a phase nearby. */
    constexpr unsigned int n_filled = 2;

    /** The phase that fills a grid cell. */
    struct Filled
    {
      unsigned int number, phase;
    };

    /** By grid cell: the phases that fill it or a neighbour, a phase for each
     *  of these. Collective. */
    template <int dim>
    std::vector<std::vector<unsigned int>>
    phases_around(const SplineSpace<dim>          &space,
                  const std::vector<unsigned int> &phases,
                  const MaterialPoints<dim>       &points)
    {
      // The filled grid cells of this rank are found body by body, and told to
      // the ranks in whose windows they lie; then each grid cell looks at those
      // around it. Where folds part a grid cell, the parts of its neighbours
      // count without distinction.
      std::vector<std::vector<unsigned int>> result(points.offsets.size() - 1);
      for (unsigned int b = 0; b < space.n_bodies(); ++b)
        {
          const auto is_of_body = [&](const unsigned int c) {
            return space.n_bodies() == 1 || space.grid_cells()[c].part == b;
          };
          std::vector<Filled> filled;
          for (unsigned int c = 0; c < result.size(); ++c)
            {
              std::map<unsigned int, double> volumes;
              double                         all = 0.;
              if (is_of_body(c))
                for (unsigned int p = points.offsets[c];
                     p < points.offsets[c + 1];
                     ++p)
                  {
                    volumes[phases[p]] += points.carried[p];
                    all += points.carried[p];
                  }
              for (const auto &[phase, volume] : volumes)
                if (volume >= alone * all &&
                    all >= full * std::pow(points.h, dim))
                  filled.push_back({space.grid_cells()[c].number, phase});
            }
          const auto of_others = space.occupancy(b).window().to_windows(filled);
          filled.insert(filled.end(), of_others.begin(), of_others.end());
          std::multimap<unsigned int, unsigned int> places;
          for (const Filled &one : filled)
            places.emplace(one.number, one.phase);
          for (unsigned int c = 0; c < result.size(); ++c)
            if (is_of_body(c))
              space.box().for_neighbors(
                space.box().index(space.grid_cells()[c].number),
                1,
                [&](const unsigned int number, const GridIndex<dim> &) {
                  for (auto [at, end] = places.equal_range(number); at != end;
                       ++at)
                    result[c].push_back(at->second);
                });
        }
      return result;
    }

    template <typename T>
    void
    permute(const std::vector<unsigned int> &order, std::vector<T> &list)
    {
      if (list.size() != order.size())
        return;
      std::vector<T> sorted;
      sorted.reserve(list.size());
      for (const unsigned int k : order)
        sorted.push_back(list[k]);
      list.swap(sorted);
    }

    /** Adds a pool of the points [first, last), which are sorted by phase.
     *  @param phase of a point */
    template <int dim, typename Phase>
    void
    add_pool(const unsigned int   first,
             const unsigned int   last,
             const Phase         &phase,
             MaterialPoints<dim> &points)
    {
      Pools &pools = points.pools;
      Pool pool{first, last, static_cast<unsigned int>(pools.groups.size()), 0};
      const Lame *lame = nullptr;
      double      k    = 0.;
      for (unsigned int p = first; p < last; ++p)
        {
          if (p == first || phase(p) != pools.groups.back().phase)
            pools.groups.push_back({p, p, phase(p), {}, {}});
          PoolGroup &group = pools.groups.back();
          group.last       = p + 1;
          if (lame != &points.lame_of(p))
            {
              lame = &points.lame_of(p);
              k    = points.material->bulk_modulus(lame->lambda, lame->mu);
            }
          group.modulus.before += points.states(GrowthAt::previous)[p].W * k;
          group.modulus.after += points.states(GrowthAt::current)[p].W * k;
          group.grown.before += points.grown[p].before;
          group.grown.after += points.grown[p].after;
        }
      pool.last_group = pools.groups.size();
      pools.list.push_back(pool);
    }

    /** A group in Newton's method for a mixed pool: G J_e, Λ U' and D. */
    struct OfGroup
    {
      double volume, slope, D;
    };
  } // namespace


  PoolEnergy
  pool_energy(const Pools    &pools,
              const Pool     &pool,
              const GrowthAt  growth,
              const double    theta,
              const Material &material)
  {
    // A pool of one group has its J_e. In a mixed one Newton's method looks for
    // ln J_e of the groups and the pressure q, with Λ U' = q G J_e in each and
    // Σ G J_e = v: the steps of doc/theory.md (2.7). A step bounds U'' - U'
    // from below, as the energy of some laws is not convex in J_e.
    const auto begin = pools.groups.begin() + pool.first_group,
               end   = pools.groups.begin() + pool.last_group;
    PoolEnergy result;
    if (end - begin == 1)
      {
        result.U         = material.volumetric(theta);
        result.U.modulus = begin->modulus.at(growth);
        result.theta     = {theta};
        return result;
      }
    double grown = 0.;
    for (auto group = begin; group != end; ++group)
      grown += group->grown.at(growth);
    result.theta.assign(end - begin, theta);
    const double v      = grown * std::exp(theta);
    double       change = 1.;
    for (unsigned int i = 0; i < 60; ++i)
      {
        double energy = 0., size = 0., modulus = 0., missing = v, pull = 0.,
               S = 0., of_step = 0.;
        std::vector<OfGroup> of_groups;
        for (auto group = begin; group != end; ++group)
          {
            const double ln_J    = result.theta[group - begin],
                         Lambda  = group->modulus.at(growth),
                         volume  = group->grown.at(growth) * std::exp(ln_J);
            const auto   U       = material.volumetric(ln_J);
            const double D       = U.curvature - U.slope,
                         bounded = Lambda * std::max(D, 0.1);
            missing -= volume;
            pull += volume * Lambda * U.slope / bounded;
            of_step += volume * volume / bounded;
            S += volume * volume / (Lambda * D);
            modulus += Lambda;
            energy += Lambda * U.energy;
            size += Lambda * U.magnitude;
            of_groups.push_back({volume, Lambda * U.slope, bounded});
          }
        const double q = (missing + pull) / of_step;
        result.U       = {modulus,
                          energy / modulus,
                          size / modulus,
                          q * v / modulus,
                          (v * v / S + q * v) / modulus};
        if (change < 1e-12)
          break;
        change = 0.;
        for (std::size_t g = 0; g < of_groups.size(); ++g)
          {
            const auto &[volume, slope, D] = of_groups[g];
            const double step              = (q * volume - slope) / D;
            result.theta[g] += std::clamp(step, -0.5, 0.5);
            change = std::max(change, std::abs(step));
          }
      }
    return result;
  }


  template <int dim>
  void
  make_pools(const SplineSpace<dim>          &space,
             const std::vector<unsigned int> &phases,
             MaterialPoints<dim>             &points)
  {
    // A point's key is its phase where that has a pool, else a number behind
    // all phases, with the phase second: so the points of a mixed pool stand
    // behind each other, group by group. Points of one key, in the order in
    // which they stood, are a pool.
    if (phases.empty())
      {
        make_pools_of_grid_cells(points);
        return;
      }
    constexpr unsigned int mixed   = -1;
    using Key                      = std::pair<unsigned int, unsigned int>;
    const auto                near = phases_around(space, phases, points);
    std::vector<Key>          keys(points.xi.size());
    std::vector<unsigned int> order(points.xi.size());
    std::iota(order.begin(), order.end(), 0u);
    for (unsigned int c = 0; c < near.size(); ++c)
      {
        for (unsigned int p = points.offsets[c]; p < points.offsets[c + 1]; ++p)
          keys[p] = {std::count(near[c].begin(), near[c].end(), phases[p]) <
                         n_filled ?
                       mixed :
                       phases[p],
                     phases[p]};
        std::stable_sort(order.begin() + points.offsets[c],
                         order.begin() + points.offsets[c + 1],
                         [&](const unsigned int a, const unsigned int b) {
                           return keys[a] < keys[b];
                         });
      }
    permute(order, keys);
    permute(order, points.xi);
    permute(order, points.lame);
    permute(order, points.current);
    permute(order, points.previous);
    permute(order, points.carried);
    permute(order, points.grown);
    points.pools.offsets = {0};
    for (unsigned int c = 0; c < near.size(); ++c)
      {
        unsigned int first = points.offsets[c];
        for (unsigned int p = first; p < points.offsets[c + 1]; ++p)
          if (p + 1 == points.offsets[c + 1] ||
              keys[p].first != keys[p + 1].first)
            {
              add_pool(
                first,
                p + 1,
                [&](const unsigned int i) { return keys[i].second; },
                points);
              first = p + 1;
            }
        points.pools.offsets.push_back(points.pools.list.size());
      }
  }


  template <int dim>
  void
  make_pools_of_grid_cells(MaterialPoints<dim> &points)
  {
    points.pools.offsets = {0};
    for (unsigned int c = 0; c + 1 < points.offsets.size(); ++c)
      {
        if (points.any(c))
          add_pool(
            points.offsets[c],
            points.offsets[c + 1],
            [](const unsigned int) { return 0u; },
            points);
        points.pools.offsets.push_back(points.pools.list.size());
      }
  }

  MORULA_INSTANTIATE(make_pools);
  MORULA_INSTANTIATE(make_pools_of_grid_cells);
} // namespace Morula
