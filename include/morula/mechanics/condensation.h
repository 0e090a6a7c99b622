// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_condensation_h
#define morula_mechanics_condensation_h

#include <morula/grid/spline_space.h>
#include <morula/mechanics/term.h>

#include <vector>

namespace Morula
{
  /**
   * Between the 3^dim splines of a grid cell and its m unknowns, within the
   * grid cell: u = C ũ, r̃ = Cᵀ r, K̃ = Cᵀ K C. Doing this per grid cell with
   * small dense products is several times cheaper than a global sparse triple
   * product or entrywise constraint resolution
   * (doc/theory.md, section 3).
   *
   * Component i of unknown s is entry i m + s.
   */
  template <int dim>
  class Condensation
  {
  public:
    explicit Condensation(const typename SplineSpace<dim>::Cell &cell);

    /** Number m of unknowns. */
    unsigned int
    m() const;

    /** @param coefficients dim m values */
    LocalField<dim>
    expand(const std::vector<double> &coefficients) const;

    /**
     * @param forces dim 3^dim values
     * @param magnitudes whether to use |C|, for sums of magnitudes
     */
    std::vector<double>
    condense(const std::array<double, LocalSystem<dim>::n_dofs> &forces,
             const bool magnitudes = false) const;

    /** @param matrix (dim 3^dim)² values, row by row */
    std::vector<double>
    condense(const std::vector<double> &matrix) const;

  private:
    struct Entry
    {
      unsigned int unknown;
      double       weight;
    };

    /** Cᵀ X, C acting on each component; X has dim 3^dim rows. */
    std::vector<double>
    times_rows(const std::vector<double> &X,
               const unsigned int         n_columns) const;

    std::array<std::vector<Entry>, BSpline<dim>::n> rows;
    unsigned int                                    m_;
    bool                                            identity;
  };
} // namespace Morula

#endif
