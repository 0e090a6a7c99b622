// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_hdf5_writer_h
#define morula_output_hdf5_writer_h

#include <morula/output/hdf5_handle.h>

#include <string>
#include <vector>

namespace Morula
{
  /**
   * Writes an HDF5 file on all ranks together. All members are collective. If
   * one rank fails, it still takes part in what the others do next, and close()
   * reports the failure. The same data written by the same number of ranks give
   * the same file, byte by byte. The file begins with room for a seal
   * (sealed_file.h), which seal() writes after the file is closed.
   */
  class Hdf5Writer
  {
  public:
    Hdf5Writer(const std::string &path, const MPI_Comm comm);

    /** Makes a group. */
    void
    group(const std::string &name);

    /** Writes an attribute of a group. The value is equal on all ranks. */
    void
    attribute(const std::string &group,
              const std::string &name,
              const double       value);

    void
    attribute(const std::string &group,
              const std::string &name,
              const int          value);

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

  private:
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
