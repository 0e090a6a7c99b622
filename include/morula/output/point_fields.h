// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_point_fields_h
#define morula_output_point_fields_h

#include <morula/output/gather.h>

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>
#include <deal.II/particles/property_pool.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /**
   * This rank's rows of a table about points (cells or boundary points). One
   * description serves the CSV file, which holds the first columns, and the VTU
   * file, which holds every number once: components of vectors and tensors,
   * coordinates of the point and the time have no arrays of their own there.
   */
  template <int dim>
  struct PointFields
  {
    /**
     * Consecutive columns that ParaView shall see as one vector (3 columns) or
     * one symmetric tensor (6 columns: xx, yy, zz, xy, yz, zx), also in 2-D.
     */
    struct Nonscalar
    {
      std::string  name;
      unsigned int first_column;
      unsigned int n_columns;
      /** Names of the columns, if they are named. */
      std::vector<std::string> components;
    };

    /** Names of the columns; empty for a column that only belongs to a
     *  nonscalar. */
    std::vector<std::string> names;
    /** The columns behind these are for VTU files only. */
    unsigned int           n_csv_columns = 0;
    std::vector<Nonscalar> nonscalars;
    /** Scalars that a VTU file holds in another way. */
    std::set<std::string> csv_only;
    /** Names of scalars that are integers. */
    std::set<std::string> whole;

    std::vector<types::particle_index> ids;
    /** Current, µm. */
    std::vector<Point<dim>> positions;
    /** Row by row; a row has a value for each name. */
    std::vector<double> values;

    /** Appends a vector's or tensor's columns. */
    void
    add_nonscalar(const std::string &name, const unsigned int n_columns)
    {
      const unsigned int first_column = names.size();
      nonscalars.push_back({name, first_column, n_columns, {}});
      names.insert(names.end(), n_columns, "");
    }

    /** Makes a vector or tensor of existing columns, which become its
     *  components in VTU files: the column "sigma_xx" is "xx" of "sigma".
     *  ParaView shows it as "sigma_xx", too. */
    void
    combine(const std::string &name,
            const std::string &first,
            const unsigned int n_columns)
    {
      const auto found = std::find(names.begin(), names.end(), first);
      Nonscalar  combined{name,
                         static_cast<unsigned int>(found - names.begin()),
                         n_columns,
                          {}};
      for (auto column = found; column != found + n_columns; ++column)
        {
          csv_only.insert(*column);
          const bool prefixed = column->rfind(name + "_", 0) == 0;
          combined.components.push_back(
            prefixed ? column->substr(name.size() + 1) : *column);
        }
      nonscalars.push_back(combined);
    }

    /** Appends the three values of a vector to the last row, 2-D: z = 0. */
    void
    add_vector(const Tensor<1, dim> &vector)
    {
      for (unsigned int d = 0; d < 3; ++d)
        values.push_back(d < dim ? vector[d] : 0.);
    }

    /** Reserves memory. To be called when all columns are there. */
    void
    reserve(const std::size_t n_points)
    {
      ids.reserve(n_points);
      positions.reserve(n_points);
      values.reserve(n_points * names.size());
    }

    std::size_t
    size() const
    {
      return ids.size();
    }

    /** The values of a point, in the order of names. */
    const double *
    row(const std::size_t i) const
    {
      return values.data() + i * names.size();
    }
  };

  /** The rows of all ranks, rank by rank, on rank 0; elsewhere nothing.
   *  Collective. */
  template <int dim>
  std::vector<PointFields<dim>>
  gather_to_root(PointFields<dim> fields, const MPI_Comm comm)
  {
    auto ids       = gather_to_root(std::exchange(fields.ids, {}), comm);
    auto positions = gather_to_root(std::exchange(fields.positions, {}), comm);
    auto values    = gather_to_root(std::exchange(fields.values, {}), comm);
    // All ranks have the same columns.
    std::vector<PointFields<dim>> parts(ids.size(), fields);
    for (std::size_t rank = 0; rank < parts.size(); ++rank)
      {
        parts[rank].ids       = std::move(ids[rank]);
        parts[rank].positions = std::move(positions[rank]);
        parts[rank].values    = std::move(values[rank]);
      }
    return parts;
  }
} // namespace Morula

#endif
