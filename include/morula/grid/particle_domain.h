// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_particle_domain_h
#define morula_grid_particle_domain_h

#include <deal.II/base/point.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace Morula
{
  using namespace dealii;

  /** A bound of the largest singular value of A, which needs no eigenvalues:
   *  the largest one of a symmetric tensor S is at most tr S/d + √((d-1)/d)
   *  |dev S|. Exact in 2-D, and where two of three are equal. */
  template <int dim>
  double
  largest_stretch_bound(const Tensor<2, dim> &A)
  {
    // S = A Aᵀ is summed entry by entry, without tensors: this is asked of each
    // cell after each step.
    constexpr double rounding = 1e-9;
    const double     mean     = A.norm_square() / dim;
    double           dev      = 0.; // |dev S|²
    for (unsigned int i = 0; i < dim; ++i)
      {
        dev += std::pow(A[i].norm_square() - mean, 2);
        for (unsigned int j = 0; j < i; ++j)
          dev += 2. * std::pow(A[i] * A[j], 2);
      }
    return (1. + rounding) *
           std::sqrt(mean + std::sqrt((dim - 1.) / dim * dev));
  }

  /**
   * The box x + A ξ, ξ in [-1/2, 1/2]^dim, that a cell occupies, and its
   * quadrature points. By default there is one, in the middle. There are
   * several per edge if the scene asks for them, or if the edge is longer than
   * half a grid spacing: otherwise a full grid cell could hold no point at all.
   */
  template <int dim>
  class ParticleDomain
  {
  public:
    /** Quadrature points along each edge. */
    using Numbers = std::array<unsigned int, dim>;

    /**
     * An axis-parallel cube.
     * @param x position, µm
     * @param V current volume, µm^dim
     */
    ParticleDomain(const Point<dim> &x, const double V)
      : x(x)
      , V(V)
      , side_(std::pow(V, 1. / dim))
    {
      for (unsigned int d = 0; d < dim; ++d)
        edges[d][d] = side_;
    }

    /**
     * A parallelepiped.
     * @param edges A: its edges, as columns, µm
     */
    ParticleDomain(const Point<dim> &x, const Tensor<2, dim> &edges)
      : x(x)
      , V(determinant(edges))
      , side_(std::pow(V, 1. / dim))
      , edges(edges)
    {
      const double limit = longest_edge * side_;
      for (unsigned int k = 0; k < dim; ++k)
        if (const double length = edge_length(k); length > limit)
          for (unsigned int d = 0; d < dim; ++d)
            this->edges[d][k] *= limit / length;
    }

    const Point<dim> &
    position() const
    {
      return x;
    }

    /** A: its edges, as columns, µm. */
    const Tensor<2, dim> &
    edge_vectors() const
    {
      return edges;
    }

    /** V, µm^dim. */
    double
    volume() const
    {
      return V;
    }

    /** V^(1/dim), µm. */
    double
    side() const
    {
      return side_;
    }

    /** The length of the cell in its longest direction, which is the largest
     *  singular value of A, µm. */
    double
    length() const
    {
      const SymmetricTensor<2, dim> square =
        symmetrize(edges * transpose(edges));
      const double largest = eigenvalues(square)[0];
      // eigenvalues() may return NaN for a nearly isotropic tensor.
      return std::sqrt(std::isfinite(largest) ? largest : trace(square) / dim);
    }

    /**
     * Lower corner of the axis-parallel cube of the same volume, over which the
     * volume is spread. To cut a parallelepiped at grid lines would cost more
     * and gain nothing: for tissue stretched by 3.7, a box with the domain's
     * own widths gave the same results within their scatter.
     */
    Point<dim>
    lower() const
    {
      return corner(-0.5);
    }

    /** Upper corner of that cube. */
    Point<dim>
    upper() const
    {
      return corner(0.5);
    }

    /** The smallest axis-parallel box around the domain and the cube. */
    std::pair<Point<dim>, Point<dim>>
    bounds() const
    {
      Point<dim> least = lower(), greatest = upper();
      for (unsigned int d = 0; d < dim; ++d)
        {
          double half = 0.;
          for (unsigned int k = 0; k < dim; ++k)
            half += std::abs(edges[d][k]) / 2.;
          least[d]    = std::min(least[d], x[d] - half);
          greatest[d] = std::max(greatest[d], x[d] + half);
        }
      return {least, greatest};
    }

    /** Number of quadrature points along each edge, at least @p least, on a
     *  grid of spacing @p h (µm): doc/theory.md (2.2). */
    Numbers
    n_per_edge(const double h, const unsigned int least) const
    {
      Numbers n;
      for (unsigned int k = 0; k < dim; ++k)
        n[k] = std::max(
          {least, n_on_length(side_, h), n_on_length(edge_length(k), h)});
      return n;
    }

    /** Calls @p visit(position) for all quadrature points, the first edge
     *  fastest. */
    template <typename Visitor>
    void
    for_quadrature_points(const Numbers &n, const Visitor &visit) const
    {
      unsigned int n_points = 1;
      for (const unsigned int n_k : n)
        n_points *= n_k;
      for (unsigned int q = 0; q < n_points; ++q)
        {
          Point<dim>   point = x;
          unsigned int rest  = q;
          for (unsigned int k = 0; k < dim; ++k)
            {
              const double xi = (rest % n[k] + 0.5) / n[k] - 0.5;
              for (unsigned int d = 0; d < dim; ++d)
                point[d] += edges[d][k] * xi;
              rest /= n[k];
            }
          visit(point);
        }
    }

  private:
    /** Longest edge, in sides. Longer edges are shortened to it: such a
     *  deformation gradient is that of a point that has lost its surroundings.
     */
    static constexpr double longest_edge = 16.;

    /** Two points per grid spacing. */
    static unsigned int
    n_on_length(const double length, const double h)
    {
      return static_cast<unsigned int>(
        std::ceil(std::max(2. * length / h - 1e-9, 1e-9)));
    }

    double
    edge_length(const unsigned int k) const
    {
      double square = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        square += edges[d][k] * edges[d][k];
      return std::sqrt(square);
    }

    Point<dim>
    corner(const double part) const
    {
      Point<dim> point = x;
      for (unsigned int d = 0; d < dim; ++d)
        point[d] += part * side_;
      return point;
    }

    const Point<dim> x;
    const double     V, side_;
    Tensor<2, dim>   edges;
  };

  /** A cube and how it is deformed: a ParticleDomain whose place does not
   *  matter yet. Most passes over cells need bounds alone, which spare the root
   *  of the volume. */
  template <int dim>
  struct DeformedCube
  {
    /** The volume of the cube, µm^dim. */
    double         volume;
    Tensor<2, dim> deformation;

    /** The domain at @p x, µm. */
    ParticleDomain<dim>
    at(const Point<dim> &x) const
    {
      return {x, std::pow(volume, 1. / dim) * deformation};
    }

    /** Whether ParticleDomain::length() is at most @p length, µm. False may
     *  also be said of a cell that is a little shorter, or whose domain has
     *  shortened edges. */
    bool
    is_within_length(const double length) const
    {
      const auto power = [](const double base) {
        return dim == 2 ? base * base : base * base * base;
      };
      return volume * power(largest_stretch_bound(deformation)) <=
             power(length);
    }

    /** Whether ParticleDomain::bounds() reach at most @p distance from x, µm;
     *  false may be said as above. Half a diagonal is √d/2 lengths. */
    bool
    is_within(const double distance) const
    {
      return is_within_length(2. / std::sqrt(1. * dim) * distance);
    }
  };
} // namespace Morula

#endif
