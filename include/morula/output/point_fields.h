// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_point_fields_h
#define morula_output_point_fields_h

#include <morula/mechanics/elastic_point.h>
#include <morula/output/table.h>
#include <morula/particles/boundary_state.h>
#include <morula/particles/cell_state.h>

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>
#include <deal.II/particles/property_pool.h>

#include <mpi.h>

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


  /**
   * The text of a CSV file of points: a header, then the rows of all parts in
   * the order of their ids, so that the file is the same for any number of
   * ranks.
   * @param parts of the ranks; at least one
   */
  template <int dim>
  std::string
  csv_text(const std::vector<PointFields<dim>> &parts);


  /**
   * The table behind cells-NNNN.csv and cells-NNNN.vtu. The latter also gets
   * pressure (-tr σ / 3), the principal stresses (largest first), and the
   * displacement x - X; σ is a tensor there. Columns that effects have declared
   * for the output are the last ones of the CSV file, in the order of their
   * declaration. A vector NAME has the columns NAME_x, NAME_y, NAME_z, a tensor
   * NAME_xx, NAME_xy, ..., NAME_zz; in 2-D the third direction has zeros.
   */
  template <int dim>
  struct CellFields : public PointFields<dim>
  {
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

  private:
    const double                      time;
    const bool                        has_checkpoint;
    const std::vector<Columns::Entry> declared;
  };

  /**
   * The table behind surface-NNNN.csv and surface-NNNN.vtu. The latter also
   * gets the normal and the displacement as vectors. Declared columns are as in
   * CellFields.
   */
  template <int dim>
  struct SurfaceFields : public PointFields<dim>
  {
    /** As the constructor of CellFields. */
    SurfaceFields(const double time, const BoundaryColumns<dim> &columns);

    /** Adds one boundary point of this rank.
     *  @param position current, µm */
    void
    add(const types::particle_index id,
        const BoundaryView<dim>    &point,
        const Point<dim>           &position);

  private:
    const double                      time;
    const std::vector<Columns::Entry> declared;
  };


  /**
   * Writes one VTU file, uncompressed, with a piece for each part. It appears
   * when it is complete.
   * @param parts  of the ranks
   * @param time   day
   * @param number of the file in its series
   * @throws std::runtime_error with path and reason
   */
  template <int dim>
  void
  write_vtu(const std::string                   &path,
            const std::vector<PointFields<dim>> &parts,
            const double                         time,
            const unsigned int                   number);

  /**
   * Writes the ParaView record of a series: times (day) and file names relative
   * to the record. Files that are not there (the format was switched on later)
   * are left out. Collective.
   * @throws std::runtime_error, on all ranks, with path and reason
   */
  void
  write_pvd(const std::string                                 &path,
            const std::vector<std::pair<double, std::string>> &times_and_names,
            const MPI_Comm                                     comm);
} // namespace Morula

#endif
