// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_fusion_h
#define morula_particles_fusion_h

#include <morula/particles/tissue.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace Morula
{
  /** How far two cells of one body stand apart at most, in units of their mean
   *  length V^(1/dim). Diagonal neighbours on a cubic lattice are at 1.73. */
  constexpr double widest_bond = 1.8;

  /** What a body is at t = 0. */
  struct BodyMeasures
  {
    double cells = 0.; // their number
    /** Of its cells, µm^dim. */
    double volume = 0.;
    /** Of its patches, µm^(dim-1). */
    double area = 0.;
    /** |Σ a n| of its patches: 0 if its surface is closed, µm^(dim-1). */
    double opening = 0.;

    /** The thickness of a sheet with this volume and area, µm. */
    double
    thickness() const
    {
      return area > 0. ? 2. * volume / area : 0.;
    }
  };


  /** What fuses after a step. */
  struct Fusion
  {
    /** Into which body a body goes that fuses, by its number; of all ranks. */
    std::map<unsigned int, unsigned int> into;
    /** This rank's boundary points that others face which are to fuse with
     *  them, by their numbers in the store, increasing. */
    std::vector<unsigned int> points;
  };

  /** Takes the surface away that two strands have had between them, so that
   *  bonds form there: doc/theory.md, section 4.3a. Collective. */
  template <int dim>
  void
  remove_fused_surface(const Fusion &fusion, Tissue<dim> &tissue)
  {
    // Patches of both sides leave together. What is left is closed as before,
    // as the two sides' area vectors cancel.
    if (Utilities::MPI::sum<std::uint64_t>(fusion.points.size(),
                                           tissue.communicator()) == 0)
      return;
    const BoundaryPoints<dim> &store = tissue.boundary_points();
    const PointList<dim>       all   = store.copy();
    PointList<dim>             left(all.n_numbers);
    for (unsigned int p = 0; p < store.size(); ++p)
      if (!std::binary_search(fusion.points.begin(), fusion.points.end(), p))
        left.add(all.ids[p],
                 all.positions[p],
                 ArrayView<const double>(all.row(p)));
    tissue.replace_surface(left);
  }

  /** Gives cells and boundary points of bodies that fuse their new body. The
   *  surface between them is still there. Collective. */
  template <int dim>
  void
  fuse_bodies(const Fusion &fusion, Tissue<dim> &tissue)
  {
    // The stores sort points by body, so that all are placed anew.
    const auto renamed = [&](PointList<dim>              points,
                             const Column<unsigned int> &column) {
      for (std::size_t i = 0; i < points.size(); ++i)
        if (const auto found = fusion.into.find(column.get(points.row(i)));
            found != fusion.into.end())
          column.set(points.row(i), found->second);
      return points;
    };
    PointList<dim> cells =
      renamed(tissue.cells().copy(), tissue.cells().columns().body);
    PointList<dim> points = renamed(tissue.boundary_points().copy(),
                                    tissue.boundary_points().columns().body);
    tissue.place(std::move(cells), std::move(points));
  }
} // namespace Morula

#endif
