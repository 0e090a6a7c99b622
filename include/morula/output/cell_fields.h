// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_cell_fields_h
#define morula_output_cell_fields_h

#include <morula/mechanics/elastic_point.h>
#include <morula/output/declared_fields.h>
#include <morula/output/point_fields.h>
#include <morula/particles/cell_state.h>

#include <utility>

namespace Morula
{
  /**
   * The table behind cells-NNNN.csv and cells-NNNN.vtu. The latter also gets
   * pressure (-tr σ / 3), the principal stresses (largest first), and the
   * displacement x - X; σ is a tensor there. Columns that effects have declared
   * for the output are the last ones of the CSV file.
   */
  template <int dim>
  class CellFields
  {
  public:
    /**
     * @param time           day
     * @param n_cells        number of cells that will be added
     * @param columns        of the cells
     * @param has_checkpoint whether there is a column of the cells that the
     *                       size checkpoint holds
     * @throws std::invalid_argument for declared columns with heads that the
     *                       table has already
     */
    CellFields(const double            time,
               const std::size_t       n_cells,
               const CellColumns<dim> &columns,
               const bool              has_checkpoint);

    /**
     * Adds one cell of this rank.
     * @param position current, µm
     * @param phase    number as in the file; 9: does not proliferate
     * @param held     whether the size checkpoint holds it; false without one
     */
    void
    add(const types::particle_index        id,
        const CellView<dim, const double> &cell,
        const Point<dim>                  &position,
        const unsigned int                 phase,
        const bool                         held,
        const CellQuantities              &quantities);

    const PointFields<dim> &
    fields() const &
    {
      return table;
    }

    /** The fields of a table that is no longer needed. */
    PointFields<dim>
    fields() &&
    {
      return std::move(table);
    }

  private:
    double              time;
    bool                has_checkpoint;
    DeclaredFields<dim> declared;
    PointFields<dim>    table;
  };
} // namespace Morula

#endif
