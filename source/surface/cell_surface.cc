// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/rounded_sums.h>
#include <morula/base/send_records.h>
#include <morula/surface/cell_lattice.h>
#include <morula/surface/cell_surface.h>

namespace Morula
{
  namespace
  {
    /** Some of the surface in one lattice cell. The spacing of the lattice is
     *  the unit of length, and its first node the origin. */
    template <int dim>
    struct Facet
    {
      Tensor<1, dim> vector;                  // outward area vector
      double         flux = 0.;               // area vector times place
      double         area = 0.;               // at least that of the vector
      Tensor<1, dim> moment;                  // area times place
      unsigned int   inside = 0, outside = 0; // nodes on either side
      std::uint64_t  key = 0;                 // its place in an order of all

      void
      add(const Facet &other)
      {
        vector += other.vector;
        flux += other.flux;
        area += other.area;
        moment += other.moment;
      }
    };

    /** The part of the surface in a simplex that it cuts.
     *  @param corners of a lattice cell that are the simplex's: bit d of one is
     *    its coordinate along direction d @param values there, minus the level
     *  @param lowest place of the lattice cell's lowest node
     *  @return with corners for nodes */
    template <int dim>
    Facet<dim>
    facet_in(const std::array<unsigned int, dim + 1> &corners,
             const std::array<double, 1 << dim>      &values,
             const GridIndex<dim>                    &lowest)
    {
      const auto place = [&](const unsigned int corner) {
        Tensor<1, dim> x;
        for (unsigned int d = 0; d < dim; ++d)
          x[d] = lowest[d] + int(corner >> d & 1);
        return x;
      };
      // The edges that are cut, around the polygon.
      std::array<Tensor<1, dim>, 4> polygon;
      Facet<dim>                    facet;
      unsigned int                  n = 0;
      for (const unsigned int in : corners)
        for (const unsigned int out : corners)
          if (values[in] > 0. && !(values[out] > 0.))
            {
              polygon[n++] = place(in) + values[in] /
                                           (values[in] - values[out]) *
                                           (place(out) - place(in));
              facet.inside  = in;
              facet.outside = out;
            }
      if (n == 4)
        std::swap(polygon[2], polygon[3]);
      const Tensor<1, dim> outwards =
        place(facet.outside) - place(facet.inside);
      for (unsigned int v = 1; v + dim - 2 < n; ++v)
        {
          Tensor<1, dim> vector, middle = (polygon[0] + polygon[v]) / dim;
          if constexpr (dim == 2)
            vector = cross_product_2d(polygon[1] - polygon[0]);
          else
            {
              vector = 0.5 * cross_product_3d(polygon[v] - polygon[0],
                                              polygon[v + 1] - polygon[0]);
              middle += polygon[v + 1] / dim;
            }
          if (vector * outwards < 0.)
            vector = -vector;
          const double area = vector.norm();
          facet.add({vector, vector * middle, area, area * middle});
        }
      return facet;
    }

    /** Calls visit(sum, facets) for the lattice cells of this rank that the
     *  surface at @p level (µm) crosses. */
    template <int dim, typename Visit>
    void
    for_facets(const CellLattice<dim> &lattice,
               const double            level,
               const Visit            &visit)
    {
      // Kuhn's simplices: their nodes go from the lowest corner of a lattice
      // cell to the highest one, along one direction after another.
      Facet<dim>                   all;
      std::vector<Facet<dim>>      facets;
      std::array<double, 1 << dim> values;
      lattice.for_cells([&](const unsigned int lowest, const auto &index) {
        unsigned int n_inside = 0;
        for (unsigned int c = 0; c < values.size(); ++c)
          {
            values[c] = lattice.distance[lowest + lattice.corners[c]] - level;
            n_inside += values[c] > 0.;
          }
        if (n_inside == 0 || n_inside == values.size())
          return;
        facets.clear();
        std::array<unsigned int, dim> directions;
        std::iota(directions.begin(), directions.end(), 0u);
        do
          {
            std::array<unsigned int, dim + 1> corners{{0}};
            for (unsigned int v = 0; v < dim; ++v)
              corners[v + 1] = corners[v] | 1u << directions[v];
            Facet<dim> facet = facet_in<dim>(corners, values, index);
            facet.inside     = lowest + lattice.corners[facet.inside];
            facet.outside    = lowest + lattice.corners[facet.outside];
            facet.key        = lattice.key(index) * 8 + facets.size();
            if (facet.inside == facet.outside)
              continue;
            if (facets.empty())
              all = facet;
            else
              all.add(facet);
            facets.push_back(facet);
        } while (std::next_permutation(directions.begin(), directions.end()));
        visit(all, facets);
      });
    }

