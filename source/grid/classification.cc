// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/grid/bspline.h>
#include <morula/grid/classification.h>

namespace Morula
{
  namespace
  {
    /** Whether an active grid cell is inner. */
    template <int dim>
    bool
    is_inner(const Occupancy<dim> &occupancy,
             const unsigned int    number,
             const double          occupation_parameter)
    {
      // Thin tissue goes first, as there only one grid cell of each thin row
      // may be inner. Then doc/theory.md (3.2): the threshold is measured by
      // the fullest neighbour that could be inner itself, so that sheets and
      // small clusters, which fill no grid cell, have inner ones. Last, there
      // must be enough quadrature points that the splines can be told apart.
      // All numbers are those of the window, which has seen the sums over all
      // ranks.
      const bool thin = occupancy.is_thin(number);
      if (thin && !occupancy.is_inner_candidate(number))
        return false;
      double       largest  = 0.;
      unsigned int n_points = 0;
      occupancy.nodes().for_linked(
        number, [&](const unsigned int neighbor, const auto &) {
          if (!thin || occupancy.is_inner_candidate(neighbor))
            largest = std::max(largest, occupancy.fill(neighbor));
          n_points += occupancy.n_quadrature_points(neighbor);
        });
      // 1e-9 absorbs the rounding of the product, as fills are exact multiples
      // of 2⁻⁴⁰.
      const double threshold = occupation_parameter * std::min(1., largest);
      return occupancy.fill(number) >= threshold - 1e-9 &&
             (thin || occupancy.n_quadrature_points(number) >= (1u << dim)) &&
             n_points >= BSpline<dim>::n;
    }
  } // namespace

  template <int dim>
  std::vector<GridCellClass>
  classify(const Occupancy<dim> &occupancy, const double occupation_parameter)
  {
    // Only grid cells far enough inside of the window get a class: the others'
    // neighbours are not known here. For them other ranks find it.
    std::vector<GridCellClass> classes(occupancy.nodes().size(),
                                       GridCellClass::empty);
    const auto                 set_class = [&](const unsigned int number) {
      if (!occupancy.active(number))
        {
          if (occupancy.fill(number) > 0.)
            classes[number] = GridCellClass::reached;
        }
      else
        classes[number] = is_inner(occupancy, number, occupation_parameter) ?
                                            GridCellClass::inner :
                                            GridCellClass::cut;
    };
    for (const GridRange<dim> &known :
         occupancy.window().inner(reach_of_classes<dim>()))
      occupancy.boxes().for_range(known,
                                  [&](const unsigned int number, const auto &) {
                                    occupancy.nodes().for_parts(number,
                                                                set_class);
                                  });
    return classes;
  }

  MORULA_INSTANTIATE(classify);
} // namespace Morula
