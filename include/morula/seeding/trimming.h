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
   * Gives every founder the volume and the centroid of its part of the shape:
   * of all points of the shape to which its site is the nearest occupied one
   * (ties: lowest site), among the sites of their lattice box and the boxes
   * around it. The volumes then add up to the shape's, to the accuracy of the
   * sampling (5e-5 of the whole at six cells a radius), instead of one
   * lattice box for every site inside. Parts of the shape farther from any
   * site, such as thin spikes, belong to nobody.
   * @param sites    of @p founders, ascending
   * @return false if a site's part of the shape is too thin to be sampled; the
   * founders are of no use then
   */
  template <int dim>
  bool
  trim(const Lattice<dim>               &lattice,
       const Shape<dim>                 &shape,
       const std::vector<std::uint64_t> &sites,
       Founders<dim>                    &founders);
} // namespace Morula

#endif
