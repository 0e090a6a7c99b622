// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_hdf5_file_h
#define morula_output_hdf5_file_h

#include <deal.II/base/mpi.h>

#include <hdf5.h>
#include <mpi.h>

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

// Why HDF5's C interface: deal.II's wrappers check the library's return values
// with Assert only, so that a Release build would not notice a full disk or a
// damaged file. They also have no string data sets and cannot list names.

namespace Morula
{
  /**
   * An HDF5 file that is written or read.
   *
   * All ranks write together, and all members that write are collective. If one
   * rank fails, it still takes part in what the others do next, and close()
   * reports the failure. The same data written by the same number of ranks give
   * the same file, byte by byte. The file begins with room for a seal
   * (sealed_file.h), which seal() writes after the file is closed. While an
   * object of this class lives the library does not print its errors.
   *
   * Each rank reads on its own. Members that read throw a std::runtime_error
   * that says what cannot be read.
   */
  class Hdf5File
  {
  public:
    /** Makes a file that is written. Collective. */
    Hdf5File(const std::string &path, const MPI_Comm comm);

    /** Opens a file that is read. */
    explicit Hdf5File(const std::string &path);

    ~Hdf5File();

    Hdf5File(const Hdf5File &) = delete;
    Hdf5File &
    operator=(const Hdf5File &) = delete;

    /** Makes a group. */
    void
    group(const std::string &name);

    /** Writes an attribute of a group. The value is equal on all ranks. T is
     *  double or int. */
    template <typename T>
    void
    attribute(const std::string &group, const std::string &name, const T value)
    {
      write_attribute(group, name, native_type<T>(), &value);
    }

    /** Writes a string data set. The value is equal on all ranks. */
    void
    text(const std::string &name, const std::string &value);

    /** Writes a vector that is equal on all ranks. T is double or int. */
    template <typename T>
    void
    table(const std::string &name, const std::vector<T> &values)
    {
      write_of_root(name, native_type<T>(), values.size(), values.data());
    }

    /**
     * Writes all ranks' rows in the order of the ranks. A rank may have no
     * rows. T is double, unsigned int or unsigned long long.
     */
    template <typename T>
    void
    rows(const std::string &name,
         const T           *values,
         const hsize_t      n_local_rows,
         const hsize_t      n_columns)
    {
      write_rows(name, native_type<T>(), values, n_local_rows, n_columns);
    }

    /** Closes the file.
     *  @return whether everything has worked on all ranks */
    bool
    close();

    /** Why it has not, in the library's words. Collective. */
    std::string
    reason() const
    {
      for (const std::string &text :
           dealii::Utilities::MPI::all_gather(comm, first_error))
        if (!text.empty())
          return text;
      return "is the disk full?";
    }

    /** The value of an attribute of a group. */
    template <typename T>
    T
    attribute(const std::string &group, const std::string &name) const
    {
      T value{};
      read_attribute(group, name, native_type<T>(), &value);
      return value;
    }

    /** The names of a group's attributes. */
    std::vector<std::string>
    attribute_names(const std::string &group) const;

    /** The names of the data sets in a group. */
    std::vector<std::string>
    dataset_names(const std::string &group) const;

    /** A data set that holds a text. */
    std::string
    text(const std::string &name) const;

    /** Number of values in each direction. */
    std::vector<hsize_t>
    size(const std::string &name) const;

    /** A whole vector. */
    template <typename T>
    std::vector<T>
    table(const std::string &name) const
    {
      const std::vector<hsize_t> n = size(name);
      if (n.size() != 1)
        throw std::runtime_error("cannot read the data set '" + name +
                                 "' as a vector");
      return rows<T>(name, 0, n[0]);
    }

    /** Rows [begin, end) of a data set, stored one after the other. */
    template <typename T>
    std::vector<T>
    rows(const std::string &name, const hsize_t begin, const hsize_t end) const
    {
      std::vector<T> values;
      read_rows(name, native_type<T>(), begin, end, [&](const std::size_t n) {
        values.resize(n);
        return values.data();
      });
      return values;
    }

  private:
    /** Silences the library. */
    explicit Hdf5File(const MPI_Comm comm);

    /** HDF5's type of T. */
    template <typename T>
    static hid_t
    native_type()
    {
      if constexpr (std::is_same_v<T, double>)
        return H5T_NATIVE_DOUBLE;
      else if constexpr (std::is_same_v<T, int>)
        return H5T_NATIVE_INT;
      else if constexpr (std::is_same_v<T, unsigned int>)
        return H5T_NATIVE_UINT;
      else
        {
          static_assert(std::is_same_v<T, unsigned long long>,
                        "no such values in a file");
          return H5T_NATIVE_ULLONG;
        }
    }

    /** Remembers the first of the library's errors. */
    static herr_t
    remember(const hid_t stack, void *file);

    void
    note(const bool success)
    {
      good = good && success;
    }

    void
    write_attribute(const std::string &group,
                    const std::string &name,
                    const hid_t        type,
                    const void        *value);

    /** Rank 0 writes; the others take part in the call with no rows. */
    void
    write_of_root(const std::string &name,
                  const hid_t        type,
                  const hsize_t      n,
                  const void        *values)
    {
      const bool root = dealii::Utilities::MPI::this_mpi_process(comm) == 0;
      write_dataset(name, type, {n}, 0, root ? n : 0, values);
    }

    void
    write_rows(const std::string &name,
               const hid_t        type,
               const void        *values,
               const hsize_t      n_local_rows,
               const hsize_t      n_columns);

    void
    write_dataset(const std::string          &name,
                  const hid_t                 type,
                  const std::vector<hsize_t> &global_size,
                  const hsize_t               first_row,
                  const hsize_t               n_local_rows,
                  const void                 *values);

    void
    read_attribute(const std::string &group,
                   const std::string &name,
                   const hid_t        type,
                   void              *value) const;

    /** @param room gives room for so many values */
    void
    read_rows(const std::string                        &name,
              const hid_t                               type,
              const hsize_t                             begin,
              const hsize_t                             end,
              const std::function<void *(std::size_t)> &room) const;

    MPI_Comm    comm;
    H5E_auto2_t printer; // of the library's errors, before
    void       *printer_data;
    std::string first_error; // on this rank; empty: there was none
    bool        good = true;
    hid_t       file = H5I_INVALID_HID;
  };
} // namespace Morula

#endif
