// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/particles/nearest.h>
#include <morula/simulation/slow_steps.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
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
    constexpr double stronger = 5., weaker = 0.3, short_way = 0.1;

    /** The cosine of the largest turn of a normal, 36°: two points that did not
     *  face each other, whose normals' product was above -0.3, do not look at
     *  each other straight after both have turned by less. */
    constexpr double straight_on = 0.8;
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
    displacement.at_points(tissue.cells(),
                           [&](const unsigned int,
                               const LocalField<dim>   &field,
                               const SplineValues<dim> &splines) {
                             longest =
                               std::max(longest, field.value(splines).norm());
                           });
    if (Utilities::MPI::max(longest, tissue.communicator()) <=
        short_way * tissue.grid().box().spacing())
      drag = std::max(1., weaker * drag);
  }


  template <int dim>
  bool
  turns_too_far(const Tissue<dim>            &tissue,
                const DisplacementField<dim> &displacement)
  {
    // Normals turn with the cofactor of the step's deformation, doc/theory.md
    // (1.2). At the end of a fold single patches may turn at any time. A strand
    // that turns has more of them: within h around a point they make up a piece
    // of surface as large as h^(dim-1).
    const BoundaryPoints<dim> &store = tissue.boundary_points();
    const double               h     = tissue.grid().box().spacing();
    std::vector<double>        turned(store.size(), 0.); // area, µm^(dim-1)
    std::vector<Point<dim>>    queries;
    displacement.at_points(store,
                           [&](const unsigned int       p,
                               const LocalField<dim>   &field,
                               const SplineValues<dim> &splines) {
                             const Tensor<1, dim> area = store.area_vector(p);
                             const Tensor<1, dim> now =
                               area * invert(field.step_deformation(splines));
                             if (area * now >
                                 straight_on * area.norm() * now.norm())
                               return;
                             turned[p] = area.norm();
                             queries.push_back(store.position(p));
                           });
    const auto numbers = [&](const unsigned int p, std::vector<double> &list) {
      list.push_back(turned[p]);
    };
    const PointList<dim> near = near_points(
      queries, store, {1, numbers, Ties::lowest_id}, tissue.grid(), 1);
    double largest = 0.;
    for (const Point<dim> &x : queries)
      {
        double area = 0.;
        for (std::size_t i = 0; i < near.size(); ++i)
          if (x.distance(near.positions[i]) <= h)
            area += near.row(i)[0];
        largest = std::max(largest, area);
      }
    return Utilities::MPI::max(largest, tissue.communicator()) >
           Utilities::fixed_power<dim - 1>(h);
  }


#define INSTANTIATE(dim)                               \
  template void let_go(const Tissue<dim> &,            \
                       const DisplacementField<dim> &, \
                       double &);                      \
  template bool turns_too_far(const Tissue<dim> &,     \
                              const DisplacementField<dim> &);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
