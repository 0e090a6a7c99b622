// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/grid/extension.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace Morula
{
  namespace
  {
    /** Fills with a smaller relative difference are equal. In symmetric tissue
     *  the solver's error makes them differ by less. */
    constexpr double equal_fills = 1e-6;

    /** How far a spline lies beyond a block in each direction; 0 if it is among
     *  the block's splines in that direction. Blocks with the same distances
     *  give the same weights to the same splines. */
    template <int dim>
    GridIndex<dim>
    extrapolation(const GridIndex<dim> &spline, const GridIndex<dim> &block)
    {
      GridIndex<dim> distance;
      for (unsigned int d = 0; d < dim; ++d)
        {
          // The block's splines are at -1, 0 and 1 from its middle.
          const int j = spline[d] - block[d];
          distance[d] = std::abs(j) <= 1 ? 0 : j;
        }
      return distance;
    }

    template <int dim>
    double
    sum_of_weights(const GridIndex<dim> &spline, const GridIndex<dim> &block)
    {
      double product = 1.;
      for (unsigned int d = 0; d < dim; ++d)
        {
          // Σ|e| of a tensor product is the product of the sums by direction.
          // All e are integers, so equal sums are equal to the last bit.
          double sum = 0.;
          for (const double e : extension_weights(spline[d] - (block[d] - 1)))
            sum += std::abs(e);
          product *= sum;
        }
      return product;
    }
  } // namespace

  std::array<double, 3>
  extension_weights(const int j)
  {
    // These are Lagrange's polynomials, doc/theory.md (3.3), for the nodes 0,
    // 1, 2.
    return {{0.5 * (j - 1) * (j - 2), -1. * j * (j - 2), 0.5 * j * (j - 1)}};
  }

  template <int dim>
  std::array<double, BSpline<dim>::n>
  extension_weights(const GridIndex<dim> &spline, const GridIndex<dim> &block)
  {
    std::array<double, 3> e[dim];
    for (unsigned int d = 0; d < dim; ++d)
      e[d] = extension_weights(spline[d] - (block[d] - 1));
    std::array<double, BSpline<dim>::n> weights;
    for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
      {
        weights[a] = 1.;
        for (unsigned int d = 0; d < dim; ++d)
          weights[a] *= e[d][BSpline<dim>::offset(a, d) + 1];
      }
    return weights;
  }

  template <int dim>
  ExtensionSearch<dim>::ExtensionSearch(
    const Occupancy<dim> &occupancy, const std::vector<GridCellClass> &classes)
    : occupancy(occupancy)
    , nodes(occupancy.nodes())
    , classes(classes)
    , reached(nodes.size(), 0)
  {}

  /** Grid cells with tissue within @p radius of the spline's centre that are
   *  connected, inside this window, to the copy's support. */
  template <int dim>
  std::vector<unsigned int>
  ExtensionSearch<dim>::connected(const GridIndex<dim>            &center,
                                  const std::vector<unsigned int> &support,
                                  const int                        radius)
  {
    // A breadth-first search over grid cells with tissue, which starts from the
    // copy's own support and does not leave the given radius. So it does not
    // reach bodies on the other side of a gap. `reached` serves all searches:
    // only the entries that were set are cleared.
    std::vector<unsigned int> list;
    const auto reach = [&](const unsigned int node, const auto &index) {
      for (unsigned int d = 0; d < dim; ++d)
        if (std::abs(index[d] - center[d]) > radius)
          return;
      if (classes[node] != GridCellClass::empty && !reached[node])
        {
          reached[node] = 1;
          list.push_back(node);
        }
    };
    for (const unsigned int node : support)
      reach(node, nodes.index(node));
    // The list grows while it is read.
    for (std::size_t i = 0; i < list.size(); ++i)
      nodes.for_linked(list[i], reach);
    for (const unsigned int node : list)
      reached[node] = 0;
    return list;
  }

  /** Chooses among blocks with the same Σ|e|: doc/theory.md, section 3.4. */
  template <int dim>
  std::vector<unsigned int>
  ExtensionSearch<dim>::fullest(const GridIndex<dim>            &spline,
                                const std::vector<unsigned int> &blocks) const
  {
    // Groups are blocks that extrapolate alike; see extrapolation(). Their
    // fills are sums of multiples of 2⁻⁴⁰, so the order of summation does not
    // matter. Of all groups with the most tissue all blocks are chosen: the
    // choice turns and mirrors with the tissue.
    struct Group
    {
      std::vector<unsigned int> blocks;
      double                    fill = 0.; // a sum of multiples of 2^-40: exact
    };
    std::map<GridIndex<dim>, Group> groups;
    double                          most = 0.;
    for (const unsigned int block : blocks)
      {
        Group &group = groups[extrapolation<dim>(spline, nodes.index(block))];
        group.blocks.push_back(block);
        group.fill += occupancy.fill(block);
        most = std::max(most, group.fill);
      }
    std::vector<unsigned int> chosen;
    for (const auto &[distance, group] : groups)
      if (group.fill >= (1. - equal_fills) * most)
        chosen.insert(chosen.end(), group.blocks.begin(), group.blocks.end());
    std::sort(chosen.begin(), chosen.end());
    return chosen;
  }

  template <int dim>
  std::vector<unsigned int>
  ExtensionSearch<dim>::blocks(const GridIndex<dim>            &center,
                               const std::vector<unsigned int> &support)
  {
    std::vector<unsigned int> best;
    double                    best_sum = std::numeric_limits<double>::max();
    std::size_t               n_before = 0;
    // The search looks at ever larger windows around the spline, doc/theory.md,
    // section 3.4. Each time it collects the connected inner grid cells with
    // the smallest Σ|e|. It ends once no block outside of the window can have a
    // smaller sum, or the larger window has brought nothing new. Where this
    // rank's own window of tables ends before that, the search ends without a
    // result, and the caller asks for a wider window.
    for (int radius = 2;; ++radius)
      {
        // The blocks' splines have copies, too, and these have to be known
        // here.
        if (!occupancy.window().holds(center,
                                      radius + 1 + SplineCopies<dim>::reach()))
          {
            met_edge = true;
            return {};
          }
        const auto list = connected(center, support, radius);
        best.clear(); // the larger window finds them again
        for (const unsigned int number : list)
          if (classes[number] == GridCellClass::inner)
            {
              const double sum = sum_of_weights(center, nodes.index(number));
              if (sum < best_sum)
                best.clear();
              if (sum <= best_sum)
                best.push_back(number);
              best_sum = std::min(best_sum, sum);
            }
        // A farther block can have a smaller sum than a nearer one on the
        // diagonal (Σ|e| = 17 against 7·7·7). Blocks outside of this window
        // have at least the sum `least`.
        const double least = 2. * (radius + 1) * (radius + 1) - 1.;
        if (best_sum < least || (radius > 2 && list.size() == n_before))
          return fullest(center, best);
        n_before = list.size();
      }
  }

  template std::array<double, 9>
  extension_weights(const GridIndex<2> &, const GridIndex<2> &);
  template std::array<double, 27>
  extension_weights(const GridIndex<3> &, const GridIndex<3> &);
  template class ExtensionSearch<2>;
  template class ExtensionSearch<3>;
} // namespace Morula
