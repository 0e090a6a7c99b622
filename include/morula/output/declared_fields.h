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
   * The columns that effects add to the tables of cells or boundary points.
   * They follow the table's own columns, in the order of their declaration. A
   * vector NAME has the columns NAME_x, NAME_y, NAME_z, a tensor NAME_xx,
   * NAME_xy, ..., NAME_zz; in 2-D the third direction has zeros.
   */
  template <int dim>
  class DeclaredFields
  {
  public:
    /** Takes those of @p columns that are in_output. */
    explicit DeclaredFields(const Columns &columns);

    /** Adds the heads to a table, as its last columns for CSV files. */
    void
    add_names(PointFields<dim> &table) const;

    /**
     * Tells VTU files which of the columns are vectors and tensors. To be
     * called last, before the table has rows.
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
