// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_snapshot_names_h
#define morula_output_snapshot_names_h

#include <deal.II/particles/property_pool.h>

#include <type_traits>

// What reading and writing a snapshot have in common.

namespace Morula
{
  /** An id as it stands in a snapshot: HDF5 has names for the types of C, not
   *  for those of fixed width. */
  using SnapshotId = std::conditional_t<sizeof(dealii::types::particle_index) ==
                                          sizeof(unsigned int),
                                        unsigned int,
                                        unsigned long long>;

  /** Names of an attribute and of a table. */
  constexpr const char *snapshot_format_name  = "Morula snapshot format";
  constexpr const char *snapshot_weights_name = "grid weights";
} // namespace Morula

#endif
