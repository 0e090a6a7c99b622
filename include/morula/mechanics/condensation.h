// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_condensation_h
#define morula_mechanics_condensation_h

#include <morula/grid/spline_space.h>
#include <morula/mechanics/local_system.h>

#include <vector>

namespace Morula
{
  /**
   * Converts between the 3^dim splines of a grid cell and its m unknowns:
   * u = C ũ, r̃ = Cᵀ r, K̃ = Cᵀ K C. Doing this per grid cell with
   * small dense products is several times cheaper than a global sparse triple
   * product or entrywise constraint resolution: doc/theory.md (3.5).
   *
   * Component i of unknown s is entry i m + s. Without a number of components
   * the field is the displacement.
   */
  template <int dim, int n_components = dim>
  class Condensation
  {
  public:
    /** Rows of a grid cell's equations. */
    static constexpr unsigned int n_dofs =
      LocalEquations<dim, n_components>::n_dofs;

    /** Keeps a reference to the grid cell. */
    explicit Condensation(const typename SplineSpace<dim>::GridCell &grid_cell);

    /** Number m of unknowns. */
    unsigned int
    m() const;

    /** @param coefficients n m values, n the number of components */
    LocalField<dim, n_components>
    expand(const std::vector<double> &coefficients) const;

    /**
     * @param forces n 3^dim values
     * @param magnitudes whether to use |C|, for sums of magnitudes
     */
    std::vector<double>
    condense(const std::array<double, n_dofs> &forces,
             const bool                        magnitudes = false) const;

    /** Memory for condense(), to be used for one grid cell after the other. */
    struct Work
    {
      std::vector<double> product, transposed;
    };

    /**
     * @param matrix (n 3^dim)² values, row by row
     * @return @p matrix itself if the unknowns are the splines, else a vector
     *         in @p work
     */
    const std::vector<double> &
    condense(const std::vector<double> &matrix, Work &work) const;

  private:
    /** Calls visit(s, weight) for the unknowns that make up spline @p a. */
    template <typename Visit>
    void
    for_each_weight(const unsigned int a, const Visit &visit) const;

    /** Cᵀ X, C acting on each component; X has n 3^dim rows. */
    void
    times_rows(const std::vector<double> &X,
               const unsigned int         n_columns,
               std::vector<double>       &result) const;

    const typename SplineSpace<dim>::GridCell &grid_cell;
  };
} // namespace Morula

#endif
