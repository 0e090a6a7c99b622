// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_trimming_h
#define morula_seeding_trimming_h

#include <morula/seeding/lattice.h>
#include <morula/seeding/seeding.h>
#include <morula/seeding/shape.h>

#include <cstdint>
#include <vector>

namespace Morula
{
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
