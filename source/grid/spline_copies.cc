// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/send_records.h>
#include <morula/grid/spline_copies.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/types.h>

#include <boost/pending/disjoint_sets.hpp>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <map>
#include <utility>

namespace Morula
{
  namespace
  {
    constexpr unsigned int no_piece = numbers::invalid_unsigned_int;

    /** For each of the 3^dim grid cells of a spline's support, the bits of
     *  those that it touches, including itself. */
    template <int dim>
    std::array<std::uint32_t, BSpline<dim>::n>
    make_touching()
    {
      std::array<std::uint32_t, BSpline<dim>::n> table{};
      for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
        for (unsigned int b = 0; b < BSpline<dim>::n; ++b)
          {
            bool touch = true;
            for (unsigned int d = 0; d < dim; ++d)
              touch = touch && std::abs(BSpline<dim>::offset(a, d) -
                                        BSpline<dim>::offset(b, d)) <= 1;
            if (touch)
              table[a] |= 1u << b;
          }
      return table;
    }

    /** The part of @p grid_cells that is connected to the lowest of them. */
    template <int dim>
    std::uint32_t
    first_part(const std::uint32_t grid_cells)
    {
      static const auto touching = make_touching<dim>();
      // The lowest bit is the lowest grid cell; parts grow by the grid cells
      // that touch them until nothing changes. At most 27 bits are to be looked
      // at.
      std::uint32_t part = grid_cells & ~(grid_cells - 1), before = 0;
      while (part != before)
        {
          before = part;
          for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
            if (before & (1u << a))
              part |= touching[a] & grid_cells;
        }
      return part;
    }

    /** Calls visit(a, number) for the grid cells of a spline's support that lie
     *  in the window. */
    template <int dim, typename Visit>
    void
    for_support(const GridWindow<dim> &window,
                const unsigned int     spline,
                const Visit           &visit)
    {
      const GridIndex<dim> center = window.index(spline);
      for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
        {
          GridIndex<dim> grid_cell = center;
          for (unsigned int d = 0; d < dim; ++d)
            grid_cell[d] += BSpline<dim>::offset(a, d);
          if (window.contains(grid_cell))
            visit(a, window.number(grid_cell));
        }
    }

    /** By grid cell, whether it or a neighbour has an active node: only there
     *  stand splines with active grid cells. */
    template <int dim>
    std::vector<char>
    near_active(const std::vector<GridCellClass> &classes,
                const GridNodes<dim>             &nodes,
                const GridWindow<dim>            &window)
    {
      std::vector<char> near(window.size(), 0);
      for (unsigned int node = 0; node < nodes.size(); ++node)
        if (is_active(classes[node]))
          window.for_neighbors(nodes.index(node),
                               1,
                               [&](const unsigned int neighbor, const auto &) {
                                 near[neighbor] = 1;
                               });
      return near;
    }

    /** A node, and this rank's part that holds it. */
    struct NodeOfPart
    {
      NodeName     node;
      unsigned int part;
    };

    /** A rank, its part, and the part of the rank that tells of it. */
    using Pair = std::array<unsigned int, 3>;

