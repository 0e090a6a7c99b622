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
   * Writes an HDF5 file on all ranks together. All members are collective. A
   * failure on one rank must not keep it from joining what the others do next:
   * it is kept in mind until close(). The content is the same, byte by byte,
   * whenever the same data are written by as many ranks. The file begins with
   * room for a seal (sealed_file.h), which seal() writes when it is closed.
   */
  class Hdf5Writer
  {
  public:
    Hdf5Writer(const std::string &path, const MPI_Comm comm);

    /** Makes a group. Collective. */
    void
    group(const std::string &name);

    /** An attribute of a group; the same value on all ranks. */
    void
    attribute(const std::string &group,
              const std::string &name,
              const double       value);

    void
    attribute(const std::string &group,
              const std::string &name,
              const int          value);

    /** A string data set; the same on all ranks. */
    void
    text(const std::string &name, const std::string &value);

    /** A vector that is the same on all ranks. T is double or int. */
    template <typename T>
    void
    table(const std::string &name, const std::vector<T> &values);

    /**
     * All ranks' rows, in the order of the ranks; any rank may have none. T is
     * double or unsigned int or unsigned long long.
     */
    template <typename T>
    void
    rows(const std::string &name,
         const T           *values,
         const hsize_t      n_local_rows,
         const hsize_t      n_columns);

    /** Whether everything has worked on all ranks. */
    bool
    close();

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
