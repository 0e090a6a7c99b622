// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef half_fixed_sphere_meridian_values_h
#define half_fixed_sphere_meridian_values_h

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <half-fixed-sphere/mesh.h>

#include <vector>

namespace HalfFixedSphere
{
  using namespace dealii;

  /**
   * The gradient in the basis (r, phi, z) of an axisymmetric vector field with
   * gradient @p g in the meridian plane and u_r / r = @p hoop.
   */
  inline Tensor<2, 3>
  axisymmetric_gradient(const Tensor<2, 2> &g, const double hoop)
  {
    Tensor<2, 3> result;
    result[0][0] = g[0][0];
    result[0][2] = g[0][1];
    result[1][1] = hoop;
    result[2][0] = g[1][0];
    result[2][2] = g[1][1];
    return result;
  }


  /**
   * Gauss points everywhere but next to the edge. There the material is
   * squeezed against the clamp, and an energy that looks at it only in the
   * middle of the grid cells lets it turn inside out between the points.
   * Points on the sides of the grid cells close that way.
   */
  struct QuadraturePair
  {
    QuadraturePair(const unsigned int degree, const unsigned int edge_points)
      : elsewhere(degree + 2)
      , near_edge(edge_points == 0 ?
                    Quadrature<2>(elsewhere) :
                    Quadrature<2>(QGaussLobatto<2>(edge_points)))
    {}

    const QGauss<2>     elsewhere;
    const Quadrature<2> near_edge;
  };


  /** FEValues of a field, mostly (u_r, u_z), with the quadrature of each grid
   * cell. */
  class MeridianValues
  {
  public:
    MeridianValues(const Mapping<2>       &mapping,
                   const FiniteElement<2> &element,
                   const QuadraturePair   &quadratures)
      : elsewhere(mapping, element, quadratures.elsewhere, flags)
      , near_edge(mapping, element, quadratures.near_edge, flags)
    {}

    void
    reinit(const DoFHandler<2>::active_cell_iterator &cell)
    {
      values = cell->material_id() == HalfFixedSphere::near_edge ? &near_edge :
                                                                   &elsewhere;
      values->reinit(cell);
    }

    unsigned int
    n_points() const
    {
      return values->n_quadrature_points;
    }

    /** Distance from the axis, um. */
    double
    r(const unsigned int q) const
    {
      return values->quadrature_point(q)[0];
    }

    /** The part of the body's initial volume that the point stands for, um^3:
     * the whole ring around the axis. */
    double
    volume(const unsigned int q) const
    {
      return 2. * numbers::PI * r(q) * values->JxW(q);
    }

    /** The gradient of shape function @p i. On the axis, which Gauss-Lobatto
     * points may lie on, u_r / r is du_r/dr; the volume there is zero. */
    Tensor<2, 3>
    gradient(const unsigned int i, const unsigned int q) const
    {
      const Tensor<2, 2> g = (*values)[meridian].gradient(i, q);
      return axisymmetric_gradient(
        g, r(q) > 0. ? (*values)[meridian].value(i, q)[0] / r(q) : g[0][0]);
    }

    /** Value and gradient in the meridian plane of the only component that
     * shape function @p i of any element has. */
    double
    value(const unsigned int i, const unsigned int q) const
    {
      return values->shape_value(i, q);
    }

    Tensor<1, 2>
    scalar_gradient(const unsigned int i, const unsigned int q) const
    {
      return values->shape_grad(i, q);
    }

    /** F at all points for the displacement @p u. */
    std::vector<Tensor<2, 3>>
    deformation(const Vector<double> &u) const
    {
      std::vector<Tensor<2, 2>> gradients(n_points());
      std::vector<Tensor<1, 2>> displacements(n_points());
      (*values)[meridian].get_function_gradients(u, gradients);
      (*values)[meridian].get_function_values(u, displacements);
      std::vector<Tensor<2, 3>> F(n_points());
      for (unsigned int q = 0; q < n_points(); ++q)
        F[q] = Tensor<2, 3>(unit_symmetric_tensor<3>()) +
               axisymmetric_gradient(gradients[q],
                                     r(q) > 0. ? displacements[q][0] / r(q) :
                                                 gradients[q][0][0]);
      return F;
    }

  private:
    static inline const UpdateFlags flags = update_values | update_gradients |
                                            update_quadrature_points |
                                            update_JxW_values;
    const FEValuesExtractors::Vector meridian = FEValuesExtractors::Vector(0);

    FEValues<2>  elsewhere, near_edge;
    FEValues<2> *values = nullptr;
  };
} // namespace HalfFixedSphere

#endif
