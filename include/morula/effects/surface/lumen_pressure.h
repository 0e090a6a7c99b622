// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_lumen_pressure_h
#define morula_effects_surface_lumen_pressure_h

#include <morula/effects/part_of_step.h>
#include <morula/effects/surface/boundary_condition.h>
#include <morula/mechanics/enclosure.h>
#include <morula/mechanics/spline_field.h>

#include <memory>
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

  /** The patches of this rank around the lumen; after the step with this
   *  displacement if there is one. */
  template <int dim>
  std::vector<LumenPatch<dim>>
  lumen_patches(const BoundaryCondition<dim> &lumen,
                const Tissue<dim>            &tissue,
                const DisplacementField<dim> *displacement = nullptr);

  /**
   * The content of a lumen in an attempt at a step. Seeks the pressure of one
   * that keeps its volume, turn by turn. If a gas fills it, one turn is enough:
   * doc/theory.md (4.8j). Keeps references to the lumen and to the attempt.
   * @param volume  at the beginning of the step, µm^dim
   * @param content before the pressure of the step is known
   */
  template <int dim>
  std::unique_ptr<PartOfStep<dim>>
  lumen_pressure(const BoundaryCondition<dim> &lumen,
                 const AttemptAtStep<dim>     &attempt,
                 const double                  volume,
                 const EnclosedContent        &content);
} // namespace Morula

#endif
