// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_hdf5_file_h
#define morula_output_hdf5_file_h

#include <hdf5.h>
#include <mpi.h>

#include <string>
#include <utility>
#include <vector>

// Why HDF5's C interface: deal.II's wrappers check the library's return values
// with Assert only, so that a Release build would not notice a full disk or a
// damaged file. They also have no string data sets and cannot list names.

namespace Morula
{
  /** Owns an identifier of the HDF5 library. */
  class Hdf5Handle
  {
  public:
    Hdf5Handle(const hid_t id, herr_t (*const close)(hid_t))
      : id(id)
      , close(close)
    {}

    ~Hdf5Handle()
    {
      if (id >= 0)
        close(id);
    }

    Hdf5Handle(Hdf5Handle &&other) noexcept
      : id(std::exchange(other.id, H5I_INVALID_HID))
      , close(other.close)
    {}

    operator hid_t() const
    {
      return id;
    }

    /** Closes now.
     *  @return whether that worked */
    bool
    release()
    {
      return close(std::exchange(id, H5I_INVALID_HID)) >= 0;
    }

  private:
    hid_t id;
    herr_t (*close)(hid_t);
  };

  /** Keeps the HDF5 library from printing its errors while this object lives,
   *  and remembers the first of them. */
  class Hdf5Silence
  {
  public:
    Hdf5Silence();
    ~Hdf5Silence();

    /** What the library has said of its first error on this rank; empty: it had
     *  none. */
    const std::string &
    reason() const
    {
      return reason_;
    }

    Hdf5Silence(const Hdf5Silence &) = delete;
    Hdf5Silence &
    operator=(const Hdf5Silence &) = delete;

  private:
    static herr_t
    remember(const hid_t stack, void *silence);

    H5E_auto2_t function;
    void       *data;
    std::string reason_;
  };

  /**
   * An HDF5 file that is written or read.
   *
   * All ranks write together, and all members that write are collective. If one
   * rank fails, it still takes part in what the others do next, and close()
   * reports the failure. The same data written by the same number of ranks give
   * the same file, byte by byte. The file begins with room for a seal
   * (sealed_file.h), which seal() writes after the file is closed.
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

    /** Makes a group. */
    void
    group(const std::string &name);

    /** Writes an attribute of a group. The value is equal on all ranks. T is
     *  double or int. */
    template <typename T>
    void
    attribute(const std::string &group, const std::string &name, const T value);

    /** Writes a string data set. The value is equal on all ranks. */
    void
    text(const std::string &name, const std::string &value);

    /** Writes a vector that is equal on all ranks. T is double or int. */
    template <typename T>
    void
    table(const std::string &name, const std::vector<T> &values);

    /**
     * Writes all ranks' rows in the order of the ranks. A rank may have no
     * rows. T is double, unsigned int or unsigned long long.
     */
    template <typename T>
    void
    rows(const std::string &name,
         const T           *values,
         const hsize_t      n_local_rows,
         const hsize_t      n_columns);

    /** Closes the file.
     *  @return whether everything has worked on all ranks */
    bool
    close();

    /** Why it has not, in the library's words; empty if it does not say. */
    std::string
    reason() const;

    /** The value of an attribute of a group. */
    template <typename T>
    T
    attribute(const std::string &group, const std::string &name) const;

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
    table(const std::string &name) const;

    /** Rows [begin, end) of a data set, stored one after the other. */
    template <typename T>
    std::vector<T>
    rows(const std::string &name, const hsize_t begin, const hsize_t end) const;

  private:
    void
    note(const bool success)
    {
      good = good && success;
    }

    void
    write_dataset(const std::string          &name,
                  const hid_t                 type,
                  const std::vector<hsize_t> &global_size,
                  const hsize_t               first_row,
                  const hsize_t               n_local_rows,
                  const void                 *values);

    MPI_Comm    comm;
    Hdf5Silence silence;
    bool        good = true;
    Hdf5Handle  file;
  };
} // namespace Morula

#endif
