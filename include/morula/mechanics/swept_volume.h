// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_swept_volume_h
#define morula_mechanics_swept_volume_h

#include <morula/mechanics/point_term.h>

#include <vector>

namespace Morula
{
  /**
   * The volume that a space enclosed by boundary points gains in a step:
   * doc/theory.md (4.8h). Its "energy" is this volume (µm^dim), its "residual"
   * the first derivative (µm^(dim-1)), its "tangent" the second (µm^(dim-2)).
   * It is not itself a term of the momentum balance, which multiplies it by the
   * pressure of the content.
   */
  template <int dim>
  class SweptVolume : public PointTerm<dim>
  {
  public:
    /** @param areas a_t n_t of the points, out of the tissue and so into the
     *         space; µm^(dim-1) */
    SweptVolume(GroupedPoints<dim> points, std::vector<Tensor<1, dim>> areas);

  private:
    void
    add_point(const unsigned int       p,
              const SplineValues<dim> &splines,
              const LocalField<dim>   &field,
              LocalSystem<dim>        &system) const override;

    const std::vector<Tensor<1, dim>> areas;
  };
} // namespace Morula

#endif
