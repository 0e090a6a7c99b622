// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_columns_h
#define morula_particles_columns_h


#include <deal.II/base/array_view.h>
#include <deal.II/base/exceptions.h>
#include <deal.II/base/numbers.h>
#include <deal.II/base/point.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <cstdint>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /** 0 for scalars, 1 for vectors, 2 for tensors. */
  template <typename T>
  inline constexpr unsigned int flat_rank = 0;
  template <int dim>
  inline constexpr unsigned int flat_rank<Tensor<1, dim>> = 1;
  template <int dim>
  inline constexpr unsigned int flat_rank<Point<dim>> = 1;
  template <int dim>
  inline constexpr unsigned int flat_rank<Tensor<2, dim>> = 2;
  template <int dim>
  inline constexpr unsigned int flat_rank<SymmetricTensor<2, dim>> = 2;

  /**
   * Converts a value of type T to @p n numbers in a row, and back: numbers and
   * enumerations of at most 32 bits, which a double holds exactly; integers of
   * 64 bits, the lower half, then the upper half; points, vectors and tensors,
   * row by row, of symmetric ones the upper triangle. This is the only place
   * that takes tensors apart, for columns, snapshots and messages between
   * ranks.
   */
  template <typename T>
  struct Flat
  {
    /** See flat_rank. */
    static constexpr unsigned int rank = flat_rank<T>;
    /** Whether the numbers are integers. */
    static constexpr bool whole = rank == 0 && !std::is_same_v<T, double>;

    static constexpr unsigned int
    count()
    {
      if constexpr (rank > 0)
        return T::n_independent_components;
      else
        return is_long ? 2 : 1;
    }

    static constexpr bool is_long = std::is_same_v<T, std::uint64_t>;
    static_assert(rank > 0 || is_long || std::is_same_v<T, double> ||
                  ((std::is_integral_v<T> || std::is_enum_v<T>) &&
                   sizeof(T) <= 4));

    /** Number of numbers for a value. */
    static constexpr unsigned int n = count();

    /** The value of the numbers from @p numbers on. */
    static T
    read(const double *numbers)
    {
      if constexpr (rank > 0)
        {
          T value;
          for_entries(value, [&](double &entry) { entry = *numbers++; });
          return value;
        }
      else if constexpr (is_long)
        return static_cast<std::uint64_t>(numbers[0]) |
               (static_cast<std::uint64_t>(numbers[1]) << 32);
      else if constexpr (std::is_enum_v<T>)
        return static_cast<T>(static_cast<int>(*numbers));
      else
        return static_cast<T>(*numbers);
    }

    /** Writes the value to the numbers from @p numbers on. */
    static void
    write(const T &value, double *numbers)
    {
      if constexpr (rank > 0)
        for_entries(value, [&](const double entry) { *numbers++ = entry; });
      else if constexpr (is_long)
        {
          numbers[0] = static_cast<std::uint32_t>(value);
          numbers[1] = static_cast<std::uint32_t>(value >> 32);
        }
      else if constexpr (std::is_enum_v<T>)
        *numbers = static_cast<int>(value);
      else
        *numbers = value;
    }

  private:
    /** Calls visit(entry) for the entries of a vector or tensor. */
    template <typename Value, typename Visit>
    static void
    for_entries(Value &value, const Visit &visit)
    {
      constexpr unsigned int dim = T::dimension;
      for (unsigned int i = 0; i < dim; ++i)
        if constexpr (rank == 1)
          visit(value[i]);
        else
          for (unsigned int j = n < dim * dim ? i : 0; j < dim; ++j)
            visit(value[i][j]);
    }
  };

  /** Several values, one after the other. */
  template <typename... Ts>
  struct Flat<std::tuple<Ts...>>
  {
    static constexpr unsigned int n = (Flat<Ts>::n + ...);
    static std::tuple<Ts...>
    read(const double *numbers)
    {
      const auto next = [&numbers](const auto flat) {
        const auto value = flat.read(numbers);
        numbers += flat.n;
        return value;
      };
      // In braces the values are read from left to right.
      return std::tuple<Ts...>{next(Flat<Ts>())...};
    }
    static void
    write(const std::tuple<Ts...> &values, double *numbers)
    {
      std::apply(
        [&numbers](const Ts &...value) {
          ((Flat<Ts>::write(value, numbers), numbers += Flat<Ts>::n), ...);
        },
        values);
    }
  };

  /** Appends a value to a list of numbers. */
  template <typename T>
  void
  append_flat(std::vector<double> &numbers, const T &value)
  {
    numbers.resize(numbers.size() + Flat<T>::n);
    Flat<T>::write(value, numbers.data() + numbers.size() - Flat<T>::n);
  }

  /** Which value a daughter gets in a column. An effect may overwrite it, as
   *  the cell cycle does with its clock. */
  enum class AtDivision
  {
    copied, // the mother's value
    halved, // half of the mother's value: for amounts
    reset   // the value of a founder
  };

  /** The declaration of a column: name, meaning, and rule at division. */
  template <typename T>
  struct ColumnDeclaration
  {
    /** Small letters, digits and '_'. Snapshots and tables use this name. */
    std::string name;
    /** E.g. "um"; empty for pure numbers. */
    std::string unit;
    /** A noun phrase. */
    std::string meaning;
    /** The value of a founder. */
    T          initial     = T();
    AtDivision at_division = AtDivision::copied;
    /** Whether cells-NNNN.csv and cells-NNNN.vtu have the column. Snapshots
     *  always have it. */
    bool in_output = false;
  };

  /**
   * Handle of a column: the place of its value in a point's row of numbers.
   * Columns::add() makes it. A default-constructed handle stands for a column
   * that does not exist and takes no storage.
   */
  template <typename T>
  class Column
  {
  public:
    /** Type of a value. */
    using Type = T;

    /** A column that does not exist. */
    Column() = default;

    /** Whether the column exists. */
    bool
    exists() const
    {
      return first != numbers::invalid_unsigned_int;
    }

    /** Reads the value from a row. */
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
   * The columns of cells, or of boundary points, in the order in which they are
   * declared. All must be declared before points are made.
   */
  class Columns
  {
  public:
    /** A column without its type. */
    struct Entry
    {
      /** The texts with which the column was declared. */
      std::string name, unit, meaning;
      /** The numbers [first, first + n) of a row. */
      unsigned int first, n;
      /** 0 for scalars, 1 for vectors, 2 for tensors. */
      unsigned int rank;
      /** Whether the numbers are integers. */
      bool       whole;
      AtDivision at_division;
      bool       in_output;
    };

    /**
     * Adds a column behind the others.
     * @throws std::invalid_argument for a name that is in use, or that has
     *         other characters than ColumnDeclaration::name allows
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

    /** The column of this name and type, or a handle without a column. For
     *  programs that read columns declared elsewhere. */
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

    /** Number of numbers in a row. */
    unsigned int
    n_numbers() const
    {
      return initial.size();
    }

    /** The row of a founder, with the declared initial values. */
    const std::vector<double> &
    initial_row() const
    {
      return initial;
    }

    /** The row of a daughter, from the mother's by the columns' rules. */
    std::vector<double>
    daughter(const ArrayView<const double> &mother) const;

    /** The columns as snapshots name them: one line "name n" for each. */
    std::string
    layout() const;

    /** How @p layout differs from layout(), e.g. "lacks 'a' and has 'b'"; empty
     *  if they are equal. */
    std::string
    differences(const std::string &layout) const;

  private:
    void
    check_name(const std::string &name) const;

    std::vector<Entry>  list;
    std::vector<double> initial;
  };

  /**
   * One cell or boundary point: reads its row of numbers by the columns' names.
   * Does not own the row. Number is `double` (also writes) or `const double`.
   */
  template <typename OfColumns, typename Number>
  class RowView
  {
  public:
    /** @param columns must outlive this */
    RowView(const ArrayView<Number> &row, const OfColumns &columns)
      : row_(row)
      , columns_(columns)
    {}

    /** The value in a column that exists. */
    template <typename T>
    T
    get(const Column<T> &column) const
    {
      return column.get(row_);
    }

    /** Writes the value in a column that exists. */
    template <typename T>
    void
    set(const Column<T> &column, const typename Column<T>::Type &value) const
    {
      column.set(row_, value);
    }

    /** The whole row. */
    const ArrayView<Number> &
    row() const
    {
      return row_;
    }

    /** The columns of all rows. */
    const OfColumns &
    columns() const
    {
      return columns_;
    }

  protected:
    ArrayView<Number> row_;
    const OfColumns  &columns_;
  };
} // namespace Morula

#endif
