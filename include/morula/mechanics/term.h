// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_term_h
#define morula_mechanics_term_h

#include <morula/mechanics/local_system.h>

#include <vector>

namespace Morula
{
  /**
   * Which growth a linearisation is taken at. The residual always has the
   * growth at t + dt; the first tangent of a step is taken at the growth at t:
   * doc/theory.md (5.1).
   */
  enum class GrowthAt
  {
    previous, // t
    current   // t + dt
  };

  /**
   * A term of the momentum balance. Only the terms that a scene calls for
   * exist. A term knows its points by active grid cell (their order in
   * SplineSpace::grid_cells()); it never sees the simulation.
   */
  template <int dim>
  class Term
  {
  public:
    virtual ~Term() = default;

    /**
     * Adds what @p system asks for on one active grid cell. All results go to
     * @p system: a term remembers nothing.
     * @param grid_cell active grid cell
     * @param field     displacement since the beginning of the step
     * @param growth    which growth to use
     * @param system    of this grid cell; the terms add up in it
     */
    virtual void
    add(const unsigned int     grid_cell,
        const LocalField<dim> &field,
        const GrowthAt         growth,
        LocalSystem<dim>      &system) const = 0;

    /**
     * The force of each of its points on the tissue, on one active grid cell
     * and in their order, kPa µm^(dim-1). Nothing of a term that is no sum over
     * points of its own.
     */
    virtual std::vector<Tensor<1, dim>>
    forces(const unsigned int, const LocalField<dim> &) const
    {
      return {};
    }

    /** Whether the term has an energy, i.e., a symmetric tangent. */
    virtual bool
    is_conservative() const
    {
      return true;
    }
  };
} // namespace Morula

#endif
