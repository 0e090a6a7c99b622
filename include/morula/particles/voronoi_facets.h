// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_voronoi_facets_h
#define morula_particles_voronoi_facets_h

#include <deal.II/base/point.h>
#include <deal.II/particles/property_pool.h>

#include <vector>

namespace Morula
{
  using namespace dealii;

  /** Two points whose Voronoi cells have a facet in common. */
  struct VoronoiFacet
  {
    /** Their places in the list, a < b. */
    unsigned int a, b;
    /** Area, µm^(dim-1), in 2-D a length. */
    double area;
    /** Between the points, µm. */
    double distance;
  };

  /**
   * The facets of the Voronoi diagram of some points, but for those of points
   * that are farther than @p reach (µm) from each other; sorted by a, then b.
   * What of a facet is farther than @p radius (µm) from its points does not
   * count, so that facets at the hull have an end, and that no point farther
   * away than twice the radius counts. Of points in one place all but one have
   * no facet.
   */
  template <int dim>
  std::vector<VoronoiFacet>
  voronoi_facets(const std::vector<Point<dim>>            &points,
                 const std::vector<types::particle_index> &ids,
                 const double                              reach,
                 const double                              radius);
} // namespace Morula

#endif
