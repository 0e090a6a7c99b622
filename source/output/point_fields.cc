// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/output/point_fields.h>

#include <stdexcept>

namespace Morula
{
  namespace
  {
    /** Directions in the tables, also in 2-D. */
    constexpr unsigned int n_directions = 3;

    /** The heads of a column. */
    std::vector<std::string>
    heads(const Columns::Entry &column)
    {
      constexpr char axes[n_directions + 1] = "xyz";
      if (column.rank == 0)
        return {column.name};
      std::vector<std::string> names;
      // In 2-D the third components are there as well, as zeros, so that
      // programs that read files need not ask for the dimension.
      for (const char i : {axes[0], axes[1], axes[2]})
        if (column.rank == 1)
          names.push_back(column.name + '_' + i);
        else
          for (const char j : {axes[0], axes[1], axes[2]})
            names.push_back(column.name + '_' + i + j);
      return names;
    }

    /** The columns that effects add to a table: those that are in_output. */
    std::vector<Columns::Entry>
    declared_for_output(const Columns &all)
    {
      std::vector<Columns::Entry> columns;
      for (const Columns::Entry &column : all.entries())
        if (column.in_output)
          {
            // Files have 32 bits for each number, so larger integers would be
            // wrong there.
            if (column.rank == 0 && column.n != 1)
              throw std::invalid_argument(
                "The column '" + column.name +
                "' of 64 bits cannot be in the output: "
                "its files hold 32 bits.");
            columns.push_back(column);
          }
      return columns;
    }


    /** Adds the heads of declared columns to a table, as its last columns for
     *  CSV files. */
    template <int dim>
    void
    add_names(const std::vector<Columns::Entry> &columns,
              PointFields<dim>                  &table)
    {
      for (const Columns::Entry &column : columns)
        for (const std::string &name : heads(column))
          {
            table.names.push_back(name);
            if (column.whole)
              table.whole.insert(name);
          }
      table.n_csv_columns = table.names.size();
    }


    /** Tells VTU files which declared columns are vectors and tensors. To be
     *  called last, before the table has rows.
     *  @throws std::invalid_argument for names that the table has already */
    template <int dim>
    void
    combine_declared(const std::vector<Columns::Entry> &columns,
                     PointFields<dim>                  &table)
    {
      // Names of columns must be unique over all names, combined or not. That
      // is tested here, as only here all of them are known.
      std::multiset<std::string> names(table.names.begin(), table.names.end());
      for (const auto &nonscalar : table.nonscalars)
        names.insert(nonscalar.name);
      for (const Columns::Entry &column : columns)
        {
          const std::vector<std::string> own = heads(column);
          if (column.rank > 0)
            {
              table.combine(column.name, own.front(), own.size());
              names.insert(column.name);
            }
          for (const std::string &name : {column.name, own.front()})
            if (names.count(name) > 1)
              throw std::invalid_argument("The output has a column '" + name +
                                          "' already: an effect must call its "
                                          "own one otherwise.");
        }
    }


    /** Adds a point's declared values to those of the table's last row. */
    template <int dim>
    void
    add_values(const std::vector<Columns::Entry> &columns,
               const ArrayView<const double>     &row,
               PointFields<dim>                  &table)
    {
      for (const Columns::Entry &column : columns)
        {
          const double *const numbers = row.data() + column.first;
          if (column.rank == 0)
            table.values.push_back(*numbers);
          else if (column.rank == 1)
            table.add_vector(Flat<Tensor<1, dim>>::read(numbers));
          else
            {
              const auto t = Flat<Tensor<2, dim>>::read(numbers);
              for (unsigned int i = 0; i < n_directions; ++i)
                // A tensor has three rows in the table, also in 2-D.
                table.add_vector(i < dim ? t[i] : Tensor<1, dim>());
            }
        }
    }


    /** A column of every row of a table: its head, and its value in a row. */
    template <typename Row>
    struct FieldColumn
    {
      const char *name;
      double (*value)(const Row &);
    };

    /** What the columns of a cell follow from. */
    template <int dim>
    struct CellRow
    {
      double                             time;
      types::particle_index              id;
      const CellView<dim, const double> &cell;
      const Point<dim>                  &x;
      unsigned int                       phase;
      const CellQuantities              &q;
    };

