// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/send_records.h>
#include <morula/particles/tissue.h>

#include <algorithm>
#include <cmath>

namespace Morula
{
  namespace
  {
    /** Patches that overlap more than this, in units of h, are the sides of a
     *  sheet and not two surfaces that have met: as deep as pairs of points act
     *  on each other, doc/theory.md (4.8k). */
    constexpr double deepest_overlap = 0.4;

    /** All records of all ranks, by id. Collective. */
    template <typename Record>
    std::vector<Record>
    of_all_by_id(const std::vector<Record> &own, const MPI_Comm comm)
    {
      std::vector<Record> all;
      for (const auto &list : gather_everywhere(own, comm))
        all.insert(all.end(), list.begin(), list.end());
      std::sort(all.begin(), all.end(), [](const Record &a, const Record &b) {
        return a.id < b.id;
      });
      return all;
    }

    /** The box of the cell, with its edges however many points it has. */
    template <int dim>
    PartedCell<dim>
    parted_cell(const Cells<dim> &cells, const unsigned int p)
    {
      const ParticleDomain<dim> box =
        cell_domain<dim>(cells.position(p), cells[p]);
      const auto [lower, upper] = box.bounds();
      return {cells.id(p),
              cells.body(p),
              cells.position(p),
              invert(box.edge_vectors()),
              lower,
              upper};
    }
  } // namespace


  template <int dim>
  Parting<dim>
  find_parting(const Tissue<dim> &tissue)
  {
    // Every rank gets the whole surface, and finds the same contested grid
    // cells. Then all ranks get the cells that reach into the surroundings of
    // these, and part them alike: the parts of a grid cell must have the same
    // numbers wherever they are known, and a window reaches far. What travels
    // is in proportion to the surface, and to the part of the tissue that
    // touches.
    const MPI_Comm                comm   = tissue.communicator();
    const GridBox<dim>           &box    = tissue.grid().box();
    const BoundaryPoints<dim>    &points = tissue.boundary_points();
    std::vector<PartedPatch<dim>> own;
    for (unsigned int p = 0; p < points.size(); ++p)
      own.push_back({points.id(p),
                     points.body(p),
                     points.position(p),
                     points.area_vector(p) / points.area_vector(p).norm(),
                     points[p].spacing()});
    std::vector<PartedPatch<dim>>   patches = of_all_by_id(own, comm);
    const std::vector<unsigned int> contested =
      contested_grid_cells(box, patches, deepest_overlap * box.spacing());
    if (contested.empty())
      return {};

    // By grid cell: 2 where a domain may be cut, 1 where patches may cut bonds.
    std::vector<char> near(box.size(), 0);
    for (const int rings : {3, 1})
      for (const unsigned int number : contested)
        box.for_neighbors(box.index(number),
                          rings,
                          [&](const unsigned int neighbor, const auto &) {
                            near[neighbor] = rings == 1 ? 2 : 1;
                          });
    patches.erase(
      std::remove_if(patches.begin(),
                     patches.end(),
                     [&](const PartedPatch<dim> &patch) {
                       return near[box.number(box.locate(patch.x))] == 0;
                     }),
      patches.end());
    std::vector<PartedCell<dim>> cells;
    for (const auto &grid_cell : tissue.cells().grid_cells())
      for (unsigned int p = grid_cell.begin; p < grid_cell.end; ++p)
        {
          const PartedCell<dim> cell    = parted_cell(tissue.cells(), p);
          bool                  reaches = false;
          box.for_overlap(box.locate(cell.lower),
                          box.locate(cell.upper),
                          [&](const unsigned int number, const auto &) {
                            reaches = reaches || near[number] == 2;
                          });
          if (reaches)
            cells.push_back(cell);
        }
    return Parting<dim>(box, contested, of_all_by_id(cells, comm), patches);
  }


  MORULA_INSTANTIATE(find_parting);
} // namespace Morula
