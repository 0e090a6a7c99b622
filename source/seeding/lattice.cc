// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/seeding/lattice.h>

#include <deal.II/base/utilities.h>
#include <deal.II/particles/property_pool.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace Morula
{
  template <int dim>
  Lattice<dim>::Lattice(const TissueParameters &parameters,
                        const BoundingBox<dim> &box)
    : origin(leading_components<dim>(parameters.center) +
             leading_components<dim>(parameters.lattice_offset))
    , spacing(parameters.cell_spacing)
  {
    // In a box the lattice begins at its corner, so that whole cells fill it;
    // in other shapes a corner of lattice boxes stands at the center.
    if (parameters.shape == "box")
      origin -= 0.5 * leading_components<dim>(parameters.size);

    double product = 1.;
    for (unsigned int d = 0; d < dim; ++d)
      {
        // Sites lie at origin + (i + 1/2) spacing. A number beyond what ids or
        // integers can count is refused here, before a loop over the sites
        // begins.
        const double lower =
          std::floor((box.lower_bound(d) - origin[d]) / spacing - 0.5);
        const double upper =
          std::ceil((box.upper_bound(d) - origin[d]) / spacing - 0.5);
        product *= upper - lower + 1.;
        if (!(product < std::numeric_limits<types::particle_index>::max()) ||
            !(std::abs(lower) < 1e15))
          parameters.cell_spacing.refuse(
            "a spacing in um that gives fewer than 4e9 cells",
            "Choose a larger spacing or a smaller tissue.");
        first[d]  = static_cast<std::int64_t>(lower);
        counts[d] = static_cast<std::uint64_t>(upper - lower + 1.);
      }
  }

  template <int dim>
  std::vector<std::uint64_t>
  Lattice<dim>::neighbors(const std::uint64_t site) const
  {
    // All sites around, of which some have no number.
    const unsigned int         n = dim == 2 ? 9 : 27;
    std::vector<std::uint64_t> list;
    for (unsigned int k = 0; k < n; ++k)
      {
        std::uint64_t other = 0, stride = 1, rest = site;
        bool          numbered = true;
        unsigned int  offsets  = k;
        for (unsigned int d = 0; d < dim; ++d, offsets /= 3)
          {
            // The neighbour is one below, equal, or one above. 0 - 1 wraps
            // round to a number that is too large.
            const std::uint64_t i = rest % counts[d] + offsets % 3 - 1;
            numbered              = numbered && i < counts[d];
            other += i * stride;
            stride *= counts[d];
            rest /= counts[d];
          }
        if (numbered && other != site)
          list.push_back(other);
      }
    return list;
  }

  void
  throw_no_cell_fits(const TissueParameters &parameters)
  {
    parameters.cell_spacing.refuse(
      "a spacing in um by which at least one cell's centre lies inside "
      "the tissue",
      "Choose a smaller spacing, a larger tissue, or another Lattice offset.");
  }

  template class Lattice<2>;
  template class Lattice<3>;


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

    /** A sample of a box with n^dim of them: the middle of one of equal parts.
     */
    template <int dim>
    Point<dim>
    sample_of(const Point<dim>                    &center,
              const double                         side,
              const std::array<unsigned int, dim> &index)
    {
      Point<dim> x = center;
      for (unsigned int d = 0; d < dim; ++d)
        x[d] += side * ((index[d] + 0.5) / n_samples<dim> - 0.5);
      return x;
    }

    /** Which samples of a box lie in the shape. A cube of samples that the
     *  surface is far from is judged as a whole, others by their halves: to ask
     *  for each sample costs a mesh more than all else. */
    template <int dim>
    class SamplesInside
    {
    public:
      SamplesInside(const Shape<dim> &shape,
                    const Point<dim> &center,
                    const double      side)
        : shape(shape)
        , center(center)
        , side(side)
        , inside(Utilities::pow(n_samples<dim>, dim), false)
      {
        judge({}, n_samples<dim>);
      }

      /** Calls @p visit(point) for each of them, in order. */
      template <typename Visitor>
      void
      visit(const Visitor &visit) const
      {
        for (unsigned int s = 0; s < inside.size(); ++s)
          if (inside[s])
            visit(sample_of<dim>(center, side, index_of(s)));
      }

    private:
      using Index = std::array<unsigned int, dim>;

      static Index
      index_of(const unsigned int s)
      {
        Index        index;
        unsigned int rest = s;
        for (unsigned int d = 0; d < dim; ++d, rest /= n_samples<dim>)
          index[d] = rest % n_samples<dim>;
        return index;
      }

      static unsigned int
      number_of(const Index &index)
      {
        unsigned int s = 0;
        for (unsigned int d = dim; d-- > 0;)
          s = s * n_samples<dim> + index[d];
        return s;
      }

      /** The cube of @p n samples along each axis from @p first on. */
      void
      judge(const Index &first, const unsigned int n)
      {
        if (n == 1)
          {
            inside[number_of(first)] =
              shape.contains(sample_of<dim>(center, side, first), 0.);
            return;
          }
        Index last = first;
        for (unsigned int d = 0; d < dim; ++d)
          last[d] += n - 1;
        const Point<dim> begin = sample_of<dim>(center, side, first),
                         end   = sample_of<dim>(center, side, last);
        // A little more than the samples reach, so that rounding decides none.
        const auto whole = n > 2 ?
                             shape.side_of_cube(begin + 0.5 * (end - begin),
                                                0.501 * (end[0] - begin[0])) :
                             std::nullopt;
        if (whole && !*whole)
          return;
        for (unsigned int k = 0; k < Utilities::pow(whole ? n : 2u, dim); ++k)
          {
            Index        index = first;
            unsigned int rest  = k;
            for (unsigned int d = 0; d < dim; ++d)
              {
                const unsigned int parts = whole ? n : 2;
                index[d] += (rest % parts) * (n / parts);
                rest /= parts;
              }
            if (whole)
              inside[number_of(index)] = true;
            else
              judge(index, n / 2);
          }
      }

      const Shape<dim> &shape;
      const Point<dim>  center;
      const double      side;
      std::vector<bool> inside;
    };
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
        SamplesInside<dim>(shape, x, side).visit([&](const Point<dim> &y) {
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
        // Few sites are near, so a plain search will do; their places are
        // computed once, as many samples ask for them.
        std::vector<std::pair<std::uint64_t, Point<dim>>> owners;
        for (const std::uint64_t site : lattice.neighbors(box))
          if (const Point<dim> x = lattice.position(site);
              lattice.is_occupied(shape, x))
            owners.emplace_back(site, x);
        SamplesInside<dim>(shape, lattice.position(box), side)
          .visit([&](const Point<dim> &y) {
            const std::uint64_t owner =
              std::min_element(owners.begin(),
                               owners.end(),
                               [&](const auto &a, const auto &b) {
                                 return a.second.distance_square(y) <
                                        b.second.distance_square(y);
                               })
                ->first;
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

  MORULA_INSTANTIATE(trim);
} // namespace Morula
