// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/grid/grid_owners.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <limits>

namespace Morula
{
  namespace
  {
    /** The key of a rank without leaves lies behind the keys of all leaves. */
    constexpr std::uint64_t no_leaf = std::numeric_limits<std::uint64_t>::max();
  } // namespace

  template <int dim>
  GridOwners<dim>::GridOwners(
    const parallel::distributed::Triangulation<dim> &tria,
    const GridBox<dim>                              &box,
    const Trees                                     &trees)
    : trees(trees)
  {
    // Each rank contributes the key of its lowest leaf. Keys follow the order
    // in which p4est numbers the leaves, and ranks have consecutive parts of
    // these. So one sorted list of first keys, which all ranks gather, tells
    // every owner.
    const MPI_Comm comm = tria.get_communicator();
    if (Utilities::MPI::n_mpi_processes(comm) == 1)
      return;
    // p4est may number the two trees in the other order.
    second_tree_first =
      tria.get_p4est_tree_to_coarse_cell_permutation()[0] == 1;
    Tensor<1, dim> half;
    for (unsigned int d = 0; d < dim; ++d)
      // Half a grid cell inwards from a vertex: rounding does not matter there.
      half[d] = box.spacing() / 2;
    std::uint64_t lowest = no_leaf;
    for (const auto &leaf : tria.active_cell_iterators())
      if (leaf->is_locally_owned())
        lowest = std::min(lowest, key(box.locate(leaf->vertex(0) + half)));
    first_keys = Utilities::MPI::all_gather(comm, lowest);
    // A rank without leaves begins where the next one begins, which then owns
    // the leaves from there on.
    for (std::size_t rank = first_keys.size() - 1; rank-- > 0;)
      if (first_keys[rank] == no_leaf)
        first_keys[rank] = first_keys[rank + 1];
  }

  template <int dim>
  unsigned int
  GridOwners<dim>::operator()(const GridIndex<dim> &grid_cell) const
  {
    if (first_keys.empty())
      return 0;
    // The owner is the last rank whose first key is not behind that of the grid
    // cell.
    return std::upper_bound(first_keys.begin(),
                            first_keys.end(),
                            key(grid_cell)) -
           first_keys.begin() - 1;
  }

  template <int dim>
  std::uint64_t
  GridOwners<dim>::key(GridIndex<dim> grid_cell) const
  {
    // Coordinates in the trees, then in one of them; the tree is the highest
    // digit of the key.
    for (unsigned int d = 0; d < dim; ++d)
      grid_cell[d] -= trees.first[d];
    const bool second = (grid_cell[trees.split] >> trees.n_levels) != 0;
    if (second)
      grid_cell[trees.split] -= 1 << trees.n_levels;
    // Morton order: the bits of the coordinates in turn, the highest ones
    // first.
    std::uint64_t key = second != second_tree_first;
    for (int level = trees.n_levels - 1; level >= 0; --level)
      for (int d = dim - 1; d >= 0; --d)
        key = (key << 1) | ((grid_cell[d] >> level) & 1);
    return key;
  }

  template class GridOwners<2>;
  template class GridOwners<3>;
} // namespace Morula
