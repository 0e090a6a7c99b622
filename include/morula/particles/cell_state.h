// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_cell_state_h
#define morula_particles_cell_state_h

#include <deal.II/base/array_view.h>
#include <deal.II/base/numbers.h>
#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <algorithm>
#include <cstdint>
#include <type_traits>

namespace Morula
{
  using namespace dealii;

  /**
   * Where the named quantities of a biological cell stand in its particle's
   * property array. Only the slots that the scene's effects need exist; the
   * others are `absent` and take no storage.
   */
  template <int dim>
  struct CellSlots
  {
    static constexpr unsigned int absent = numbers::invalid_unsigned_int;

    /** Slots of a scene with these effects. */
    CellSlots(const bool growing, const bool proliferating)
    {
      if (growing || proliferating)
        growth = add(dim * dim);
      if (proliferating)
        {
          parent        = add(1);
          generation    = add(1);
          phase         = add(1);
          event_time    = add(1);
          lineage_key   = add(2);
          division_axis = add(dim);
          growth_pre    = add(dim * dim);
        }
    }

    unsigned int n_slots = 0;

    /** Initial position of the founder, µm (dim). */
    unsigned int founder_position = add(dim);
    /** V⁰, µm^dim: the founder's, halved at every division. */
    unsigned int initial_volume = add(1);
    /** F, row by row (dim x dim). */
    unsigned int deformation = add(dim * dim);
    /** F_g at the time of the state (dim x dim). */
    unsigned int growth = absent;
    /** Id of the mother, -1 for founders. */
    unsigned int parent = absent;
    /** Number of divisions since the founder. */
    unsigned int generation = absent;
    /** A CyclePhase as a number. */
    unsigned int phase = absent;
    /** End of the G0 wait, or onset t_S of the running cycle, day. */
    unsigned int event_time = absent;
    /** The two 32-bit halves of the key of the random numbers (2). */
    unsigned int lineage_key = absent;
    /** n_s (dim). */
    unsigned int division_axis = absent;
    /** F_g of the cycle before the onset of S (dim x dim). */
    unsigned int growth_pre = absent;

  private:
    unsigned int
    add(const unsigned int size)
    {
      n_slots += size;
      return n_slots - size;
    }
  };

  /**
   * Named view on one particle's property array; does not own the data.
   * Number is `double` (may write) or `const double`.
   */
  template <int dim, typename Number>
  class CellView
  {
  public:
    CellView(const ArrayView<Number> &data, const CellSlots<dim> &slots)
      : data(data)
      , slots(slots)
    {}

    Point<dim>
    founder_position() const
    {
      Point<dim> X;
      for (unsigned int d = 0; d < dim; ++d)
        X[d] = data[slots.founder_position + d];
      return X;
    }

    double
    initial_volume() const
    {
      return data[slots.initial_volume];
    }

    Tensor<2, dim>
    deformation() const
    {
      return tensor(slots.deformation);
    }

    /** F_g; the identity where no effect grows. */
    Tensor<2, dim>
    growth() const
    {
      return slots.growth == CellSlots<dim>::absent ? identity() :
                                                      tensor(slots.growth);
    }

    int
    parent() const
    {
      return slots.parent == CellSlots<dim>::absent ?
               -1 :
               static_cast<int>(data[slots.parent]);
    }

    unsigned int
    generation() const
    {
      return slots.generation == CellSlots<dim>::absent ?
               0 :
               static_cast<unsigned int>(data[slots.generation]);
    }

    /** A scalar slot that must exist. */
    double
    scalar(const unsigned int slot) const
    {
      return data[slot];
    }

    /** Sets the number in a slot. */
    void
    set_scalar(const unsigned int slot, const double value) const
    {
      data[slot] = value;
    }

    /** The vector that begins in a slot. */
    Tensor<1, dim>
    vector(const unsigned int slot) const
    {
      Tensor<1, dim> v;
      for (unsigned int d = 0; d < dim; ++d)
        v[d] = data[slot + d];
      return v;
    }

    /** Sets the vector that begins in a slot. */
    void
    set_vector(const unsigned int slot, const Tensor<1, dim> &v) const
    {
      for (unsigned int d = 0; d < dim; ++d)
        data[slot + d] = v[d];
    }

    /** The tensor that begins in a slot, row by row. */
    Tensor<2, dim>
    tensor(const unsigned int slot) const
    {
      Tensor<2, dim> t;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          t[i][j] = data[slot + i * dim + j];
      return t;
    }

    /** Sets the tensor that begins in a slot. */
    void
    set_tensor(const unsigned int slot, const Tensor<2, dim> &t) const
    {
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          data[slot + i * dim + j] = t[i][j];
    }

    const CellSlots<dim> &
    layout() const
    {
      return slots;
    }

    ArrayView<Number>
    raw() const
    {
      return data;
    }

  private:
    static Tensor<2, dim>
    identity()
    {
      Tensor<2, dim> I;
      for (unsigned int d = 0; d < dim; ++d)
        I[d][d] = 1.;
      return I;
    }

    ArrayView<Number>     data;
    const CellSlots<dim> &slots;
  };

  /** V = V⁰ det F, µm^dim: doc/theory.md (1.2), equation (8) of the paper. */
  template <int dim, typename Number>
  double
  volume(const CellView<dim, Number> &cell)
  {
    return cell.initial_volume() * determinant(cell.deformation());
  }

  /** F_e = F F_g⁻¹, equation (1.3). */
  template <int dim, typename Number>
  Tensor<2, dim>
  elastic_deformation(const CellView<dim, Number> &cell)
  {
    return cell.deformation() * invert(cell.growth());
  }

  /** J_e = det F / det F_g. */
  template <int dim, typename Number>
  double
  elastic_volume_ratio(const CellView<dim, Number> &cell)
  {
    return determinant(cell.deformation()) / determinant(cell.growth());
  }

  /**
   * The property array of a boundary point: the same for every scene, followed
   * by those of its patch where the scene refines the surface.
   */
  template <int dim>
  struct BoundarySlots
  {
    /** Initial position X, µm. */
    static constexpr unsigned int initial_position = 0;
    /** Initial outward unit normal N. */
    static constexpr unsigned int initial_normal = dim;
    /** Initial area a⁰, µm^(dim-1). */
    static constexpr unsigned int initial_area = 2 * dim;
    /** A SurfaceCondition as a number. */
    static constexpr unsigned int condition = 2 * dim + 1;
    /** F, row by row. */
    static constexpr unsigned int deformation = 2 * dim + 2;
    static constexpr unsigned int n_slots     = 2 * dim + 2 + dim * dim;

    // Only where the scene refines the surface:
    /** Initial position of the point of t = 0 that this one is a part of, µm.
     */
    static constexpr unsigned int seed_position = n_slots;
    /** The patch's dim-1 tangential edges in the initial configuration, one
     *  after the other, µm. They span a⁰. */
    static constexpr unsigned int edges = n_slots + dim;
    static constexpr unsigned int n_slots_with_patch =
      n_slots + dim + (dim - 1) * dim;
  };

  /** What holds or loads a boundary point; numbers as in surface-NNNN.csv. */
  enum class SurfaceCondition
  {
    free   = 0,
    fixed  = 1,
    slip   = 2,
    loaded = 3
  };
} // namespace Morula

#endif
