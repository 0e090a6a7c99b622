// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/seeding/lattice.h>

#include <deal.II/particles/property_pool.h>

#include <cmath>
#include <limits>

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
  std::uint64_t
  Lattice<dim>::n_sites() const
  {
    std::uint64_t n = 1;
    for (const std::uint64_t count : counts)
      n *= count;
    return n;
  }

  template <int dim>
  Point<dim>
  Lattice<dim>::position(std::uint64_t site) const
  {
    Point<dim> x;
    for (unsigned int d = 0; d < dim; ++d)
      {
        // Sites are numbered with x fastest.
        const std::int64_t i =
          first[d] + static_cast<std::int64_t>(site % counts[d]);
        x[d] = origin[d] + (static_cast<double>(i) + 0.5) * spacing;
        site /= counts[d];
      }
    return x;
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

  template <int dim>
  bool
  Lattice<dim>::is_occupied(const Shape<dim> &shape,
                            const Point<dim> &position) const
  {
    // Sites on the surface are outside, whatever rounding says.
    return shape.contains(position, 1e-9 * spacing);
  }

  void
  throw_no_cell_fits(const TissueParameters &parameters)
  {
    parameters.cell_spacing.refuse(
      "a spacing in um by which at least one cell's centre lies inside "
      "the tissue",
      "Choose a smaller spacing, a larger tissue, or another "
      "Lattice offset.");
  }

  template class Lattice<2>;
  template class Lattice<3>;
} // namespace Morula
