// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_term_h
#define morula_mechanics_term_h

#include <morula/mechanics/local_system.h>

#include <functional>
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

  /** Relevant unknowns in whose rows a matrix has entries for those of the
   *  columns. */
  struct UnknownLink
  {
    std::vector<unsigned int> rows, columns;

    bool
    operator==(const UnknownLink &other) const
    {
      return rows == other.rows && columns == other.columns;
    }
  };

  /**
   * A term of the momentum balance that couples places in different grid cells,
   * whose splines need not have anything in common. It knows the displacement
   * by its values at the relevant unknowns of this rank
   * (FieldUnknowns::fetch(), µm): component i of unknown s is number s dim + i.
   */
  class PairTerm
  {
  public:
    virtual ~PairTerm() = default;

    /** What a pair term adds to on this rank. */
    struct Sums
    {
      std::vector<double> &residual; // at the relevant unknowns
      std::vector<double> *magnitudes       = nullptr; // likewise, if wanted
      double               energy           = 0.;
      double               energy_magnitude = 0.;
    };

    /** The links of the term: each couples the unknowns of its rows with those
     *  of its columns. */
    virtual const std::vector<UnknownLink> &
    links() const = 0;

    /** Adds energy and residual at @p u. */
    virtual void
    add_residual(const std::vector<double> &u, Sums &sums) const = 0;

    /** Calls @p add with the number of each link and its part of the tangent at
     *  @p u, row by row: row i m + s is component i of the s-th of the link's m
     *  rows, and columns likewise. */
    virtual void
    add_tangent(
      const std::vector<double>                                            &u,
      const std::function<void(unsigned int, const std::vector<double> &)> &add)
      const = 0;
  };
} // namespace Morula

#endif
