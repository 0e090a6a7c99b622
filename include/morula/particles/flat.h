// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_flat_h
#define morula_particles_flat_h

#include <deal.II/base/point.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <cstdint>
#include <tuple>
#include <type_traits>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /**
   * Converts a value of type T to @p n numbers in a row, and back. This is the
   * only place that takes tensors apart, for columns, snapshots and messages
   * between ranks.
   *
   * The general case: numbers and enumerations of at most 32 bits, which a
   * double holds exactly.
   */
  template <typename T>
  struct Flat
  {
    static_assert(std::is_same_v<T, double> ||
                  ((std::is_integral_v<T> || std::is_enum_v<T>) &&
                   sizeof(T) <= 4));

    /** Number of numbers for a value. */
    static constexpr unsigned int n = 1;
    /** 0 for scalars, 1 for vectors, 2 for tensors. */
    static constexpr unsigned int rank = 0;
    /** Whether the numbers are integers. */
    static constexpr bool whole = !std::is_same_v<T, double>;

    /** The value of the numbers from @p numbers on. */
    static T
    read(const double *const numbers)
    {
      if constexpr (std::is_enum_v<T>)
        return static_cast<T>(static_cast<int>(*numbers));
      else
        return static_cast<T>(*numbers);
    }

    /** Writes the value to the numbers from @p numbers on. */
    static void
    write(const T value, double *const numbers)
    {
      if constexpr (std::is_enum_v<T>)
        *numbers = static_cast<int>(value);
      else
        *numbers = value;
    }
  };

  /** Integers of 64 bits: the lower half, then the upper half. */
  template <>
  struct Flat<std::uint64_t>
  {
    static constexpr unsigned int n     = 2;
    static constexpr unsigned int rank  = 0;
    static constexpr bool         whole = true;
    /** See Flat. */
    static std::uint64_t
    read(const double *const numbers)
    {
      return static_cast<std::uint64_t>(numbers[0]) |
             (static_cast<std::uint64_t>(numbers[1]) << 32);
    }
    /** See Flat. */
    static void
    write(const std::uint64_t value, double *const numbers)
    {
      numbers[0] = static_cast<std::uint32_t>(value);
      numbers[1] = static_cast<std::uint32_t>(value >> 32);
    }
  };

  /** Vectors. */
  template <int dim>
  struct Flat<Tensor<1, dim>>
  {
    static constexpr unsigned int n     = dim;
    static constexpr unsigned int rank  = 1;
    static constexpr bool         whole = false;
    /** See Flat. */
    static Tensor<1, dim>
    read(const double *const numbers)
    {
      Tensor<1, dim> v;
      for (unsigned int d = 0; d < dim; ++d)
        v[d] = numbers[d];
      return v;
    }
    /** See Flat. */
    static void
    write(const Tensor<1, dim> &v, double *const numbers)
    {
      for (unsigned int d = 0; d < dim; ++d)
        numbers[d] = v[d];
    }
  };

  /** Points, like vectors. */
  template <int dim>
  struct Flat<Point<dim>> : public Flat<Tensor<1, dim>>
  {
    /** See Flat. */
    static Point<dim>
    read(const double *const numbers)
    {
      return Point<dim>(Flat<Tensor<1, dim>>::read(numbers));
    }
  };

  /** Tensors, row by row. */
  template <int dim>
  struct Flat<Tensor<2, dim>>
  {
    static constexpr unsigned int n     = dim * dim;
    static constexpr unsigned int rank  = 2;
    static constexpr bool         whole = false;
    /** See Flat. */
    static Tensor<2, dim>
    read(const double *numbers)
    {
      Tensor<2, dim> t;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          t[i][j] = *numbers++;
      return t;
    }
    /** See Flat. */
    static void
    write(const Tensor<2, dim> &t, double *numbers)
    {
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          *numbers++ = t[i][j];
    }
  };

  /** Symmetric tensors: the upper triangle, row by row. */
  template <int dim>
  struct Flat<SymmetricTensor<2, dim>>
  {
    static constexpr unsigned int n     = dim * (dim + 1) / 2;
    static constexpr unsigned int rank  = 2;
    static constexpr bool         whole = false;
    /** See Flat. */
    static SymmetricTensor<2, dim>
    read(const double *numbers)
    {
      SymmetricTensor<2, dim> t;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = i; j < dim; ++j)
          t[i][j] = *numbers++;
      return t;
    }
    /** See Flat. */
    static void
    write(const SymmetricTensor<2, dim> &t, double *numbers)
    {
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = i; j < dim; ++j)
          *numbers++ = t[i][j];
    }
  };

  /** Several values, one after the other. */
  template <typename... Ts>
  struct Flat<std::tuple<Ts...>>
  {
    static constexpr unsigned int n = (Flat<Ts>::n + ...);
    /** See Flat. */
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
    /** See Flat. */
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
} // namespace Morula

#endif
