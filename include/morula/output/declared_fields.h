// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_declared_fields_h
#define morula_output_declared_fields_h

#include <morula/output/point_fields.h>
#include <morula/particles/columns.h>

#include <vector>

namespace Morula
{
  /**
   * What effects want of their columns in the tables of cells or boundary
   * points: behind the table's own columns, in the order of their declaration.
   * A vector NAME stands in NAME_x, NAME_y, NAME_z, a tensor in NAME_xx,
   * NAME_xy, ..., NAME_zz, with zeros in the third direction in 2-D.
   */
  template <int dim>
  class DeclaredFields
  {
  public:
    /** Those of these columns that are in_output. */
    explicit DeclaredFields(const Columns &columns);

    /** Adds the heads to a table whose last columns for CSV files they are. */
    void
    add_names(PointFields<dim> &table) const;

    /**
     * Tells VTU files which of them are vectors and tensors. The last that is
     * done to a table without rows.
     * @throws std::invalid_argument for names that the table has already
     */
    void
    combine(PointFields<dim> &table) const;

    /** Adds a point's values to those of the table's last row. */
    void
    add_values(const ArrayView<const double> &row,
               PointFields<dim>              &table) const;

  private:
    std::vector<Columns::Entry> columns;
  };
} // namespace Morula

#endif
