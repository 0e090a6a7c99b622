// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_materials_h
#define morula_tests_materials_h

#include <morula/mechanics/elastic_point.h>
#include <morula/mechanics/materials/material.h>

namespace Morula
{
  /** The material of most tests. */
  inline const Material &
  neo_hookean()
  {
    static const auto material = Materials().find("neo-Hookean");
    return *material;
  }

  /** The same in the state of one point. */
  template <int dim>
  ElasticPoint<dim>
  neo_hookean_point(const Tensor<2, dim> &F_e, const Lame &lame)
  {
    return ElasticPoint<dim>(F_e, lame, neo_hookean());
  }
} // namespace Morula

#endif
