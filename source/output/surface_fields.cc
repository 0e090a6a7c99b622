// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/surface_fields.h>

namespace Morula
{
  namespace
  {
    template <int dim>
    Tensor<1, dim>
    vector_at(const ArrayView<const double> &properties, const unsigned slot)
    {
      Tensor<1, dim> v;
      for (unsigned int d = 0; d < dim; ++d)
        v[d] = properties[slot + d];
      return v;
    }
  } // namespace

  template <int dim>
  Tensor<1, dim>
  current_area_vector(const ArrayView<const double> &properties)
  {
    using Slots = BoundarySlots<dim>;
    Tensor<2, dim> F;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        F[i][j] = properties[Slots::deformation + i * dim + j];

    return determinant(F) * properties[Slots::initial_area] *
           (transpose(invert(F)) *
            vector_at<dim>(properties, Slots::initial_normal));
  }

  template <int dim>
  SurfaceFields<dim>::SurfaceFields(const double time)
    : time(time)
  {
    table.names         = {"time",
                           "id",
                           "x",
                           "y",
                           "z",
                           "X",
                           "Y",
                           "Z",
                           "nx",
                           "ny",
                           "nz",
                           "area",
                           "condition"};
    table.n_csv_columns = table.names.size();
    table.add_nonscalar("normal", 3);
    table.add_nonscalar("displacement", 3);
  }

  template <int dim>
  void
  SurfaceFields<dim>::add(const types::particle_index    id,
                          const ArrayView<const double> &properties,
                          const Point<dim>              &position)
  {
    using Slots                      = BoundarySlots<dim>;
    const Tensor<1, dim> area_vector = current_area_vector<dim>(properties);
    const double         area        = area_vector.norm();
    const Tensor<1, dim> normal      = area_vector / area;
    const Tensor<1, dim> initial_position =
      vector_at<dim>(properties, Slots::initial_position);

    std::vector<double> &values = table.values;
    table.ids.push_back(id);
    table.positions.push_back(position);

    values.push_back(time);
    values.push_back(id);
    table.add_vector(position);
    table.add_vector(initial_position);
    table.add_vector(normal);
    values.push_back(area);
    values.push_back(properties[Slots::condition]);
    table.add_vector(normal);
    table.add_vector(position - initial_position);
  }

  template Tensor<1, 2>
  current_area_vector<2>(const ArrayView<const double> &);
  template Tensor<1, 3>
  current_area_vector<3>(const ArrayView<const double> &);

  template class SurfaceFields<2>;
  template class SurfaceFields<3>;
} // namespace Morula
