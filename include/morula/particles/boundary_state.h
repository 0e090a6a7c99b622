// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_boundary_state_h
#define morula_particles_boundary_state_h

#include <morula/particles/cell_state.h>

#include <deal.II/particles/particle_iterator.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace Morula
{
  /** Named view on a boundary point's property array; does not own the data. */
  template <int dim>
  class BoundaryView
  {
  public:
    explicit BoundaryView(const ArrayView<const double> &data)
      : data(data)
    {}

    /** X, µm. */
    Point<dim>
    initial_position() const
    {
      return Point<dim>(vector(BoundarySlots<dim>::initial_position));
    }

    /** N. */
    Tensor<1, dim>
    initial_normal() const
    {
      return vector(BoundarySlots<dim>::initial_normal);
    }

    /** a⁰, µm^(dim-1). */
    double
    initial_area() const
    {
      return data[BoundarySlots<dim>::initial_area];
    }

    SurfaceCondition
    condition() const
    {
      return static_cast<SurfaceCondition>(
        static_cast<int>(data[BoundarySlots<dim>::condition]));
    }

    /** F. */
    Tensor<2, dim>
    deformation() const
    {
      Tensor<2, dim> F;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          F[i][j] = data[BoundarySlots<dim>::deformation + i * dim + j];
      return F;
    }

    /** Whether the patch's edges are known: only where the scene refines the
     *  surface. */
    bool
    has_patch() const
    {
      return data.size() > BoundarySlots<dim>::n_slots;
    }

    /** Initial position of the point of t = 0 that this one is a part of, µm:
     *  its own unless the surface was refined. */
    Point<dim>
    seed_position() const
    {
      return Point<dim>(vector(has_patch() ?
                                 BoundarySlots<dim>::seed_position :
                                 BoundarySlots<dim>::initial_position));
    }

    /** Edge @p k of the patch in the initial configuration, µm. Only with
     *  has_patch(). */
    Tensor<1, dim>
    initial_edge(const unsigned int k) const
    {
      return vector(BoundarySlots<dim>::edges + k * dim);
    }

    /**
     * The point's distance to its neighbours, µm: the side of a square as large
     * as the patch; where the patch is known, that of the square around the
     * circle which encloses it.
     */
    double
    spacing() const
    {
      const Tensor<2, dim> F = deformation();
      if (!has_patch())
        return std::pow(area_vector().norm(), 1. / (dim - 1));
      const Tensor<1, dim> first = F * initial_edge(0);
      if (dim == 2)
        return first.norm();
      const Tensor<1, dim> second = F * initial_edge(dim - 2);
      return std::max((first + second).norm(), (first - second).norm()) /
             std::sqrt(2.);
    }

    /** a n = det F F⁻ᵀ a⁰ N: doc/theory.md (1.2), equation (11) of the paper.
     */
    Tensor<1, dim>
    area_vector() const
    {
      const Tensor<2, dim> F = deformation();
      return determinant(F) * initial_area() * (initial_normal() * invert(F));
    }

  private:
    Tensor<1, dim>
    vector(const unsigned int slot) const
    {
      Tensor<1, dim> v;
      for (unsigned int d = 0; d < dim; ++d)
        v[d] = data[slot + d];
      return v;
    }

    ArrayView<const double> data;
  };

  /** The property array of a boundary point in its ParticleHandler. */
  template <int dim>
  ArrayView<const double>
  boundary_properties(const Particles::ParticleIterator<dim> &point)
  {
    const Particles::ParticleAccessor<dim> &accessor = *point;
    return accessor.get_properties();
  }

  /** Properties at t = 0. */
  template <int dim>
  std::vector<double>
  initial_boundary_slots(const Point<dim>      &X,
                         const Tensor<1, dim>  &N,
                         const double           area,
                         const SurfaceCondition condition)
  {
    using Slots = BoundarySlots<dim>;
    std::vector<double> slots(Slots::n_slots, 0.);
    for (unsigned int d = 0; d < dim; ++d)
      {
        slots[Slots::initial_position + d]        = X[d];
        slots[Slots::initial_normal + d]          = N[d];
        slots[Slots::deformation + d * (dim + 1)] = 1.;
      }
    slots[Slots::initial_area] = area;
    slots[Slots::condition]    = static_cast<int>(condition);
    return slots;
  }

  /** F -> f F: doc/theory.md (1.1), equation (10) of the paper. */
  template <int dim>
  void
  deform_boundary_point(const ArrayView<double> &properties,
                        const Tensor<2, dim>    &f)
  {
    const Tensor<2, dim> F = f * BoundaryView<dim>(properties).deformation();
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        properties[BoundarySlots<dim>::deformation + i * dim + j] = F[i][j];
  }
} // namespace Morula

#endif
