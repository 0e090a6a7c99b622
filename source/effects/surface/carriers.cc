// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/effects/surface/boundary_terms.h>

#include <deal.II/base/mpi.h>

namespace Morula
{
  namespace
  {
    const std::string name = "carrier";

    template <int dim>
    Column<int>
    column(const Tissue<dim> &tissue)
    {
      // Only scenes with held points and growth have the column.
      return tissue.boundary_points().columns().template find<int>(name);
    }
  } // namespace


  template <int dim>
  void
  add_carriers(BoundaryColumns<dim> &columns)
  {
    columns.template add<int>(
      {name, "", "id of the cell whose growth a held point takes", -1});
  }


  template <int dim>
  std::vector<types::particle_index>
  carriers(const std::vector<unsigned int> &points, const Tissue<dim> &tissue)
  {
    const Column<int>                  ids = column(tissue);
    std::vector<types::particle_index> list;
    for (const unsigned int p : points)
      // -1 is the id of no cell.
      list.push_back(ids.exists() ? tissue.boundary_points().get(ids, p) : -1);
    return list;
  }


  template <int dim>
  void
  renew_carriers(Tissue<dim> &tissue)
  {
    // The carriers that are still there are looked for by their ids around the
    // points. Those that were not found are replaced by the nearest cell, over
    // all ranks. If several are equally near none of them becomes the carrier,
    // and the mean counts until one is nearer. The exchanges are collective, so
    // ranks without lost points take part, and all leave together where no rank
    // has any.
    const Column<int> ids = column(tissue);
    if (!ids.exists())
      return;
    const BoundaryPoints<dim> &store = tissue.boundary_points();
    std::vector<unsigned int>  held;
    for (unsigned int p = 0; p < store.size(); ++p)
      if (is_held(store.condition(p)))
        held.push_back(p);
    const auto id = [&](const unsigned int p) -> double {
      return tissue.cells().id(p);
    };
    const auto                present = values_by_id(carriers(held, tissue),
                                      store.positions_of(held),
                                      tissue.cells(),
                                      id,
                                      tissue.grid());
    std::vector<unsigned int> lost;
    for (std::size_t k = 0; k < held.size(); ++k)
      if (!present[k])
        lost.push_back(held[k]);
    const MPI_Comm comm = tissue.communicator();
    if (!Utilities::MPI::logical_or(!lost.empty(), comm) ||
        Utilities::MPI::sum(1. * tissue.cells().size(), comm) == 0.)
      return;
    // Among several nearest cells the mean of the ids is larger than the lowest
    // of them.
    const std::vector<Point<dim>> queries = store.positions_of(lost);
    const std::vector<Side<dim>>  sides   = store.sides_of(lost);
    const auto                    lowest  = nearest_values(
      queries, tissue.cells(), id, Ties::lowest_id, tissue.grid(), sides);
    const auto mean = nearest_values(
      queries, tissue.cells(), id, Ties::mean, tissue.grid(), sides);
    for (std::size_t k = 0; k < lost.size(); ++k)
      tissue.boundary_point(lost[k]).set(
        ids, mean[k] == lowest[k] ? static_cast<int>(lowest[k]) : -1);
  }


  MORULA_INSTANTIATE(add_carriers);
  MORULA_INSTANTIATE(carriers);
  MORULA_INSTANTIATE(renew_carriers);
} // namespace Morula