    /** What the columns of a boundary point follow from. */
    template <int dim>
    struct SurfaceRow
    {
      double                   time;
      types::particle_index    id;
      const BoundaryView<dim> &point;
      const Point<dim>        &x;
      double                   area;
      Tensor<1, dim>           n;
    };

    /** A coordinate of a vector; z = 0 in 2-D. */
    template <unsigned int d, int dim>
    double
    part(const Tensor<1, dim> &v)
    {
      if constexpr (d < dim)
        return v[d];
      else
        return 0.;
    }

    /** The columns of every cell. */
    template <int dim>
    const std::vector<FieldColumn<CellRow<dim>>> &
    cell_columns()
    {
      using Row                                          = CellRow<dim>;
      static const std::vector<FieldColumn<Row>> columns = {
        {"time", [](const Row &c) { return c.time; }},
        {"id", [](const Row &c) { return double(c.id); }},
        {"parent", [](const Row &c) { return double(c.cell.parent()); }},
        {"generation",
         [](const Row &c) { return double(c.cell.generation()); }},
        {"phase", [](const Row &c) { return double(c.phase); }},
        {"x", [](const Row &c) { return part<0>(c.x); }},
        {"y", [](const Row &c) { return part<1>(c.x); }},
        {"z", [](const Row &c) { return part<2>(c.x); }},
        {"X", [](const Row &c) { return part<0>(c.cell.founder_position()); }},
        {"Y", [](const Row &c) { return part<1>(c.cell.founder_position()); }},
        {"Z", [](const Row &c) { return part<2>(c.cell.founder_position()); }},
        {"initial_volume", [](const Row &c) { return c.q.initial_volume; }},
        {"volume", [](const Row &c) { return c.q.volume; }},
        {"growth_volume_ratio",
         [](const Row &c) { return c.q.growth_volume_ratio; }},
        {"elastic_volume_ratio",
         [](const Row &c) { return c.q.elastic_volume_ratio; }},
        {"energy_density", [](const Row &c) { return c.q.energy_density; }},
        {"sigma_xx", [](const Row &c) { return c.q.stress[0][0]; }},
        {"sigma_yy", [](const Row &c) { return c.q.stress[1][1]; }},
        {"sigma_zz", [](const Row &c) { return c.q.stress[2][2]; }},
        {"sigma_xy", [](const Row &c) { return c.q.stress[0][1]; }},
        {"sigma_yz", [](const Row &c) { return c.q.stress[1][2]; }},
        {"sigma_zx", [](const Row &c) { return c.q.stress[2][0]; }}};
      return columns;
    }

    /** The columns of every boundary point. */
    template <int dim>
    const std::vector<FieldColumn<SurfaceRow<dim>>> &
    surface_columns()
    {
      using Row                                          = SurfaceRow<dim>;
      static const std::vector<FieldColumn<Row>> columns = {
        {"time", [](const Row &c) { return c.time; }},
        {"id", [](const Row &c) { return double(c.id); }},
        {"x", [](const Row &c) { return part<0>(c.x); }},
        {"y", [](const Row &c) { return part<1>(c.x); }},
        {"z", [](const Row &c) { return part<2>(c.x); }},
        {"X", [](const Row &c) { return part<0>(c.point.initial_position()); }},
        {"Y", [](const Row &c) { return part<1>(c.point.initial_position()); }},
        {"Z", [](const Row &c) { return part<2>(c.point.initial_position()); }},
        {"nx", [](const Row &c) { return part<0>(c.n); }},
        {"ny", [](const Row &c) { return part<1>(c.n); }},
        {"nz", [](const Row &c) { return part<2>(c.n); }},
        {"area", [](const Row &c) { return c.area; }},
        {"condition",
         [](const Row &c) { return double(int(c.point.condition())); }}};
      return columns;
    }
  } // namespace