    /**
     * Joins the parts of all ranks to wholes. Parts of two ranks belong
     * together if they have a node in common. Every rank gets the list of all
     * wholes. (Boost's disjoint sets, one for each part of a rank.) Collective.
     * @param lowest lowest node that this rank knows of each of its parts
     * @param pairs  of its parts and those of others
     * @return the whole of each of this rank's parts, and the lowest node of
     *         each whole, increasing
     */
    std::pair<std::vector<unsigned int>, std::vector<NodeName>>
    wholes_of(const std::vector<NodeName> &lowest,
              const std::vector<Pair>     &pairs,
              const MPI_Comm               comm)
    {
      std::vector<unsigned int> wholes;
      std::vector<NodeName>     all_wholes;
      // Every rank gathers the lowest grid cells of all parts of all ranks, and
      // all pairs of parts that share a grid cell. Both are short: tissue has
      // few parts. Each rank then joins the same sets, so that all of them find
      // the same wholes, without a further message. A whole is named by its
      // lowest grid cell; their order is independent of the number of ranks.
      const auto                all_lowest = gather_everywhere(lowest, comm);
      const auto                all_pairs  = gather_everywhere(pairs, comm);
      std::vector<unsigned int> first(1, 0); // part of each rank
      std::vector<NodeName>     lowest_of;
      for (const auto &list : all_lowest)
        {
          first.push_back(first.back() + list.size());
          lowest_of.insert(lowest_of.end(), list.begin(), list.end());
        }

      boost::disjoint_sets_with_storage<> sets(lowest_of.size());
      // Part numbers become numbers over all ranks by first[rank].
      for (std::size_t rank = 0; rank < all_pairs.size(); ++rank)
        for (const auto &[other, their_part, part] : all_pairs[rank])
          sets.union_set(first[rank] + part, first[other] + their_part);

      // The lowest grid cell of a whole stands at its root.
      for (unsigned int part = 0; part < lowest_of.size(); ++part)
        {
          NodeName &low = lowest_of[sets.find_set(part)];
          low           = std::min(low, lowest_of[part]);
        }
      for (unsigned int part = 0; part < lowest_of.size(); ++part)
        if (sets.find_set(part) == part)
          all_wholes.push_back(lowest_of[part]);
      std::sort(all_wholes.begin(), all_wholes.end());
      // What this rank needs in the end is the whole of each of its own parts.
      const unsigned int begin = first[Utilities::MPI::this_mpi_process(comm)];
      for (unsigned int part = begin; part < begin + lowest.size(); ++part)
        wholes.push_back(std::lower_bound(all_wholes.begin(),
                                          all_wholes.end(),
                                          lowest_of[sets.find_set(part)]) -
                         all_wholes.begin());
      return {wholes, all_wholes};
    }
  } // namespace

  template <int dim>
  SplineCopies<dim>::SplineCopies(const GridWindow<dim>            &window,
                                  const GridNodes<dim>             &nodes,
                                  const std::vector<GridCellClass> &classes,
                                  const BackgroundGrid<dim>        &grid)
    : window(window)
    , nodes(nodes)
    , first(window.size() + 1, 0)
    , pieces(nodes.size(), no_piece)
  {
    // Copies follow from the classes around a spline, so they are made for
    // splines that are far enough inside of the window, and near active grid
    // cells. Parts are grid cells joined by copies on this rank; all ranks'
    // parts are joined to pieces then. Last, the copies that this rank uses
    // learn their piece, from any grid cell of their support.
    const std::vector<char> near = near_active(classes, nodes, window);
    find_own(classes, near, grid);
    std::vector<char> known(window.size(), 0);
    for (const GridRange<dim> &range : window.inner(reach()))
      window.for_range(range, [&](const unsigned int spline, const auto &) {
        known[spline] = near[spline];
      });
    for (unsigned int spline = 0; spline < window.size(); ++spline)
      {
        // first[] has an entry for each spline, also for those without copies.
        if (known[spline])
          {
            if (nodes.is_near_contest(spline))
              add_copies_of_parts(spline, classes);
            else
              add_copies(spline, classes);
          }
        first[spline + 1] = copies.size();
      }
    const unsigned int n_parts = find_parts();
    join_parts(n_parts, window.whole(), grid);
    for (SplineCopy &copy : copies)
      if (is_used(copy))
        for (const unsigned int node : nodes_of(copy))
          copy.piece = pieces[node];
  }

