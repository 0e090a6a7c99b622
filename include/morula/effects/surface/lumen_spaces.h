// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_lumen_spaces_h
#define morula_effects_surface_lumen_spaces_h

#include <morula/effects/part_of_step.h>
#include <morula/effects/tables.h>
#include <morula/mechanics/enclosure.h>
#include <morula/mechanics/spline_field.h>
#include <morula/particles/tissue.h>

#include <algorithm>
#include <memory>
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


  /** A patch of the surface around a lumen. */
  template <int dim>
  struct LumenPatch
  {
    /** Position, µm. */
    Point<dim> x;
    /** Area times normal, out of the tissue and so into the lumen;
     *  µm^(dim-1). */
    Tensor<1, dim> area;
  };

  /** Sums of a surface's patches. */
  template <int dim>
  struct SurfaceSums
  {
    double         area = 0.;   // µm^(dim-1)
    Tensor<1, dim> area_vector; // likewise
    Point<dim>     center;      // µm, the mean by area
  };

  /** Collective. */
  template <int dim>
  SurfaceSums<dim>
  sums_of(const std::vector<LumenPatch<dim>> &patches, const MPI_Comm comm);

  /**
   * The volume that patches enclose, µm^dim: doc/theory.md (4.8g). It does
   * not change if all patches move together. Collective.
   */
  template <int dim>
  double
  enclosed_volume(const std::vector<LumenPatch<dim>> &patches,
                  const MPI_Comm                      comm);

  /** The patches of this rank around a space, by its number in
   *  space_column(); after the step with this displacement if there is one. */
  template <int dim>
  std::vector<LumenPatch<dim>>
  lumen_patches(const unsigned int            space,
                const Tissue<dim>            &tissue,
                const DisplacementField<dim> *displacement = nullptr);

  /** What fills a space of lumens in an attempt at a step. */
  struct LumenContent
  {
    /** Number of the space in space_column(). */
    unsigned int space;
    /** Of what fills it, and of the kept number that is its pressure. */
    std::string name, of_pressure;
    /** Volume at the beginning of the step, µm^dim. */
    double volume;
    /** Before the pressure of the step is known. */
    EnclosedContent content = {};
    /** Further numbers that are kept at the end of the step. */
    NamedNumbers at_end = {};
  };

  /**
   * The content of a space in an attempt at a step. Seeks the pressure of one
   * that keeps its volume, turn by turn. If a gas fills it, one turn is enough:
   * doc/theory.md (4.8j). Keeps a reference to the attempt.
   */
  template <int dim>
  std::unique_ptr<PartOfStep<dim>>
  lumen_pressure(const AttemptAtStep<dim> &attempt,
                 const LumenContent       &content);
} // namespace Morula

#endif
