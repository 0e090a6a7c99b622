// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/seeding/trimming.h>

#include <algorithm>
#include <cmath>

namespace Morula
{
  namespace
  {
    /** Samples per direction of a lattice box that the surface may cut. A box
     *  has about as many in 2-D as in 3-D. */
    template <int dim>
    constexpr unsigned int n_samples = dim == 2 ? 32 : 8;

    /** Volume and first moment of a part of the shape. */
    template <int dim>
    struct Part
    {
      double         volume = 0.;
      Tensor<1, dim> moment;

      void
      add(const Point<dim> &x, const double v)
      {
        volume += v;
        moment += v * x;
      }
    };

    /** Calls @p visit(point) for each sample of a box that lies in the shape.
     */
    template <int dim, typename Visitor>
    void
    for_samples_inside(const Shape<dim> &shape,
                       const Point<dim> &center,
                       const double      side,
                       const Visitor    &visit)
    {
      constexpr unsigned int n = n_samples<dim>;
      // The samples are the middles of equal parts of the box.
      for (unsigned int s = 0; s < (dim == 2 ? n * n : n * n * n); ++s)
        {
          Point<dim>   x    = center;
          unsigned int rest = s;
          for (unsigned int d = 0; d < dim; ++d, rest /= n)
            x[d] += side * ((rest % n + 0.5) / n - 0.5);
          if (shape.contains(x, 0.))
            visit(x);
        }
    }

    /** A site and its position: computed once, as many samples ask for it. */
    template <int dim>
    struct Site
    {
      std::uint64_t number;
      Point<dim>    x;
    };

    /** The occupied ones of @p sites, ascending. */
    template <int dim>
    std::vector<Site<dim>>
    occupied(const Lattice<dim>               &lattice,
             const Shape<dim>                 &shape,
             const std::vector<std::uint64_t> &sites)
    {
      std::vector<Site<dim>> result;
      for (const std::uint64_t site : sites)
        if (const Point<dim> x = lattice.position(site);
            lattice.is_occupied(shape, x))
          result.push_back({site, x});
      return result;
    }

    template <int dim>
    std::uint64_t
    nearest(const std::vector<Site<dim>> &sites, const Point<dim> &x)
    {
      // Few sites are near, so a plain search will do.
      return std::min_element(sites.begin(),
                              sites.end(),
                              [&](const Site<dim> &a, const Site<dim> &b) {
                                return a.x.distance_square(x) <
                                       b.x.distance_square(x);
                              })
        ->number;
    }
  } // namespace

  template <int dim>
  bool
  trim(const Lattice<dim>               &lattice,
       const Shape<dim>                 &shape,
       const std::vector<std::uint64_t> &sites,
       Founders<dim>                    &founders)
  {
    // Each site gets the samples of the shape that are nearest to it. First
    // come the boxes of this rank's own sites: whole ones inside of the shape
    // at once, others sample by sample. A sample in the box of an occupied site
    // is nearest to that one. Samples in boxes without a cell belong to the
    // nearest occupied site among the neighbours of the box, which may be
    // another rank's: that rank finds them by itself, so nothing is exchanged.
    // A site without any sample has no volume, and the scene is refused.
    const double side          = lattice.site_spacing();
    const double half_diagonal = 0.5 * side * std::sqrt(double(dim));
    const double sample        = std::pow(side / n_samples<dim>, dim);

    std::vector<Part<dim>> parts(sites.size());

    std::vector<std::uint64_t> empty; // neighbouring boxes without a cell
    for (std::size_t i = 0; i < sites.size(); ++i)
      {
        const Point<dim> x = lattice.position(sites[i]);
        if (shape.contains(x, 3. * half_diagonal))
          {
            parts[i].add(x, std::pow(side, dim)); // a whole box, inside
            continue;
          }
        for_samples_inside(shape, x, side, [&](const Point<dim> &y) {
          parts[i].add(y, sample);
        });
        for (const std::uint64_t other : lattice.neighbors(sites[i]))
          if (!lattice.is_occupied(shape, lattice.position(other)))
            empty.push_back(other);
      }
    std::sort(empty.begin(), empty.end());
    empty.erase(std::unique(empty.begin(), empty.end()), empty.end());

    for (const std::uint64_t box : empty)
      {
        const auto owners = occupied(lattice, shape, lattice.neighbors(box));
        for_samples_inside(
          shape, lattice.position(box), side, [&](const Point<dim> &y) {
            const auto owner = nearest(owners, y);
            const auto mine =
              std::lower_bound(sites.begin(), sites.end(), owner);
            // Any other owner is another rank's.
            if (mine != sites.end() && *mine == owner)
              parts[mine - sites.begin()].add(y, sample);
          });
      }

    for (std::size_t i = 0; i < sites.size(); ++i)
      {
        if (!(parts[i].volume > 0.))
          return false;
        founders.volumes[i]   = parts[i].volume;
        founders.positions[i] = Point<dim>(parts[i].moment / parts[i].volume);
      }
    return true;
  }

  template bool
  trim(const Lattice<2> &,
       const Shape<2> &,
       const std::vector<std::uint64_t> &,
       Founders<2> &);
  template bool
  trim(const Lattice<3> &,
       const Shape<3> &,
       const std::vector<std::uint64_t> &,
       Founders<3> &);
} // namespace Morula
