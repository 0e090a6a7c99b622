// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/grid/parting.h>

#include <boost/pending/disjoint_sets.hpp>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <numeric>

// Which grid cells are contested, and their parts.

namespace Morula
{
  namespace
  {
    using DisjointSets = boost::disjoint_sets_with_storage<>;

    template <int dim>
    bool
    touch(const GridIndex<dim> &a, const GridIndex<dim> &b)
    {
      for (unsigned int d = 0; d < dim; ++d)
        if (std::abs(a[d] - b[d]) > 1)
          return false;
      return true;
    }

    template <typename T>
    void
    make_unique(std::vector<T> &list)
    {
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
    }

    /** A token is a cell in a grid cell that it reaches, or that has a patch in
     *  front of the cell. Tokens are sorted by cell, and those of a cell by
     * grid cell. */
    class Tokens
    {
    public:
      /** @param near whether a grid cell counts, by number
       *  @param owners of patches: places in the list of cells, by id */
      template <int dim>
      Tokens(
        const std::vector<char>                                       &near,
        const GridBox<dim>                                            &box,
        const std::vector<PartedCell<dim>>                            &cells,
        const std::vector<PartedPatch<dim>>                           &patches,
        const std::unordered_map<types::particle_index, unsigned int> &owners)
      {
        std::vector<std::vector<unsigned int>> reached(cells.size());
        for (unsigned int p = 0; p < cells.size(); ++p)
          box.for_overlap(box.locate(cells[p].lower),
                          box.locate(cells[p].upper),
                          [&](const unsigned int there, const auto &) {
                            if (near[there])
                              reached[p].push_back(there);
                          });
        for (const PartedPatch<dim> &patch : patches)
          if (const auto owner = owners.find(patch.id); owner != owners.end())
            if (const GridIndex<dim> index = box.locate(patch.x);
                box.contains(index) && near[box.number(index)])
              reached[owner->second].push_back(box.number(index));
        for (std::vector<unsigned int> &list : reached)
          {
            make_unique(list);
            number.insert(number.end(), list.begin(), list.end());
            begin.push_back(number.size());
          }
      }

      /** Unites the tokens that two cells have in the same grid cells. */
      void
      unite(const unsigned int p,
            const unsigned int q,
            DisjointSets      &sets) const
      {
        for (unsigned int i = begin[p], j = begin[q];
             i < begin[p + 1] && j < begin[q + 1];)
          if (number[i] == number[j])
            sets.union_set(i++, j++);
          else
            ++(number[i] < number[j] ? i : j);
      }

      /** All tokens, by grid cell and then by cell. */
      std::vector<unsigned int>
      by_grid_cell() const
      {
        std::vector<unsigned int> order(number.size());
        std::iota(order.begin(), order.end(), 0u);
        std::stable_sort(order.begin(),
                         order.end(),
                         [&](const unsigned int i, const unsigned int j) {
                           return number[i] < number[j];
                         });
        return order;
      }

      std::vector<unsigned int> begin = {0}; // of each cell's tokens
      std::vector<unsigned int> number;      // of their grid cells
    };
  } // namespace


  template <int dim>
  std::vector<unsigned int>
  contested_grid_cells(const GridBox<dim>                  &box,
                       const std::vector<PartedPatch<dim>> &patches,
                       const double                         overlap)
  {
    // Two patches are in the surroundings of one grid cell if theirs are at
    // most two apart. That grid cell is then among those which touch both.
    std::map<unsigned int, std::vector<unsigned int>> at;
    for (unsigned int i = 0; i < patches.size(); ++i)
      at[box.number(box.locate(patches[i].x))].push_back(i);
    const auto contest = [&](const PartedPatch<dim> &a,
                             const PartedPatch<dim> &b) {
      const double cosine = a.n * b.n;
      return a.body != b.body || (cosine < Parting<dim>::facing &&
                                  0.5 * ((b.n - a.n) * (a.x - b.x)) > -overlap);
    };
    const auto meet = [&](const std::vector<unsigned int> &here,
                          const std::vector<unsigned int> &there) {
      for (const unsigned int i : here)
        for (const unsigned int j : there)
          if (contest(patches[i], patches[j]))
            return true;
      return false;
    };
    std::vector<unsigned int> found;
    for (const auto &[number, list] : at)
      {
        const GridIndex<dim> here = box.index(number);
        box.for_neighbors(
          here, 2, [&](const unsigned int other, const GridIndex<dim> &there) {
            if (other < number || at.count(other) == 0 ||
                !meet(list, at.at(other)))
              return;
            box.for_neighbors(here,
                              1,
                              [&](const unsigned int    between,
                                  const GridIndex<dim> &index) {
                                if (touch(index, there))
                                  found.push_back(between);
                              });
          });
      }
    make_unique(found);
    return found;
  }


