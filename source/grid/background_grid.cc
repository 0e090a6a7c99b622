// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/send_records.h>
#include <morula/grid/background_grid.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/mpi.templates.h>
#include <deal.II/grid/grid_generator.h>

#include <limits>
#include <map>

namespace Morula
{
  namespace
  {
    /** The key of a rank without leaves lies behind the keys of all leaves. */
    constexpr std::uint64_t no_leaf = std::numeric_limits<std::uint64_t>::max();

    /** One count for each grid cell, in order. */
    GridCellCounts
    merged(const GridCellCounts &counts)
    {
      // Counts of a grid cell may come from several ranks and several times
      // from one.
      std::map<unsigned int, unsigned int> sums;
      for (const GridCellCount &count : counts)
        sums[count.number] += count.n;
      GridCellCounts result;
      for (const auto &[number, n] : sums)
        result.push_back({number, n});
      return result;
    }

    /** The smallest number k with 2^k >= n. */
    int
    n_halvings(const int n)
    {
      int result = 0;
      while ((1 << result) < n)
        ++result;
      return result;
    }

    /**
     * The two coarse cells of the triangulation, each of 2^n_refinements grid
     * cells per direction. They meet in the middle of the box. The ranks share
     * the tree's leaves in the order of the tree; so planes through the middle
     * of the tree separate their parts (doc/performance.md, Two ranks).
     */
    template <int dim>
    struct CoarseCells
    {
      explicit CoarseCells(const GridBox<dim> &box)
        : repetitions(dim, 1)
        , first(box.first())
      {
        const GridIndex<dim> &n = box.n();
        // Both stand along the first direction that is at least 2/3 as long as
        // the longest. Bodies are mostly held and loaded along their last
        // direction; a cut across an earlier one gives each half a part of what
        // is held and loaded.
        const int longest = *std::max_element(n.begin(), n.end());
        while (3 * n[split] < 2 * longest)
          ++split;
        repetitions[split] = 2;
        // Enough levels that the longer of the halves, and each other
        // direction, fits into a coarse cell.
        for (unsigned int d = 0; d < dim; ++d)
          n_refinements =
            std::max(n_refinements,
                     n_halvings(d == split ? (n[d] + 1) / 2 : n[d]));

        for (unsigned int d = 0; d < dim; ++d)
          {
            // A short direction lies in the middle of the smallest descendant
            // that holds it, so that the tree is cut across it only after the
            // long directions.
            const int middle =
              d == split ? 1 << n_refinements : (1 << n_halvings(n[d])) / 2;
            first[d] += n[d] / 2 - middle;
            end[d] = first[d] + repetitions[d] * (1 << n_refinements);
          }
      }

      unsigned int              split         = 0; // the direction of both
      int                       n_refinements = 0;
      std::vector<unsigned int> repetitions;
      GridIndex<dim>            first, end;
    };

    /** Whether the triangulation's cell, of any level, holds grid cells of the
     *  box. */
    template <int dim>
    bool
    overlaps(const typename Triangulation<dim>::cell_iterator &grid_cell,
             const GridBox<dim>                               &box)
    {
      // The middles of the first and the last grid cell of this cell: vertices
      // lie on grid lines, where rounding would decide on which side they are
      // located.
      Tensor<1, dim> half;
      for (unsigned int d = 0; d < dim; ++d)
        half[d] = box.spacing() / 2;
      const GridIndex<dim> first = box.locate(grid_cell->vertex(0) + half);
      const GridIndex<dim> last =
        box.locate(grid_cell->vertex(grid_cell->n_vertices() - 1) - half);
      for (unsigned int d = 0; d < dim; ++d)
        if (last[d] < box.first()[d] || first[d] >= box.first()[d] + box.n()[d])
          return false;
      return true;
    }
  } // namespace

  template <int dim>
  void
  BackgroundGrid<dim>::make(const GridIndex<dim> &first,
                            const GridIndex<dim> &n)
  {
    // The octree starts from two coarse cells and is refined level by level,
    // but only where grid cells of the box lie. What lies outside of the box
    // stays coarse, and costs next to nothing. The weights of a former
    // partition do not belong to the new box.
    box_ = GridBox<dim>(first, n, h, offset);
    const CoarseCells<dim> coarse(box_);
    owned.clear(); // its iterators refer to the triangulation
    tria.clear();
    GridGenerator::subdivided_hyper_rectangle(tria,
                                              coarse.repetitions,
                                              box_.corner(coarse.first),
                                              box_.corner(coarse.end));
    // Each pass refines once, and p4est shares the new leaves among the ranks.
    for (int i = 0; i < coarse.n_refinements; ++i)
      {
        for (const auto &grid_cell : tria.active_cell_iterators())
          if (grid_cell->is_locally_owned() && overlaps<dim>(grid_cell, box_))
            grid_cell->set_refine_flag();
        tria.execute_coarsening_and_refinement();
      }
    weights_.clear();
    total_weight_ = 0.;
    find_owners();
  }

