// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_lattice_h
#define morula_seeding_lattice_h

#include <morula/seeding/seeding.h>
#include <morula/seeding/shape.h>

#include <deal.II/base/point.h>

#include <array>
#include <cstdint>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /**
   * The regular lattice of section 2.5 of the paper. Its sites stand at
   * Center + offset + (i + 1/2) L_p for all integers i; for a box at
   * Center - Size/2 + offset + (i + 1/2) L_p. The sites around the shape's
   * bounding box have numbers, x fastest, then y, then z.
   */
  template <int dim>
  class Lattice
  {
  public:
    /** @throws InputError if there are more sites than possible ids of cells */
    Lattice(const TissueParameters &parameters, const BoundingBox<dim> &box);

    std::uint64_t
    n_sites() const
    {
      std::uint64_t n = 1;
      for (const std::uint64_t count : counts)
        n *= count;
      return n;
    }

    /** Position of a site, µm; the same to the last bit on any number of ranks.
     */
    Point<dim>
    position(std::uint64_t site) const
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

    /** L_p, µm. */
    double
    site_spacing() const
    {
      return spacing;
    }

    /** The numbers of the up to 3^dim - 1 sites around a site, ascending. */
    std::vector<std::uint64_t>
    neighbors(const std::uint64_t site) const;

    /** Whether a cell sits at @p position: it lies inside the shape, farther
     *  than 1e-9 L_p from its surface. */
    bool
    is_occupied(const Shape<dim> &shape, const Point<dim> &position) const
    {
      // Sites on the surface are outside, whatever rounding says.
      return shape.contains(position, 1e-9 * spacing);
    }

  private:
    Point<dim>                     origin;
    double                         spacing;
    std::array<std::int64_t, dim>  first;
    std::array<std::uint64_t, dim> counts;
  };

  /** Says that the lattice misses the shape.
   *  @throws InputError always */
  [[noreturn]] void
  throw_no_cell_fits(const TissueParameters &parameters);


  /**
   * Gives every founder the volume and the centroid of its part of the shape.
   * Its part holds the points to which its site is the nearest occupied one;
   * ties go to the lowest site. Only the sites of the point's lattice box and
   * of the boxes around it are considered. So the volumes add up to the shape's
   * volume, to the accuracy of the sampling (5e-5 of it at six cells per
   * radius); without trimming every founder has the volume of a lattice box.
   * Parts of the shape that are farther from every site, such as thin spikes,
   * belong to no founder.
   * @param sites    the sites of @p founders, ascending
   * @return false if a founder's part is too thin to be sampled; then
   * @p founders must not be used
   */
  template <int dim>
  bool
  trim(const Lattice<dim>               &lattice,
       const Shape<dim>                 &shape,
       const std::vector<std::uint64_t> &sites,
       Founders<dim>                    &founders);
} // namespace Morula

#endif
