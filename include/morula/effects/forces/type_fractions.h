// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_forces_type_fractions_h
#define morula_effects_forces_type_fractions_h

#include <morula/grid/bspline.h>
#include <morula/grid/grid_box.h>

#include <array>
#include <map>
#include <vector>

namespace Morula
{
  /**
   * The fractions of the types of cells as fields on the splines of the grid,
   * lumped: φ_i = Σ V N_i [type] / Σ V N_i, doc/theory.md (12.1). At each place
   * they add up to 1, also beside the surface.
   */
  template <int dim>
  class TypeFractions
  {
  public:
    /** The fractions at a place, by type. */
    struct Values
    {
      std::vector<double>         fraction;
      std::vector<Tensor<1, dim>> gradient; // 1/µm
    };

    /** @param box its spacing and grid lines count; copied */
    TypeFractions(const GridBox<dim> &box, const unsigned int n_types);

    /** Adds a cell of volume @p V (µm^dim). Cells of one grid cell that follow
     *  one another cost least. */
    void
    add(const Point<dim> &x, const double V, const unsigned int type);

    /** Those at a place whose grid cell holds a cell. */
    Values
    at(const Point<dim> &x) const;

    /** Whether all @p n cells of a grid cell were added and no grid cell around
     *  it is empty, so that the tissue fills it. */
    bool
    is_filled_by(const unsigned int n, const GridIndex<dim> &index) const;

    /** The largest fraction of each type on any spline. */
    std::vector<double>
    largest() const;

    /** Adds the sums of another part of the tissue. */
    void
    add(const TypeFractions &other);

    /** Sums of a spline: of all cells, then of each type, µm^dim. */
    using Sums = std::vector<double>;
    /** Sums by the grid cell in which a spline is centred. */
    std::map<std::array<int, dim>, Sums> sums;
    /** How many cells a grid cell has. */
    std::map<std::array<int, dim>, unsigned int> counts;

  private:
    GridBox<dim> box;
    unsigned int n_types;
    /** Where the sums of the splines of the last grid cell are. */
    std::array<Sums *, BSpline<dim>::n> here;
    GridIndex<dim>                      here_index;
    bool                                is_somewhere = false;
  };
} // namespace Morula

#endif
