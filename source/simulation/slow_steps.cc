// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/near_tree.h>
#include <morula/particles/nearest.h>
#include <morula/simulation/slow_steps.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace Morula
{
  namespace
  {
    /** The drag that tissue is first held back with, and at most: it resists a
     *  motion by h with a stress of about E, or a hundred times that. */
    constexpr double first_drag = 1e4, strongest_drag = 1e6;

    /** How much stronger it is after a step that has failed, and weaker after
     *  one in which cells move by less than the short way, in units of h. */
    constexpr double stronger = 2., weaker = 0.3, short_way = 0.1;

    /** The cosine of the largest turn of tissue, 36°: two points that did not
     *  face each other, whose normals' product was above -0.3, do not look at
     *  each other straight after both have turned by less. */
    constexpr double straight_on = 0.8;

    /** The least |f - I| of tissue that has turned so far, and how much of it
     *  counts, in h^dim: single cells at the end of a fold may turn. */
    constexpr double least_change = 0.5, strand = 0.3;

    /** The cosine of the angle by which f = R U turns, from the trace of R. */
    template <int dim>
    double
    cosine_of_turn(const Tensor<2, dim> &f)
    {
      double trace = 0.;
      for (const auto &[square, e] : eigenvectors(symmetrize(transpose(f) * f)))
        trace += e * (f * e) / std::sqrt(square);
      return dim == 2 ? 0.5 * trace : 0.5 * (trace - 1.);
    }
  } // namespace


  bool
  hold_back(double &drag)
  {
    if (drag >= strongest_drag)
      return false;
    drag = drag == 1. ? first_drag : std::min(strongest_drag, stronger * drag);
    return true;
  }


  template <int dim>
  void
  let_go(const Tissue<dim>            &tissue,
         const DisplacementField<dim> &displacement,
         double                       &drag)
  {
    double longest = 0.;
    for (const Tensor<1, dim> &way : displacement.values_at(tissue.cells()))
      longest = std::max(longest, way.norm());
    if (Utilities::MPI::max(longest, tissue.communicator()) <=
        short_way * tissue.grid().box().spacing())
      drag = std::max(1., weaker * drag);
  }


  template <int dim>
  bool
  turns_too_far(const Tissue<dim>            &tissue,
                const DisplacementField<dim> &displacement)
  {
    // Cells tell how the tissue turns, as boundary points beyond the last ones
    // see an extrapolated field. Of cells that turn those within h around are
    // taken together, so that a few do not count.
    const Cells<dim>       &cells = tissue.cells();
    const double            h     = tissue.grid().box().spacing();
    std::vector<double>     turned(cells.size(), 0.); // volume, µm^dim
    std::vector<Point<dim>> queries;
    displacement.at_points(
      cells,
      [&](const unsigned int       p,
          const LocalField<dim>   &field,
          const SplineValues<dim> &splines) {
        const Tensor<2, dim> f = field.step_deformation(splines);
        if ((f - Tensor<2, dim>(unit_symmetric_tensor<dim>())).norm() <
              least_change ||
            cosine_of_turn(f) > straight_on)
          return;
        turned[p] = cells.volume(p);
        queries.push_back(cells.position(p));
      });
    const auto numbers = [&](const unsigned int p, std::vector<double> &list) {
      list.push_back(turned[p]);
    };
    const PointList<dim> near = near_points(
      queries, cells, {1, numbers, Ties::lowest_id}, tissue.grid(), 1);
    const NearTree<dim> tree(near.positions);
    double              largest = 0.;
    for (const Point<dim> &x : queries)
      {
        double volume = 0.;
        for (const unsigned int i : tree.within(x, h))
          volume += near.row(i)[0];
        largest = std::max(largest, volume);
      }
    return Utilities::MPI::max(largest, tissue.communicator()) >
           strand * Utilities::fixed_power<dim>(h);
  }


  MORULA_INSTANTIATE(let_go);
  MORULA_INSTANTIATE(turns_too_far);
} // namespace Morula
