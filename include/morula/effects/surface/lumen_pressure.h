// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_lumen_pressure_h
#define morula_effects_surface_lumen_pressure_h

#include <morula/effects/part_of_step.h>
#include <morula/mechanics/enclosure.h>
#include <morula/mechanics/spline_field.h>

#include <memory>
#include <string>
#include <vector>

namespace Morula
{
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
