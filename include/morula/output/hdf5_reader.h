// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_hdf5_reader_h
#define morula_output_hdf5_reader_h

#include <morula/output/hdf5_handle.h>

#include <string>
#include <vector>

namespace Morula
{
  /**
   * Reads an HDF5 file. Each rank reads on its own. All members throw a
   * std::runtime_error that says what cannot be read.
   */
  class Hdf5Reader
  {
  public:
    explicit Hdf5Reader(const std::string &path);

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
    Hdf5Silence silence;
    Hdf5Handle  file;
  };
} // namespace Morula

#endif