    /** The level (µm) whose surface encloses a volume, in lattice cells.
     *  Collective. @param level from which the search begins */
    template <int dim>
    double
    level_of_volume(const CellLattice<dim> &lattice,
                    const double            wished,
                    double                  level)
    {
      // The volume falls with the level, of large bodies by the area: after
      // that guess the secant of the last two passes is taken, in an interval
      // that each pass makes smaller.
      const double e   = lattice.nodes.spacing();
      double       low = lattice.least * lattice.width, high = -low;
      double       former = 0., former_missing = 0.; // of the pass before
      for (unsigned int pass = 0; pass < 20; ++pass)
        {
          RoundedSums own(2, lattice.comm);
          for_facets(lattice, level, [&](const auto &all, const auto &) {
            own.add(0, all.flux / dim);
            own.add(1, all.area);
          });
          const auto   sums    = own.all();
          const double missing = wished - sums[0];
          if (std::abs(missing) < 1e-5 * wished || high - low < 1e-6 * e)
            break;
          (missing > 0. ? high : low) = level;
          const double slope          = pass == 0 ?
                                          sums[1] / e :
                                          (missing - former_missing) / (level - former);
          former                      = level;
          former_missing              = missing;
          level -= missing / slope;
          if (!(level > low && level < high))
            level = 0.5 * (low + high);
        }
      return level;
    }

    /** Fills cavities with less than so much room. @param rooms of all of them,
     *  in the order of their parts @return how much room they had */
    template <int dim>
    double
    fill_cavities(const std::vector<double> &rooms,
                  const double               least,
                  CellLattice<dim>          &lattice)
    {
      double            filled = 0.;
      std::vector<bool> is_small{false};
      auto              room = rooms.begin();
      for (std::size_t k = 1; k < lattice.parts.size(); ++k)
        {
          is_small.push_back(!lattice.parts[k].is_inside && *room < least);
          filled += is_small[k] ? *room : 0.;
          room += !lattice.parts[k].is_inside;
        }
      if (filled > 0.)
        for (std::size_t node = 0; node < lattice.distance.size(); ++node)
          if (is_small[lattice.part_of[node]])
            lattice.distance[node] = -lattice.least * lattice.width;
      return filled;
    }

    /** What the patches of this rank are made of. */
    template <int dim>
    std::vector<Facet<dim>>
    facets_of_patches(const CellLattice<dim> &lattice, const double level)
    {
      // One patch stands for all facets of a lattice cell, unless they lie
      // between several parts, or their area vectors cancel: at edges, and
      // where two sheets go through the lattice cell.
      const auto             &part_of = lattice.part_of;
      std::vector<Facet<dim>> patches;
      for_facets(lattice, level, [&](const auto &all, auto &facets) {
        bool is_single = all.vector.norm() >= 0.7 * all.area;
        for (const Facet<dim> &facet : facets)
          is_single = is_single &&
                      part_of[facet.inside] == part_of[all.inside] &&
                      part_of[facet.outside] == part_of[all.outside];
        if (is_single)
          facets = {all};
        for (const Facet<dim> &facet : facets)
          if (facet.vector.norm() >= 1e-6) // others have no direction
            patches.push_back(facet);
      });
      return patches;
    }

