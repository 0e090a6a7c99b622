// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_columns_h
#define morula_particles_columns_h

#include <morula/particles/flat.h>

#include <deal.II/base/array_view.h>
#include <deal.II/base/exceptions.h>
#include <deal.II/base/numbers.h>

#include <string>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /** What a daughter gets of a column of its mother's. An effect may write
   *  something else over it: the cell cycle does with its clock. */
  enum class AtDivision
  {
    copied, // the mother's value
    halved, // half of it: for amounts
    reset   // what a founder has
  };

  /** One column: what it is called, what it means, and what becomes of it. */
  template <typename T>
  struct ColumnDeclaration
  {
    /** Small letters, digits and '_': in snapshots and in column heads. */
    std::string name;
    /** E.g. "um"; empty for pure numbers. */
    std::string unit;
    /** A noun phrase. */
    std::string meaning;
    /** What a founder has. */
    T          initial     = T();
    AtDivision at_division = AtDivision::copied;
    /** Whether cells-NNNN.csv and cells-NNNN.vtu have it as well. It is in
     *  snapshots in any case. */
    bool in_output = false;
  };

  /**
   * Handle of a column, given by Columns::add(): where its values stand in a
   * point's row of numbers. Without one it stands for a column that does not
   * exist and takes no storage.
   */
  template <typename T>
  class Column
  {
  public:
    /** Of a value. */
    using Type = T;

    /** A column that does not exist. */
    Column() = default;

    /** Whether it exists. */
    bool
    exists() const
    {
      return first != numbers::invalid_unsigned_int;
    }

    /** The value in a row. */
    template <typename Number>
    T
    get(const ArrayView<Number> &row) const
    {
      AssertIndexRange(first + Flat<T>::n - 1, row.size());
      return Flat<T>::read(row.data() + first);
    }

    /** Writes the value into a row. */
    void
    set(const ArrayView<double> &row, const T &value) const
    {
      AssertIndexRange(first + Flat<T>::n - 1, row.size());
      Flat<T>::write(value, row.data() + first);
    }

  private:
    friend class Columns;

    explicit Column(const unsigned int first)
      : first(first)
    {}

    unsigned int first = numbers::invalid_unsigned_int;
  };

  /**
   * The columns of a kind of points (cells, or boundary points) in the order of
   * their declaration. Complete before there are points.
   */
  class Columns
  {
  public:
    /** A column without its type. */
    struct Entry
    {
      /** As declared. */
      std::string name, unit, meaning;
      /** The numbers [first, first + n) of a row. */
      unsigned int first, n;
      /** 0 for scalars, 1 for vectors, 2 for tensors. */
      unsigned int rank;
      /** Whether the numbers have no fraction. */
      bool       whole;
      AtDivision at_division;
      bool       in_output;
    };

    /**
     * Adds a column behind the others.
     * @throws std::invalid_argument for a name that is in use, or that has
     *         other characters than declared names may have
     */
    template <typename T>
    Column<T>
    add(const ColumnDeclaration<T> &declaration)
    {
      check_name(declaration.name);
      const unsigned int first = initial.size();
      list.push_back({declaration.name,
                      declaration.unit,
                      declaration.meaning,
                      first,
                      Flat<T>::n,
                      Flat<T>::rank,
                      Flat<T>::whole,
                      declaration.at_division,
                      declaration.in_output});
      append_flat(initial, declaration.initial);
      return Column<T>(first);
    }

    /** The column of this name and type; one that does not exist where there is
     *  none. For programs that read what others declare. */
    template <typename T>
    Column<T>
    find(const std::string &name) const
    {
      for (const Entry &entry : list)
        if (entry.name == name && entry.n == Flat<T>::n &&
            entry.rank == Flat<T>::rank && entry.whole == Flat<T>::whole)
          return Column<T>(entry.first);
      return {};
    }

    /** All columns in order. */
    const std::vector<Entry> &
    entries() const
    {
      return list;
    }

    /** How many numbers a row has. */
    unsigned int
    n_numbers() const
    {
      return initial.size();
    }

    /** A founder's row, for what is declared the same for all of them. */
    const std::vector<double> &
    initial_row() const
    {
      return initial;
    }

    /** A daughter's row, from her mother's by the columns' rules. */
    std::vector<double>
    daughter(const ArrayView<const double> &mother) const;

    /** The columns as snapshots name them: a line "name n" each. */
    std::string
    layout() const;

    /** How a layout() differs from this one, e.g. "lacks 'a' and has 'b'";
     * empty if it does not. */
    std::string
    differences(const std::string &layout) const;

  private:
    void
    check_name(const std::string &name) const;

    std::vector<Entry>  list;
    std::vector<double> initial;
  };
} // namespace Morula

#endif
