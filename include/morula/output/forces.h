// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_forces_h
#define morula_output_forces_h

#include <deal.II/base/tensor.h>

#include <cstdint>
#include <string>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /** What acts on the tissue at one time, summed over its points and over all
   *  ranks. In 2-D forces are per µm of thickness. */
  struct ForceRow
  {
    /** "condition", "obstacle", "lumen", on cells "force", or the name of an
     *  interaction. */
    std::string kind;
    /** As in the scene. */
    std::string name;
    /** On which it acts: boundary points, cells of a force. */
    std::uint64_t points = 0;
    /** Of these boundary points, µm^(dim-1). */
    double area = 0.;
    /** On the tissue, kPa µm^(dim-1). */
    Tensor<1, 3> force;
    /** Of the force, about the origin, kPa µm^dim. */
    Tensor<1, 3> moment;
    /** Sum of the points' forces along their inward normals, kPa µm^(dim-1):
     *  it does not cancel where the tissue is pressed from both sides. */
    double inward = 0.;
    /** Whether it acts between bodies of the tissue. */
    bool is_internal = false;
  };

  /** The columns of forces.csv. */
  std::vector<std::string>
  force_columns();

  /** The rows of forces.csv at @p time, day. */
  std::string
  force_rows(const double time, const std::vector<ForceRow> &rows);
} // namespace Morula

#endif
