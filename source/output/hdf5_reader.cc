// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/hdf5_reader.h>

#include <algorithm>
#include <stdexcept>

namespace Morula
{
  namespace
  {
    template <typename Number>
    Number
    check(const Number result, const std::string &what)
    {
      // Results of HDF5 are negative where something failed.
      if (result < 0)
        throw std::runtime_error("cannot read " + what);
      return result;
    }

    /** Collects the names that H5Literate and H5Aiterate visit. */
    template <typename Info>
    herr_t
    // HDF5 calls this for each name, and goes on as long as it returns 0.
    append_name(hid_t, const char *name, const Info *, void *names)
    {
      static_cast<std::vector<std::string> *>(names)->push_back(name);
      return 0;
    }
  } // namespace

  Hdf5Reader::Hdf5Reader(const std::string &path)
    // Each rank reads by itself, but through MPI I/O as it was written.
    : file(H5Fopen(name_for_mpi(path).c_str(),
                   H5F_ACC_RDONLY,
                   access_by(MPI_COMM_SELF)),
           H5Fclose)
  {
    check<hid_t>(file, "the file as HDF5");
  }

  template <typename T>
  T
  Hdf5Reader::attribute(const std::string &group, const std::string &name) const
  {
    T                value{};
    const Hdf5Handle attribute(
      check(H5Aopen_by_name(
              file, group.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
            "the attribute '" + name + "'"),
      H5Aclose);
    check(H5Aread(attribute, native_type<T>(), &value),
          "the attribute '" + name + "'");
    return value;
  }

  std::vector<std::string>
  Hdf5Reader::attribute_names(const std::string &group) const
  {
    std::vector<std::string> names;
    check(H5Aiterate_by_name(file,
                             group.c_str(),
                             H5_INDEX_NAME,
                             H5_ITER_INC,
                             nullptr,
                             append_name<H5A_info_t>,
                             &names,
                             H5P_DEFAULT),
          "the group '" + group + "'");
    return names;
  }

  std::vector<std::string>
  Hdf5Reader::dataset_names(const std::string &group) const
  {
    std::vector<std::string> names;
    check(H5Literate_by_name(file,
                             group.c_str(),
                             H5_INDEX_NAME,
                             H5_ITER_INC,
                             nullptr,
                             append_name<H5L_info_t>,
                             &names,
                             H5P_DEFAULT),
          "the group '" + group + "'");
    return names;
  }

  std::string
  Hdf5Reader::text(const std::string &name) const
  {
    const std::string what = "the data set '" + name + "'";
    const Hdf5Handle  dataset(check(H5Dopen2(file, name.c_str(), H5P_DEFAULT),
                                   what),
                             H5Dclose);
    const Hdf5Handle  type(check(H5Dget_type(dataset), what), H5Tclose);
    const Hdf5Handle  space(check(H5Dget_space(dataset), what), H5Sclose);
    // Only what the writer has made is accepted: one string of fixed length.
    if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0 ||
        H5Sget_simple_extent_npoints(space) != 1)
      throw std::runtime_error("cannot read " + what);

    std::string value(H5Tget_size(type), '\0');
    check(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, &value[0]),
          what);
    // Shorter strings are filled up with zeros.
    value.erase(std::find(value.begin(), value.end(), '\0'), value.end());
    return value;
  }

  std::vector<hsize_t>
  Hdf5Reader::size(const std::string &name) const
  {
    const std::string what = "the data set '" + name + "'";
    const Hdf5Handle  dataset(check(H5Dopen2(file, name.c_str(), H5P_DEFAULT),
                                   what),
                             H5Dclose);
    const Hdf5Handle  space(check(H5Dget_space(dataset), what), H5Sclose);
    std::vector<hsize_t> size(check(H5Sget_simple_extent_ndims(space), what));
    check(H5Sget_simple_extent_dims(space, size.data(), nullptr), what);
    return size;
  }

  template <typename T>
  std::vector<T>
  Hdf5Reader::table(const std::string &name) const
  {
    const std::vector<hsize_t> n = size(name);
    if (n.size() != 1)
      throw std::runtime_error("cannot read the data set '" + name +
                               "' as a vector");
    return rows<T>(name, 0, n[0]);
  }

  template <typename T>
  std::vector<T>
  Hdf5Reader::rows(const std::string &name,
                   const hsize_t      begin,
                   const hsize_t      end) const
  {
    // The range is checked against the file before memory is taken. Of the
    // columns all are read: a selection of rows [begin, end) in the file, the
    // same number of values in memory.
    const std::string    what  = "the data set '" + name + "'";
    std::vector<hsize_t> count = size(name);
    if (count.empty() || end < begin || end > count[0])
      throw std::runtime_error("cannot read " + what);
    std::vector<hsize_t> offset(count.size(), 0);
    offset[0] = begin;
    count[0]  = end - begin;

    hsize_t n_values = 1;
    for (const hsize_t n : count)
      n_values *= n;
    std::vector<T> values(n_values);
    if (n_values == 0)
      return values;

    const Hdf5Handle dataset(check(H5Dopen2(file, name.c_str(), H5P_DEFAULT),
                                   what),
                             H5Dclose);
    const Hdf5Handle file_space(check(H5Dget_space(dataset), what), H5Sclose);
    const Hdf5Handle memory_space(
      check(H5Screate_simple(count.size(), count.data(), nullptr), what),
      H5Sclose);
    check(H5Sselect_hyperslab(file_space,
                              H5S_SELECT_SET,
                              offset.data(),
                              nullptr,
                              count.data(),
                              nullptr),
          what);
    check(H5Dread(dataset,
                  native_type<T>(),
                  memory_space,
                  file_space,
                  H5P_DEFAULT,
                  values.data()),
          what);
    return values;
  }

  template double
  Hdf5Reader::attribute(const std::string &, const std::string &) const;
  template int
  Hdf5Reader::attribute(const std::string &, const std::string &) const;

  template std::vector<double>
  Hdf5Reader::table(const std::string &) const;
  template std::vector<int>
  Hdf5Reader::table(const std::string &) const;

  template std::vector<double>
  Hdf5Reader::rows(const std::string &, const hsize_t, const hsize_t) const;
  template std::vector<unsigned int>
  Hdf5Reader::rows(const std::string &, const hsize_t, const hsize_t) const;
  template std::vector<unsigned long long>
  Hdf5Reader::rows(const std::string &, const hsize_t, const hsize_t) const;
} // namespace Morula
