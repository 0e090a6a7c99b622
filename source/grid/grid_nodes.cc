// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/grid/grid_nodes.h>

namespace Morula
{
  template <int dim>
  GridNodes<dim>::GridNodes(const GridWindow<dim>    &window,
                            const SharedParting<dim> &parting)
    : boxes(window.boxes())
    , whole(window.whole())
    , parting_(parting)
  {
    // Without a contested grid cell there are no tables at all. Otherwise the
    // further parts of the window's grid cells get nodes in the order in which
    // the parting has them, those of one grid cell behind each other.
    if (parting_ == nullptr || parting_->is_trivial())
      return;
    first_further.assign(boxes.size(), 0);
    near_contest.assign(boxes.size(), 0);
    for (const auto &[number, part] : parting_->further_parts())
      if (const GridIndex<dim> index = whole.index(number);
          boxes.contains(index))
        {
          const unsigned int here = boxes.number(index);
          if (part == 1)
            first_further[here] = size();
          further.push_back({here, part});
        }
    for (unsigned int number = 0; number < boxes.size(); ++number)
      if (parting_->is_contested(whole.number(boxes.index(number))))
        boxes.for_neighbors(boxes.index(number),
                            1,
                            [&](const unsigned int neighbor, const auto &) {
                              near_contest[neighbor] = 1;
                            });
    find_linked();
  }


  template <int dim>
  void
  GridNodes<dim>::find_linked()
  {
    // Each spline asks for the links of its support, and supports overlap: so
    // links are looked up once for each node.
    first_linked.assign(1, 0);
    for (unsigned int node = 0; node < size(); ++node)
      {
        if (near_contest[grid_cell(node)])
          boxes.for_neighbors(
            index(node), 1, [&](const unsigned int number, const auto &) {
              for_parts(number, [&](const unsigned int other) {
                if (are_linked(node, other))
                  linked.push_back(other);
              });
            });
        first_linked.push_back(linked.size());
      }
  }


  template class GridNodes<2>;
  template class GridNodes<3>;
} // namespace Morula
