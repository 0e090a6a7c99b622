// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/particles/fusion.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cstdint>
#include <utility>

namespace Morula
{
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


#define INSTANTIATE(dim)                                             \
  template void remove_fused_surface(const Fusion &, Tissue<dim> &); \
  template void fuse_bodies(const Fusion &, Tissue<dim> &);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
