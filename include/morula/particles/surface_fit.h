// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_surface_fit_h
#define morula_particles_surface_fit_h

#include <morula/particles/tissue.h>

namespace Morula
{
  /** How the boundary points fit the cells that they enclose. */
  struct SurfaceFit
  {
    /** The largest distance from a boundary point to the cell nearest to it,
     *  µm. */
    double distance = 0.;
    /** The volume that the boundary points enclose, µm^dim. */
    double enclosed = 0.;
    /** The volume of all cells, µm^dim. */
    double cells = 0.;
    /** |Σ a n|/Σ a: how far the surface is from being closed. */
    double opening = 0.;

    /** The enclosed volume over that of the cells, of which there are some. */
    double
    share() const
    {
      return enclosed / cells;
    }
  };

  /** How the surface of the tissue fits its cells; without boundary points only
   *  their volume. Collective. */
  template <int dim>
  SurfaceFit
  surface_fit(const Tissue<dim> &tissue);
} // namespace Morula

#endif
