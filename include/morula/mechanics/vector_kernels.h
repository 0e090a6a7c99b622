// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_vector_kernels_h
#define morula_mechanics_vector_kernels_h

#include <string>
#include <vector>

// Included by files that are compiled for one instruction set: no header with
// inline functions that the linker could merge with those of other files.

namespace Morula
{
  /** The form of ln J_e in the volumetric part of the energy (doc/theory.md,
   *  section 2). */
  enum class VolumetricStrain
  {
    /** ln J_e of the point itself. */
    pointwise,
    /** That of its pool: like points of a grid cell have one. */
    pooled
  };

  /**
   * The particles of one grid cell or pool, as MaterialPoints and ElasticState
   * store them, and the 3^dim coefficients of each component of the
   * displacement.
   */
  struct KernelInput
  {
    unsigned int  n;
    const double *xi;          // dim for each point
    const double *states;      // for each point: A row by row, W
    const double *lame;        // λ, μ
    unsigned int  lame_stride; // 2, or 0 if they are the same for all points
    double        h;           // µm
    const double *coefficients;
    const void   *law;     // of the material that the kernels were made for
    const double *carried; // c by point, µm^dim; read if pooled
  };

  /** The volume of a pool and its derivative: doc/theory.md (2.6), or (2.8b) if
   *  it is under pressure. */
  struct KernelVolume
  {
    bool    pressed   = false;
    double  v         = 0.;      // Σ c det f; pressed: Σ c ln det f
    double *gradients = nullptr; // Σ c det f g, dim 3^dim values by component;
                                 // pressed: Σ c g
  };

  /** What the tangent at points needs of their pool. */
  struct PressureOfPool
  {
    /** q, kPa. */
    double mean_stress;
    /** Whether it is under pressure as the step begins. */
    bool pressed;
  };

  /** The result of a kernel. */
  struct KernelResult
  {
    double       smallest_J = 0.; // J_e, or det f where that is not positive
    unsigned int at         = 0;  // index of that point
    double       energy     = 0.;
    double       energy_magnitude = 0.;
  };

  /** Two rows of numbers by spline whose outer product is added to a matrix,
   *  with zeros behind the last of the 3^dim. */
  template <int dimension>
  struct SplineProduct
  {
    static constexpr int          dim   = dimension;
    static constexpr unsigned int width = dim == 2 ? 16 : 32;
    using Real                          = double;
    using Rows                          = double[2][width];

    alignas(64) Rows factors; // the left one, the right one
  };

  /** Adds the sum of n products to a block of 3^dim rows, which begin @p stride
   *  numbers apart. */
  template <int dim>
  using AddProducts = void (*)(const SplineProduct<dim> *products,
                               const unsigned int        n,
                               double                   *block,
                               const unsigned int        stride);

  /** The displacement u (µm) and the step's deformation f = I + ∇u of points of
   *  a grid cell: for each point u, and f row by row. Of the input only xi, h,
   *  n and the coefficients are read. */
  using FindMotions = void (*)(const KernelInput &input, double *motions);

  /**
   * The terms of InternalForce for all the particles of a grid cell at once,
   * for one law and one instruction set (doc/performance.md). Add nothing if a
   * point is inverted.
   */
  template <int dim>
  struct VectorKernels
  {
    const char *name;

    /** Adds to the residual, dim 3^dim values by component, and, if not null,
     *  to the sums of the magnitudes of its contributions. If @p volume is not
     *  null, adds the pool's volume to that, and leaves the volumetric part of
     *  the law out of all else. */
    KernelResult (*residual)(const KernelInput &input,
                             double            *residual,
                             double            *magnitudes,
                             KernelVolume      *volume);

    /** Adds to the tangent row by row. If @p pressure is not null, that is
     *  the pool's, and the product V_a V_b in doc/theory.md (2.8) is left out.
     */
    KernelResult (*tangent)(const KernelInput    &input,
                            const PressureOfPool *pressure,
                            double               *matrix);

    /** As tangent(), with products and their sums in single precision: to 10⁻⁶
     *  of the largest entry, in less time. */
    KernelResult (*tangent_in_single)(const KernelInput    &input,
                                      const PressureOfPool *pressure,
                                      double               *matrix);

    /** Adds products of splines, for other terms' tangents. */
    AddProducts<dim> add_products;

    /** Finds motions of points, for what moves with the tissue. */
    FindMotions find_motions;
  };

  /** The kernels for law number @p law of the library's list that this
   *  processor can run, the fastest first. */
  template <int dim>
  std::vector<VectorKernels<dim>>
  available_vector_kernels(const unsigned int law);
} // namespace Morula

#endif