  template <int dim>
  void
  Parting<dim>::find_parts(const GridBox<dim>                  &box,
                           const std::vector<PartedCell<dim>>  &cells,
                           const std::vector<PartedPatch<dim>> &patches)
  {
    // The tokens of a grid cell that bonds connect are one part; in grid cells
    // that are not contested all of them are. Parts are numbered by their
    // lowest cell. A boundary point belongs to the part of its owner.
    std::vector<char> near(box.size(), 0);
    for (const unsigned int number : contested_)
      box.for_neighbors(box.index(number),
                        1,
                        [&](const unsigned int neighbor, const auto &) {
                          near[neighbor] = 1;
                        });
    const Tokens tokens(near, box, cells, patches, owners);
    DisjointSets sets(tokens.number.size());
    for (unsigned int p = 0; p < cells.size(); ++p)
      for (const unsigned int q : bonds[p])
        if (q > p)
          tokens.unite(p, q, sets);

    first_of_cells = tokens.begin;
    parts_of_cells.resize(tokens.number.size());
    std::map<unsigned int, unsigned int> of_root; // in one grid cell
    for (const unsigned int token : tokens.by_grid_cell())
      {
        const unsigned int number = tokens.number[token];
        if (parts.empty() || parts.back().first != number)
          of_root.clear();
        const unsigned int root =
          is_contested(number) ? sets.find_set(token) : 0;
        const auto [place, is_new] = of_root.emplace(root, parts.size());
        parts_of_cells[token]      = place->second;
        if (!is_new)
          continue;
        parts.emplace_back(number, of_root.size() - 1);
        if (parts.back().second > 0)
          further.push_back(parts.back());
      }
    link(box);
    for (const PartedPatch<dim> &patch : patches)
      if (const auto owner = owners.find(patch.id); owner != owners.end())
        if (const GridIndex<dim> index = box.locate(patch.x);
            box.contains(index))
          parts_of_patches.emplace(patch.id,
                                   part_of_cell(cells[owner->second].id,
                                                box.number(index)));
  }


  template <int dim>
  void
  Parting<dim>::link(const GridBox<dim> &box)
  {
    // Two parts of one cell, or of bonded cells, are linked where their grid
    // cells touch. A part has few others around it, but these are met again at
    // each of its cells: marks and short lists keep one of each.
    const auto can_link = [&](const GridCellPart &a, const GridCellPart &b) {
      return (is_contested(a.first) || is_contested(b.first)) &&
             touch(box.index(a.first), box.index(b.first));
    };
    const unsigned int                     n = parts.size();
    std::vector<std::vector<unsigned int>> known(n);
    std::vector<unsigned int>              last(n, bonds.size()), around;
    for (unsigned int p = 0; p < bonds.size(); ++p)
      {
        around.clear();
        const auto add_parts_of = [&](const unsigned int q) {
          for (unsigned int i = first_of_cells[q]; i < first_of_cells[q + 1];
               ++i)
            if (const unsigned int part = parts_of_cells[i]; last[part] != p)
              {
                last[part] = p;
                around.push_back(part);
              }
        };
        add_parts_of(p);
        const std::size_t n_own = around.size();
        for (const unsigned int q : bonds[p])
          add_parts_of(q);
        for (std::size_t i = 0; i < n_own; ++i)
          for (const unsigned int other : around)
            {
              std::vector<unsigned int> &list = known[around[i]];
              if (std::find(list.begin(), list.end(), other) == list.end())
                list.push_back(other);
            }
      }
    for (unsigned int part = 0; part < n; ++part)
      for (const unsigned int other : known[part])
        if (can_link(parts[part], parts[other]))
          links.emplace_back(parts[part], parts[other]);
    std::sort(links.begin(), links.end());
  }


#define INSTANTIATE(dim)                                   \
  template void Parting<dim>::find_parts(                  \
    const GridBox<dim> &,                                  \
    const std::vector<PartedCell<dim>> &,                  \
    const std::vector<PartedPatch<dim>> &);                \
  template std::vector<unsigned int> contested_grid_cells( \
    const GridBox<dim> &, const std::vector<PartedPatch<dim>> &, double);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
