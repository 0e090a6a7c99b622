// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_neighbours_h
#define morula_particles_neighbours_h

#include <morula/particles/point_list.h>
#include <morula/particles/tissue.h>

#include <deal.II/base/point.h>
#include <deal.II/particles/property_pool.h>

#include <vector>

namespace Morula
{
  /** How it is found out which cells touch. */
  struct NeighbourSearch
  {
    /** Whether by facets of the Voronoi diagram, or by the distance alone. */
    bool by_facets = true;
    /** The farthest neighbour, in mean spacings a; by facets the farthest one
     *  with the free surface between. */
    double reach = 1.8;
    /** The least facet of neighbours, as a part of a cell's mean surface. */
    double least_part = 0.01;
  };

  /**
   * Which cells touch, doc/theory.md, section 12.1: the facet between p and q
   * has the least part of a cell's mean surface or more, and they are at most
   * the reach apart, or the free surface does not pass between them. The
   * neighbours of the cells of this rank, which may belong to others.
   */
  template <int dim>
  struct NeighbourGraph
  {
    /** A neighbour. */
    struct Edge
    {
      /** Its place in `points`. */
      unsigned int other;
      /** S, µm^(dim-1): of the facet, or the same for all by distance. */
      double area;
      /** l, µm. */
      double distance;
    };

    /** The cells of this rank in their order, then those of others around. */
    PointList<dim> points;
    /** How many of them belong to this rank. */
    unsigned int n_own = 0;
    /** The edges of own cell p are [offsets[p], offsets[p + 1]). */
    std::vector<unsigned int> offsets;
    /** By the ids of the neighbours. */
    std::vector<Edge> edges;
    /** a, the dim-th root of the cells' mean volume, µm. */
    double spacing = 0.;
    /** The longest edge on any rank, µm. */
    double longest = 0.;

    /** Calls visit(edge) for the neighbours of own cell @p p. */
    template <typename Visit>
    void
    for_neighbours(const unsigned int p, const Visit &visit) const
    {
      for (unsigned int e = offsets[p]; e < offsets[p + 1]; ++e)
        visit(edges[e]);
    }
  };

  /**
   * The neighbours of the tissue's cells. The same on any number of ranks.
   * Collective.
   * @param cells of this rank, in the order of Tissue::cells(): each with a row
   *        of numbers that ranks tell each other of their cells
   */
  template <int dim>
  NeighbourGraph<dim>
  neighbours(const Tissue<dim>     &tissue,
             const PointList<dim>  &cells,
             const NeighbourSearch &search);

  /** The mean volume of the tissue's cells, µm^dim: the same bits on any number
   *  of ranks. Collective. */
  template <int dim>
  double
  mean_cell_volume(const Tissue<dim> &tissue);

  /** The free surface of each cell of this rank, µm^(dim-1): the boundary
   *  points whose nearest cell it is. Collective. */
  template <int dim>
  std::vector<double>
  free_surfaces(const Tissue<dim> &tissue);


  /**
   * Whether the surface touches another one at each boundary point, by the
   * points' numbers: that of another body, or, where bodies can touch
   * themselves, any that faces it. Where they do, one tissue goes on behind the
   * other. Collective.
   */
  template <int dim>
  std::vector<char>
  touching_points(const Tissue<dim> &tissue);


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
