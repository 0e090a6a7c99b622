// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/particles/boundary_state.h>

#include <deal.II/base/symmetric_tensor.h>

namespace Morula
{
  namespace
  {
    /** An orthonormal basis of the plane normal to @p N (2-D: line). */
    template <int dim>
    std::array<Tensor<1, dim>, dim - 1>
    tangents(const Tensor<1, dim> &N)
    {
      if constexpr (dim == 2)
        return {{cross_product_2d(N)}};
      else
        {
          // The axis that is the most tangential gives the first tangent, so
          // that the difference is never short.
          unsigned int axis = 0;
          for (unsigned int d = 1; d < dim; ++d)
            if (std::abs(N[d]) < std::abs(N[axis]))
              axis = d;
          Tensor<1, dim> first = -N[axis] * N;
          first[axis] += 1.;
          first /= first.norm();
          return {{first, cross_product_3d(N, first)}};
        }
    }
  } // namespace

  template <int dim>
  void
  BoundaryColumns<dim>::need_bodies(const bool fuses, const bool with_parts)
  {
    // Body and pressure are columns of every scene with contact; the part and
    // the time of touch only of those that ask for them. Both halves of a point
    // that is split have its values. Who asks twice gets nothing more.
    if (body.exists())
      return;
    body             = add<unsigned int>({"body",
                                          "",
                                          "number of the body that the point belongs to",
                                          0,
                                          AtDivision::copied,
                                          true});
    contact_pressure = add<double>({"contact_pressure",
                                    "kPa",
                                    "pressure of other bodies, averaged over a "
                                    "grid spacing",
                                    0.,
                                    AtDivision::copied,
                                    true});
    if (with_parts)
      part =
        add<unsigned int>({"part", "", "number of the part of its grid cell"});
    if (fuses)
      contact_age = add<double>({"contact_age",
                                 "day",
                                 "time for which another body has touched the "
                                 "point without a break",
                                 0.,
                                 AtDivision::copied,
                                 true});
  }

  template <int dim>
  BoundaryColumns<dim>::BoundaryColumns(const bool with_patch,
                                        const bool coarsens,
                                        const bool with_force)
  {
    // All scenes have these columns.
    initial_position =
      add<Point<dim>>({"initial_position", "um", "position at t = 0"});
    initial_normal =
      add<Tensor<1, dim>>({"initial_normal", "", "outward normal at t = 0"});
    initial_area = add<double>(
      {"initial_area", "um^" + std::to_string(dim - 1), "area at t = 0"});
    condition = add<SurfaceCondition>({"condition",
                                       "",
                                       "what holds or loads the point",
                                       SurfaceCondition::free});
    deformation =
      add<Tensor<2, dim>>({"deformation",
                           "",
                           "deformation gradient F since t = 0",
                           Tensor<2, dim>(unit_symmetric_tensor<dim>())});
    if (with_force)
      force = add<Tensor<1, dim>>({"force",
                                   dim == 3 ? "kPa um^2" : "kPa um",
                                   "force of the conditions on the tissue",
                                   Tensor<1, dim>(),
                                   AtDivision::copied,
                                   true});
    // The columns of a patch exist only if the scene refines the surface, the
    // last one only if it coarsens it: no other scene stores them.
    if (!with_patch)
      return;
    seed_position =
      add<Point<dim>>({"seed_position",
                       "um",
                       "initial position of the point of t = 0 that this one "
                       "is a part of"});
    for (unsigned int k = 0; k < dim - 1; ++k)
      edges[k] = add<Tensor<1, dim>>(
        {"edge_" + std::to_string(k + 1), "um", "edge of the patch at t = 0"});
    if (coarsens)
      reference_area = add<double>({"reference_area",
                                    "um^" + std::to_string(dim - 1),
                                    "area that the patch shall have"});
  }

  template <int dim>
  std::vector<double>
  BoundaryColumns<dim>::initial_point(const Point<dim>      &X,
                                      const Tensor<1, dim>  &N,
                                      const double           area,
                                      const SurfaceCondition condition) const
  {
    std::vector<double>             row = this->initial_row();
    const BoundaryView<dim, double> point(make_array_view(row), *this);
    point.set(initial_position, X);
    point.set(initial_normal, N);
    point.set(initial_area, area);
    point.set(this->condition, condition);
    // The patch is a square of the point's area in the tangent plane.
    if (point.has_patch())
      {
        const double side = std::pow(area, 1. / (dim - 1));
        point.set(seed_position, X);
        for (unsigned int k = 0; k < dim - 1; ++k)
          point.set(edges[k], side * tangents(N)[k]);
        if (reference_area.exists())
          point.set(reference_area, area);
      }
    return row;
  }

  template <int dim>
  void
  BoundaryColumns<dim>::set_square_patch(const ArrayView<double> &row,
                                         const Tensor<2, dim>    &F,
                                         const Tensor<1, dim>    &area) const
  {
    // The present area vector and F determine the initial ones by doc/theory.md
    // (1.2), solved for a⁰ N. The edges are square in the present
    // configuration; F⁻¹ takes them back to the initial one.
    const BoundaryView<dim, double> point(row, *this);
    const Tensor<2, dim>            back    = invert(F);
    const Tensor<1, dim>            initial = // (1.2), the other way round
      determinant(back) * (area * F);
    const double side = std::pow(area.norm(), 1. / (dim - 1));
    point.set(deformation, F);
    point.set(initial_area, initial.norm());
    point.set(initial_normal, initial / initial.norm());
    if (point.has_patch())
      for (unsigned int k = 0; k < dim - 1; ++k)
        point.set(edges[k], side * (back * tangents(area / area.norm())[k]));
  }

  template class BoundaryColumns<2>;
  template class BoundaryColumns<3>;
} // namespace Morula
