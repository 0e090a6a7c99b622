// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_seeding_room_h
#define morula_tests_seeding_room_h

#include <morula/base/agreement.h>
#include <morula/base/input_error.h>
#include <morula/base/surface_mesh.h>
#include <morula/particles/point_exchange.h>
#include <morula/particles/tissue.h>
#include <morula/seeding/closed_surface.h>
#include <morula/seeding/seeding.h>
#include <morula/seeding/shape.h>

#include <deal.II/base/numbers.h>

#include <boost/algorithm/string.hpp>

#include <cstdint>

#include "common/body_on_grid.h"
#include "common/polygons.h"
#include "common/temporary_file.h"
#include "common/tests.h"
#include "particles/surface_patches.h"

using namespace Morula;

/** What a surface has, over some of its patches. */
template <int dim>
struct Sums
{
  double         area = 0., volume = 0.;
  Tensor<1, dim> vector;

  Sums(
    const SurfacePatches<dim>                     &patches,
    const std::function<bool(const Point<dim> &)> &select =
      [](const Point<dim> &) { return true; })
  {
    for (std::size_t i = 0; i < patches.areas.size(); ++i)
      if (select(patches.positions[i]))
        {
          area += patches.areas[i];
          vector += patches.areas[i] * patches.normals[i];
          volume += patches.areas[i] / dim *
                    (patches.normals[i] * patches.positions[i]);
        }
  }

  /** |sum a n| over the area: 0 for a closed surface. */
  double
  openness() const
  {
    return vector.norm() / area;
  }
};

#endif