  template <int dim>
  std::string
  csv_text(const std::vector<PointFields<dim>> &parts)
  {
    const auto        &names     = parts.front().names;
    const unsigned int n_columns = parts.front().n_csv_columns;
    std::vector<std::pair<types::particle_index, const double *>> rows;
    for (const PointFields<dim> &part : parts)
      for (std::size_t i = 0; i < part.size(); ++i)
        rows.emplace_back(part.ids[i], part.row(i));
    std::sort(rows.begin(), rows.end());
    std::string text;
    // A number has about a dozen characters; moving a longer and longer text
    // would take as long as making it.
    text.reserve(12 * n_columns * (1 + rows.size()));
    for (unsigned int i = 0; i < n_columns; ++i)
      text += (i > 0 ? "," : "") + names[i];
    text += '\n';
    for (const auto &[id, row] : rows)
      {
        for (unsigned int i = 0; i < n_columns; ++i)
          {
            if (i > 0)
              text += ',';
            append_number(text, row[i]);
          }
        text += '\n';
      }
    return text;
  }


  template <int dim>
  CellFields<dim>::CellFields(const double            time,
                              const std::size_t       n_cells,
                              const CellColumns<dim> &columns,
                              const bool              has_checkpoint)
    : time(time)
    , has_checkpoint(has_checkpoint)
    , declared(declared_for_output(columns))
  {
    // The names of the columns in the order in which add() appends values:
    // those of every cell, the checkpoint's, those that effects declare. What
    // stands behind n_csv_columns is for VTU alone, as it follows from the
    // others. Vectors and tensors are names for several columns there.
    for (const auto &column : cell_columns<dim>())
      this->names.push_back(column.name);
    if (has_checkpoint)
      this->names.push_back("held_at_checkpoint");
    // Names that do not exist in a table do not matter here.
    this->whole = {"id", "parent", "generation", "phase", "held_at_checkpoint"};
    this->csv_only = {"time", "x", "y", "z"};
    add_names(declared, *this);
    for (const char *name : {"pressure",
                             "principal_stress_1",
                             "principal_stress_2",
                             "principal_stress_3"})
      this->names.push_back(name);
    this->add_nonscalar("displacement", 3);
    this->combine("sigma", "sigma_xx", 6);
    combine_declared(declared, *this);
    this->reserve(n_cells);
  }


  template <int dim>
  void
  CellFields<dim>::add(const types::particle_index        id,
                       const CellView<dim, const double> &cell,
                       const Point<dim>                  &position,
                       const unsigned int                 phase,
                       const bool                         held,
                       const CellQuantities              &q)
  {
    // The values in the order of the names, and all of them: the table is one
    // long list, row by row.
    this->ids.push_back(id);
    this->positions.push_back(position);
    const CellRow<dim> row{time, id, cell, position, phase, q};
    for (const auto &column : cell_columns<dim>())
      this->values.push_back(column.value(row));
    if (has_checkpoint)
      this->values.push_back(held);
    add_values(declared, cell.row(), *this);
    // The values for VTU alone: pressure, principal stresses, displacement.
    this->values.push_back(-trace(q.stress) / 3.);
    for (const double principal : eigenvalues(q.stress))
      this->values.push_back(principal);
    this->add_vector(position - cell.founder_position());
  }


  template <int dim>
  SurfaceFields<dim>::SurfaceFields(const double                time,
                                    const BoundaryColumns<dim> &columns)
    : time(time)
    , declared(declared_for_output(columns))
  {
    for (const auto &column : surface_columns<dim>())
      this->names.push_back(column.name);
    this->whole    = {"id", "condition"};
    this->csv_only = {"time", "x", "y", "z"};
    add_names(declared, *this);
    // VTU has vectors, and the displacement, which CSV's readers can compute.
    this->combine("normal", "nx", 3);
    this->add_nonscalar("displacement", 3);
    combine_declared(declared, *this);
  }


  template <int dim>
  void
  SurfaceFields<dim>::add(const types::particle_index id,
                          const BoundaryView<dim>    &point,
                          const Point<dim>           &position)
  {
    // This is a n of doc/theory.md (1.2), at present.
    const Tensor<1, dim>  area_vector = point.area_vector();
    const double          area        = area_vector.norm();
    const SurfaceRow<dim> row{
      time, id, point, position, area, area_vector / area};
    this->ids.push_back(id);
    this->positions.push_back(position);
    for (const auto &column : surface_columns<dim>())
      this->values.push_back(column.value(row));
    add_values(declared, point.row(), *this);
    this->add_vector(position - point.initial_position());
  }


  template struct CellFields<2>;
  template struct CellFields<3>;
  template struct SurfaceFields<2>;
  template struct SurfaceFields<3>;
  MORULA_INSTANTIATE(csv_text);
} // namespace Morula