    /** What the patches of all ranks make. Collective. @param wished volume, in
     *  lattice cells */
    template <int dim>
    CellSurface<dim>
    surface_at(const double            level,
               const double            wished,
               const CellLattice<dim> &lattice)
    {
      // Cavities have the numbers 1, 2, ... in the order of the parts. The area
      // is summed, and the volume by what is faced.
      const auto                patches = facets_of_patches(lattice, level);
      CellSurface<dim>          surface;
      std::vector<unsigned int> numbers;
      unsigned int              n_sides = 0;
      for (const LatticePart &part : lattice.parts)
        {
          surface.n_parts += part.is_inside;
          numbers.push_back(part.is_inside ? 0 : n_sides++);
        }
      RoundedSums own(1 + n_sides, lattice.comm);
      for (const Facet<dim> &patch : patches)
        {
          surface.faced.push_back(numbers[lattice.part_of[patch.outside]]);
          own.add(0, patch.vector.norm());
          own.add(1 + surface.faced.back(), patch.flux / dim);
        }
      const auto   sums   = own.all();
      const double volume = std::accumulate(sums.begin() + 1, sums.end(), 0.);
      // What is missing, if it is little, all patches make good by one distance
      // along their normals.
      const bool   is_near = std::abs(wished - volume) < 1e-3 * wished;
      const double way     = is_near ? dim * (wished - volume) / sums[0] : 0.;

      const double               e      = lattice.nodes.spacing();
      const double               area   = Utilities::fixed_power<dim - 1>(e);
      const Point<dim>           origin = lattice.nodes.corner({});
      std::vector<std::uint64_t> keys;
      for (const Facet<dim> &patch : patches)
        {
          // The place is the middle of the facets, moved along the area vector
          // so that the patch adds as much to the volume as they do.
          const Tensor<1, dim> &A = patch.vector;
          const Tensor<1, dim>  x = patch.moment / patch.area;
          const double          to_place =
            (patch.flux - x * A) / A.norm_square() + way / A.norm();
          surface.positions.push_back(origin + e * (x + to_place * A));
          surface.areas.push_back(area * A);
          keys.push_back(patch.key);
        }
      for (std::size_t k = 2; k < sums.size(); ++k)
        surface.cavities.push_back(-sums[k] * area * e);
      surface.volume          = (is_near ? wished : volume) * area * e;
      surface.area            = sums[0] * area;
      surface.offset          = e * way - level;
      surface.edge            = e;
      const GlobalOrder order = global_order(keys, lattice.comm);
      surface.places          = order.places;
      surface.n_patches       = order.n_keys;
      return surface;
    }
  } // namespace

  template <int dim>
  CellSurface<dim>
  surface_of_cells(const PointList<dim>      &cells,
                   const BackgroundGrid<dim> &grid,
                   const CellSurfaceWish     &wish)
  {
    CellLattice<dim> lattice(cells, grid);
    if (lattice.n_cells == 0.)
      return {};
    // Cavities are filled at the level that encloses the volume. This changes
    // the volume: so the level is found anew, and others may appear.
    const double e = lattice.nodes.spacing();
    const double wished =
      wish.share * lattice.volume / Utilities::fixed_power<dim>(e);
    const double least =
      lattice.volume / lattice.n_cells * Utilities::fixed_power<dim>(wish.gap);
    double           level = 0., filled = 0.;
    CellSurface<dim> surface;
    for (unsigned int round = 0; round < 5; ++round)
      {
        level = level_of_volume(lattice, wished, level);
        lattice.find_parts(level);
        surface = surface_at(level, wished, lattice);
        const double more =
          round < 4 ? fill_cavities(surface.cavities, least, lattice) : 0.;
        if (!(more > 0.))
          break;
        filled += more;
      }
    surface.filled      = filled;
    surface.cell_length = std::pow(lattice.volume / lattice.n_cells, 1. / dim);
    return surface;
  }

  MORULA_INSTANTIATE(surface_of_cells);
} // namespace Morula
