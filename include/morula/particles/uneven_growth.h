// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_uneven_growth_h
#define morula_particles_uneven_growth_h

#include <morula/particles/tissue.h>

#include <array>
#include <unordered_map>

namespace Morula
{
  /** How unevenly cells have grown that share splines: the s of doc/theory.md
   *  (6.9e). It refers to the tissue. */
  template <int dim>
  class UnevenGrowth
  {
  public:
    /** Knows the grid cells that share splines with those of this rank.
     *  Collective. */
    explicit UnevenGrowth(const Tissue<dim> &tissue);

    /** Whether any two cells of all ranks have grown differently. Where none
     *  have, all is even, and sums are not made. */
    bool
    exists() const
    {
      return exists_;
    }

    /** The variance of ln det F_g, by volume, of the cells that share splines
     *  with those in the grid cell at @p x, which has some. */
    double
    variance(const Point<dim> &x) const;

  private:
    /** Quadratic splines span three grid cells, so that cells of grid cells
     *  two apart share one. */
    static constexpr unsigned int reach = 2;

    /** Sums of V, V ln det F_g and V (ln det F_g)^2. */
    using Sums = std::array<double, 3>;

    void
    sum(const Cells<dim> &cells);

    const BackgroundGrid<dim>             &grid;
    bool                                   exists_;
    std::unordered_map<unsigned int, Sums> sums;
  };
} // namespace Morula

#endif
