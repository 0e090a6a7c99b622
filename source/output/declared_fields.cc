// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/declared_fields.h>

#include <set>
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
  } // namespace

  template <int dim>
  DeclaredFields<dim>::DeclaredFields(const Columns &all)
  {
    for (const Columns::Entry &column : all.entries())
      if (column.in_output)
        {
          // Files have 32 bits for each number, so larger integers would be
          // wrong there.
          if (column.rank == 0 && column.n != 1)
            throw std::invalid_argument("The column '" + column.name +
                                        "' of 64 bits cannot be in the output: "
                                        "its files hold 32 bits.");
          columns.push_back(column);
        }
  }

  template <int dim>
  void
  DeclaredFields<dim>::add_names(PointFields<dim> &table) const
  {
    for (const Columns::Entry &column : columns)
      for (const std::string &name : heads(column))
        {
          table.names.push_back(name);
          if (column.whole)
            table.whole.insert(name);
        }
  }

  template <int dim>
  void
  DeclaredFields<dim>::combine(PointFields<dim> &table) const
  {
    // Names of columns must be unique over all names, combined or not. That is
    // tested here, as only here all of them are known.
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

  template <int dim>
  void
  DeclaredFields<dim>::add_values(const ArrayView<const double> &row,
                                  PointFields<dim>              &table) const
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

  template class DeclaredFields<2>;
  template class DeclaredFields<3>;
} // namespace Morula
