// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/particles/cell_state.h>

namespace Morula
{
  template <int dim>
  CellColumns<dim>::CellColumns()
  {
    founder_position = add<Point<dim>>(
      {"founder_position", "um", "initial position of the founder"});
    initial_volume = add<double>({"initial_volume",
                                  "um^" + std::to_string(dim),
                                  "volume at t = 0, halved at every division",
                                  0.,
                                  AtDivision::halved});
    deformation =
      add<Tensor<2, dim>>({"deformation",
                           "",
                           "deformation gradient F since t = 0",
                           Tensor<2, dim>(unit_symmetric_tensor<dim>())});
  }

  template <int dim>
  void
  CellColumns<dim>::need_growth()
  {
    if (!growth.exists())
      growth =
        add<Tensor<2, dim>>({"growth",
                             "",
                             "growth F_g",
                             Tensor<2, dim>(unit_symmetric_tensor<dim>())});
  }

  template <int dim>
  void
  CellColumns<dim>::need_lineage()
  {
    if (parent.exists())
      return;
    parent = add<int>({"parent", "", "id of the mother, -1 for founders", -1});
    generation =
      add<unsigned int>({"generation", "", "divisions since the founder"});
  }

  template <int dim>
  void
  CellColumns<dim>::need_bodies(const bool with_parts)
  {
    if (!body.exists())
      body = add<unsigned int>({"body",
                                "",
                                "number of the body that the cell belongs to",
                                0,
                                AtDivision::copied,
                                true});
    if (with_parts && !part.exists())
      part =
        add<unsigned int>({"part", "", "number of the part of its grid cell"});
  }

  template <int dim>
  void
  CellColumns<dim>::need_lineage_key()
  {
    if (!lineage_key.exists())
      lineage_key =
        add<std::uint64_t>({"lineage_key", "", "key of the random numbers"});
  }

  template <int dim>
  void
  CellColumns<dim>::need_shape()
  {
    if (!shape.exists())
      shape = add<Tensor<2, dim>>(
        {"shape",
         "",
         "H: F H is what divisions have left of the founder's cube",
         Tensor<2, dim>(unit_symmetric_tensor<dim>())});
  }

  template <int dim>
  std::vector<double>
  CellColumns<dim>::founder(const Point<dim> &X, const double volume) const
  {
    std::vector<double> row = this->initial_row();
    founder_position.set(make_array_view(row), X);
    initial_volume.set(make_array_view(row), volume);
    return row;
  }

  template class CellColumns<2>;
  template class CellColumns<3>;
} // namespace Morula