  template <int dim>
  void
  SplineCopies<dim>::find_own(const std::vector<GridCellClass> &classes,
                              const std::vector<char>          &near,
                              const BackgroundGrid<dim>        &grid)
  {
    const MPI_Comm     comm  = grid.communicator();
    const unsigned int rank  = Utilities::MPI::this_mpi_process(comm);
    const bool         alone = Utilities::MPI::n_mpi_processes(comm) == 1;
    // A rank owns the splines that stand on its grid cells, active or not.
    own.assign(window.size(), 0);
    for (unsigned int number = 0; number < window.size(); ++number)
      if (near[number] && (alone || grid.owner(window.index(number)) == rank))
        {
          own[number] = 1;
          nodes.for_parts(number, [&](const unsigned int node) {
            if (is_active(classes[node]))
              own_active.push_back(node);
          });
        }
    // With several boxes the window's order is not that of the grid's box, in
    // which unknowns are numbered.
    if (window.boxes().size() > 1)
      std::stable_sort(own_active.begin(),
                       own_active.end(),
                       [&](const unsigned int a, const unsigned int b) {
                         return grid.box().number(nodes.index(a)) <
                                grid.box().number(nodes.index(b));
                       });
  }

  template <int dim>
  void
  SplineCopies<dim>::add_copies(const unsigned int                spline,
                                const std::vector<GridCellClass> &classes)
  {
    // Three bit masks of the support: grid cells with tissue, active ones,
    // inner ones. Tissue connects; only active grid cells use a copy. So each
    // connected part of the tissue that holds an active grid cell gets one,
    // doc/theory.md, section 3.3.
    std::uint32_t tissue = 0, active = 0, inner = 0;
    for_support(window,
                spline,
                [&](const unsigned int a, const unsigned int number) {
                  const GridCellClass grid_cell = classes[number];
                  tissue |= (grid_cell >= GridCellClass::reached) << a;
                  active |= is_active(grid_cell) << a;
                  inner |= (grid_cell == GridCellClass::inner) << a;
                });
    // The loop ends once no active grid cell is left; of what remains no copy
    // would have any.
    while ((active & tissue) != 0)
      {
        const std::uint32_t part = first_part<dim>(tissue);
        if ((part & active) != 0)
          copies.push_back(
            {spline, part & active, (part & inner) != 0, no_piece});
        tissue &= ~part;
      }
  }

  template <int dim>
  void
  SplineCopies<dim>::add_copies_of_parts(
    const unsigned int spline, const std::vector<GridCellClass> &classes)
  {
    // As above, for nodes and their links instead of grid cells that touch.
    // Links between nodes of the support alone count: parts that join outside
    // of it have copies of their own.
    std::vector<unsigned int> tissue;
    for_support(window,
                spline,
                [&](const unsigned int, const unsigned int number) {
                  nodes.for_parts(number, [&](const unsigned int node) {
                    if (classes[node] >= GridCellClass::reached)
                      tissue.push_back(node);
                  });
                });
    left.resize(nodes.size(), 0);
    for (const unsigned int node : tissue)
      left[node] = 1;
    for (const unsigned int first : tissue)
      {
        if (!left[first])
          continue;
        // The part grows while it is read, from the first node that is left.
        std::vector<unsigned int> part(1, first);
        left[first] = 0;
        for (std::size_t i = 0; i < part.size(); ++i)
          nodes.for_linked(part[i], [&](const unsigned int node, const auto &) {
            if (left[node])
              {
                part.push_back(node);
                left[node] = 0;
              }
          });
        bool inner = false;
        for (const unsigned int node : part)
          inner = inner || classes[node] == GridCellClass::inner;
        part.erase(std::remove_if(part.begin(),
                                  part.end(),
                                  [&](const unsigned int node) {
                                    return !is_active(classes[node]);
                                  }),
                   part.end());
        if (part.empty())
          continue;
        copies.push_back({spline,
                          0,
                          inner,
                          no_piece,
                          static_cast<unsigned int>(lists.size())});
        lists.push_back(std::move(part));
      }
  }

  template <int dim>
  std::vector<unsigned int>
  SplineCopies<dim>::nodes_of(const SplineCopy &copy) const
  {
    if (copy.listed != no_piece)
      return lists[copy.listed];
    std::vector<unsigned int> list;
    for_support(window,
                copy.spline,
                [&](const unsigned int a, const unsigned int number) {
                  if (copy.support & (1u << a))
                    list.push_back(number);
                });
    return list;
  }

