// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_pair_term_h
#define morula_mechanics_pair_term_h

#include <functional>
#include <vector>

namespace Morula
{
  /**
   * A term of the momentum balance that couples places in different grid cells,
   * whose splines need not have anything in common. It knows the displacement
   * by its values at the relevant unknowns of this rank (FieldUnknowns::fetch(),
   * µm): component i of unknown s is number s dim + i.
   */
  class PairTerm
  {
  public:
    virtual ~PairTerm() = default;

    /** What a pair term adds to on this rank. */
    struct Sums
    {
      std::vector<double> &residual; // at the relevant unknowns
      std::vector<double> *magnitudes = nullptr; // likewise, if wanted
      double               energy           = 0.;
      double               energy_magnitude = 0.;
    };

    /** Lists of relevant unknowns: those of a list couple with one another. */
    virtual const std::vector<std::vector<unsigned int>> &
    links() const = 0;

    /** Adds energy and residual at @p u. */
    virtual void
    add_residual(const std::vector<double> &u, Sums &sums) const = 0;

    /** Calls @p add with the number of each link and its part of the tangent at
     *  @p u, row by row: row and column i m + s are component i of the link's
     *  s-th unknown, m their number. */
    virtual void
    add_tangent(
      const std::vector<double>                                         &u,
      const std::function<void(unsigned int, const std::vector<double> &)>
        &add) const = 0;
  };
} // namespace Morula

#endif
