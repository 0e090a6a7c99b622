// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_lumen_spaces_h
#define morula_effects_surface_lumen_spaces_h

#include <morula/effects/tables.h>
#include <morula/particles/tissue.h>

#include <algorithm>
#include <string>
#include <vector>

namespace Morula
{
  /** The column of the boundary points with the number of the lumens' space
   *  that they face, from 1 on; 0: none. */
  template <int dim>
  Column<unsigned int>
  space_column(const Tissue<dim> &tissue)
  {
    return tissue.boundary_points().columns().template find<unsigned int>(
      "lumen");
  }

  /** A space of lumens: what stays of it between steps. */
  struct LumenSpace
  {
    /** Volumes, µm^dim: of each lumen the part of its volume at t = 0 whose
     *  content is here; of one that gets fluid by secretion, what it has. */
    std::vector<double> held;
    /** At the last equilibrium, kPa. */
    double pressure = 0.;
    /** Whether all its cavities have one content. */
    bool together = false;

    bool
    is_filled() const
    {
      return std::any_of(held.begin(), held.end(), [](const double part) {
        return part != 0.;
      });
    }
  };

  /** The kept number that is the number of spaces; the names of what else is
   *  kept of them begin so. */
  inline const std::string number_of_spaces = "lumens/";

  /** What a number of a space, which counts from 0 on, is called among those
   *  that are kept. */
  std::string
  number_of_space(const unsigned int space, const std::string &what);

  /** The spaces of the kept numbers: none before they are kept first. */
  std::vector<LumenSpace>
  kept_spaces(const NamedNumbers &kept, const unsigned int n_lumens);

  /** Keeps them. */
  void
  keep_spaces(const std::vector<LumenSpace> &spaces, NamedNumbers &kept);

  /** What has become of the spaces of lumens on a surface that may be new, by
   *  their numbers less one. */
  struct SpacesOfSurface
  {
    /** The number of the space in which it is now: its own, or that of one with
     *  which it has merged; 0: it has none any more. */
    std::vector<unsigned int> into;
    /** Whether it has opened to the outside, rather than closed. */
    std::vector<bool> has_opened;
    /** How many cavities it has, as far as they are known. */
    std::vector<unsigned int> n_cavities;
    /** Those that have merged though the surface still shows several cavities:
     *  they stay one. */
    std::vector<unsigned int> joined = {};
    /** The spaces from which further ones have split off. These have the next
     *  numbers. */
    std::vector<unsigned int> split_from;
  };

  /**
   * Finds the spaces again by the cavities that boundary points face now, and
   * renumbers the points: a space is the cavity that most of its points face,
   * doc/theory.md, section 4.3. Points of which it is not known what they face
   * stay. Collective.
   * @param together whether all cavities of a space stay one space
   */
  template <int dim>
  SpacesOfSurface
  find_spaces(const std::vector<bool> &together, Tissue<dim> &tissue);

  /** Joins spaces between which the tissue has a gap, which the surface may not
   *  show yet, and renumbers the points. Collective. */
  template <int dim>
  void
  join_spaces(SpacesOfSurface &found, Tissue<dim> &tissue);
} // namespace Morula

#endif