  template <int dim>
  void
  BackgroundGrid<dim>::partition(const GridCellCounts &weights)
  {
    // Any rank may have counted the points of a grid cell, but p4est asks the
    // owner of a leaf for its weight. So the counts go to the owners first.
    weights_      = sum_at_owners(weights);
    total_weight_ = 0.;
    for (const GridCellCount &weight : weights_)
      total_weight_ += weight.n;
    total_weight_ = Utilities::MPI::sum(total_weight_, comm);
    if (Utilities::MPI::n_mpi_processes(comm) == 1)
      return;
    // deal.II asks for a weight on each leaf. Every leaf weighs 1 besides its
    // points.
    const auto connection = tria.signals.weight.connect(
      [&](const typename Triangulation<dim>::cell_iterator &grid_cell,
          const typename Triangulation<dim>::CellStatus) -> unsigned int {
        const GridIndex<dim> index = box_.locate(grid_cell->center());
        return 1 + (box_.contains(index) ? weight(box_.number(index)) : 0);
      });
    tria.repartition();
    connection.disconnect();
    find_owners();
  }

  template <int dim>
  GridCellCounts
  BackgroundGrid<dim>::sum_at_owners(const GridCellCounts &counts) const
  {
    // On one rank there is nobody to ask. Else each count goes to the owner of
    // its grid cell.
    if (Utilities::MPI::n_mpi_processes(comm) == 1)
      return merged(counts);
    std::map<unsigned int, GridCellCounts> by_owner;
    for (const GridCellCount &count : counts)
      by_owner[owner(count.number)].push_back(count);
    return merged(in_one(send_records(by_owner, comm)));
  }

  /** Weight of a grid cell that this rank owned before the partition. */
  template <int dim>
  unsigned int
  BackgroundGrid<dim>::weight(const unsigned int number) const
  {
    const auto found =
      std::lower_bound(weights_.begin(),
                       weights_.end(),
                       number,
                       [](const GridCellCount &count, const unsigned int n) {
                         return count.number < n;
                       });
    return found != weights_.end() && found->number == number ? found->n : 0;
  }

  template <int dim>
  void
  BackgroundGrid<dim>::find_owners()
  {
    // This rank lists its own grid cells by number, the order in which all
    // passes visit them. Then each rank contributes the key of its lowest leaf.
    // Keys follow the order in which p4est numbers the leaves, and ranks have
    // consecutive parts of these. So one sorted list of first keys, which all
    // ranks gather, tells every owner.
    owned.clear();
    for (const auto &grid_cell : tria.active_cell_iterators())
      if (const GridIndex<dim> index = box_.locate(grid_cell->center());
          grid_cell->is_locally_owned() && box_.contains(index))
        owned.push_back({box_.number(index), grid_cell});
    std::sort(owned.begin(),
              owned.end(),
              [](const OwnedGridCell &a, const OwnedGridCell &b) {
                return a.number < b.number;
              });
    first_keys.clear();
    if (Utilities::MPI::n_mpi_processes(comm) == 1)
      return;
    const CoarseCells<dim> coarse(box_);
    first_of_trees = coarse.first;
    split          = coarse.split;
    n_levels       = coarse.n_refinements;
    // p4est may number the two trees in the other order.
    second_tree_first =
      tria.get_p4est_tree_to_coarse_cell_permutation()[0] == 1;
    Tensor<1, dim> half;
    for (unsigned int d = 0; d < dim; ++d)
      // Half a grid cell inwards from a vertex: rounding does not matter there.
      half[d] = box_.spacing() / 2;
    std::uint64_t lowest = no_leaf;
    for (const auto &leaf : tria.active_cell_iterators())
      if (leaf->is_locally_owned())
        lowest = std::min(lowest, key(box_.locate(leaf->vertex(0) + half)));
    first_keys = Utilities::MPI::all_gather(comm, lowest);
    // A rank without leaves begins where the next one begins, which then owns
    // the leaves from there on.
    for (std::size_t rank = first_keys.size() - 1; rank-- > 0;)
      if (first_keys[rank] == no_leaf)
        first_keys[rank] = first_keys[rank + 1];
  }

  template class BackgroundGrid<2>;
  template class BackgroundGrid<3>;
} // namespace Morula