  template <int dim>
  unsigned int
  SplineCopies<dim>::find_parts()
  {
    // Boost's disjoint sets join all grid cells of each copy's support: those
    // then share a spline, so they belong to one part. Copies that this rank
    // does not use are left out, since their grid cells may lie beyond what it
    // knows. The parts get numbers in the order of their first grid cells in
    // the window.
    boost::disjoint_sets_with_storage<> sets(nodes.size());
    std::vector<char>                   used(nodes.size(), 0);
    for (const SplineCopy &copy : copies)
      {
        if (!is_used(copy))
          continue;
        const std::vector<unsigned int> support = nodes_of(copy);
        for (const unsigned int node : support)
          {
            used[node] = 1;
            sets.union_set(support.front(), node);
          }
      }
    unsigned int              n_parts = 0;
    std::vector<unsigned int> part_of_root(nodes.size(), no_piece);
    for (unsigned int node = 0; node < nodes.size(); ++node)
      if (used[node])
        {
          unsigned int &part = part_of_root[sets.find_set(node)];
          if (part == no_piece)
            part = n_parts++;
          pieces[node] = part;
        }
    return n_parts;
  }

  template <int dim>
  void
  SplineCopies<dim>::join_parts(const unsigned int         n_parts,
                                const GridBox<dim>        &whole,
                                const BackgroundGrid<dim> &grid)
  {
    // For each part its lowest node, and for each node of another rank that
    // this rank's parts hold, a message to its owner: there the two ranks'
    // parts belong together.
    constexpr unsigned int last = std::numeric_limits<unsigned int>::max();
    std::vector<NodeName>  lowest_of_parts(n_parts, NodeName{{last, last}});
    // nodes of other ranks, by owner
    std::map<unsigned int, std::vector<NodeOfPart>> seen;
    for (unsigned int node = 0; node < nodes.size(); ++node)
      if (pieces[node] != no_piece)
        {
          const GridIndex<dim> index = nodes.index(node);
          const NodeName there = {{whole.number(index), nodes.part(node)}};
          NodeName      &low   = lowest_of_parts[pieces[node]];
          low                  = std::min(low, there);
          if (!own[nodes.grid_cell(node)])
            seen[grid.owner(index)].push_back({there, pieces[node]});
        }
    // The owner knows its own part there. A pair is told once, however many
    // nodes two parts share.
    std::vector<Pair> pairs;
    for (const auto &[rank, list] : send_records(seen, grid.communicator()))
      for (const auto &[there, part] : list)
        pairs.push_back(
          {{rank, part, pieces[nodes.node(whole.index(there[0]), there[1])]}});
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    const auto [wholes, lowest_of_wholes] =
      wholes_of(lowest_of_parts, pairs, grid.communicator());
    lowest = lowest_of_wholes;
    for (unsigned int &piece : pieces)
      if (piece != no_piece)
        piece = wholes[piece];
  }


  template <int dim>
  unsigned int
  SplineCopies<dim>::at(const GridIndex<dim> &spline,
                        const unsigned int    node) const
  {
    const unsigned int number = window.number(spline);
    unsigned int       copy   = first[number];
    // Most splines have one copy.
    if (first[number + 1] - copy == 1)
      return copy;
    // The bit of the grid cell in the support of the spline.
    const GridIndex<dim> grid_cell = nodes.index(node);
    unsigned int         a         = 0;
    for (int d = dim - 1; d >= 0; --d)
      a = 3 * a + (grid_cell[d] - spline[d] + 1);
    const auto has_node = [&](const SplineCopy &one) {
      if (one.listed == no_piece)
        return (one.support & (1u << a)) != 0;
      const std::vector<unsigned int> &list = lists[one.listed];
      return std::find(list.begin(), list.end(), node) != list.end();
    };
    while (copy < first[number + 1] && !has_node(copies[copy]))
      ++copy;
    Assert(copy < first[number + 1], ExcInternalError());
    return copy;
  }


  template class SplineCopies<2>;
  template class SplineCopies<3>;
} // namespace Morula
