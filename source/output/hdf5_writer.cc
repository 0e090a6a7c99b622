// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/hdf5_writer.h>
#include <morula/output/sealed_file.h>

#include <deal.II/base/exceptions.h>
#include <deal.II/base/mpi.h>

#include <algorithm>

namespace Morula
{
  using namespace dealii;

  namespace
  {
    Hdf5Handle
    create_file(const std::string &path, const MPI_Comm comm)
    {
      const Hdf5Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
      // HDF5 leaves so many bytes at the beginning of the file alone: there the
      // seal goes.
      H5Pset_userblock(creation, size_of_seal);
      return {H5Fcreate(name_for_mpi(path).c_str(),
                        H5F_ACC_TRUNC,
                        creation,
                        access_by(comm)),
              H5Fclose};
    }

    /** The type of a string of fixed length, at least 1: HDF5 has no strings of
     *  length zero. */
    Hdf5Handle
    string_type(const std::size_t length)
    {
      Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
      H5Tset_size(type, std::max<std::size_t>(length, 1));
      H5Tset_strpad(type, H5T_STR_NULLPAD);
      H5Tset_cset(type, H5T_CSET_UTF8);
      return type;
    }
  } // namespace

  Hdf5Writer::Hdf5Writer(const std::string &path, const MPI_Comm comm)
    : comm(comm)
    , file(create_file(path, comm))
  {
    note(file >= 0);
  }

  void
  Hdf5Writer::group(const std::string &name)
  {
    const Hdf5Handle group(
      H5Gcreate2(file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      H5Gclose);
    note(group >= 0);
  }

  void
  Hdf5Writer::write_attribute(const std::string &group,
                              const std::string &name,
                              const hid_t        type,
                              const void        *value)
  {
    const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Hdf5Handle attribute(H5Acreate_by_name(file,
                                                 group.c_str(),
                                                 name.c_str(),
                                                 type,
                                                 space,
                                                 H5P_DEFAULT,
                                                 H5P_DEFAULT,
                                                 H5P_DEFAULT),
                               H5Aclose);
    note(H5Awrite(attribute, type, value) >= 0);
  }

  void
  Hdf5Writer::attribute(const std::string &group,
                        const std::string &name,
                        const double       value)
  {
    write_attribute(group, name, H5T_NATIVE_DOUBLE, &value);
  }

  void
  Hdf5Writer::attribute(const std::string &group,
                        const std::string &name,
                        const int          value)
  {
    write_attribute(group, name, H5T_NATIVE_INT, &value);
  }

  void
  Hdf5Writer::text(const std::string &name, const std::string &value)
  {
    const bool root = Utilities::MPI::this_mpi_process(comm) == 0;
    // Rank 0 writes the text; the others take part in the call with no rows.
    write_dataset(
      name, string_type(value.size()), {1}, 0, root ? 1 : 0, value.c_str());
  }

  template <typename T>
  void
  Hdf5Writer::table(const std::string &name, const std::vector<T> &values)
  {
    const bool root = Utilities::MPI::this_mpi_process(comm) == 0;
    write_dataset(name,
                  native_type<T>(),
                  {values.size()},
                  0,
                  root ? values.size() : 0,
                  values.data());
  }

  template <typename T>
  void
  Hdf5Writer::rows(const std::string &name,
                   const T           *values,
                   const hsize_t      n_local_rows,
                   const hsize_t      n_columns)
  {
    // The first row of each rank is the number of rows of all lower ranks.
    const unsigned long long n_local = n_local_rows;
    unsigned long long       before  = 0; // MPI_Exscan leaves rank 0's
    const int                ierr =
      MPI_Exscan(&n_local, &before, 1, MPI_UNSIGNED_LONG_LONG, MPI_SUM, comm);
    AssertThrowMPI(ierr);
    write_dataset(name,
                  native_type<T>(),
                  {Utilities::MPI::sum(n_local, comm), n_columns},
                  Utilities::MPI::this_mpi_process(comm) == 0 ? 0 : before,
                  n_local_rows,
                  values);
  }

  void
  Hdf5Writer::write_dataset(const std::string          &name,
                            const hid_t                 type,
                            const std::vector<hsize_t> &global_size,
                            const hsize_t               first_row,
                            const hsize_t               n_local_rows,
                            const void                 *values)
  {
    // The data set is made by all ranks together with its size over all ranks.
    // Then each selects its rows in the file and in memory, and all write in
    // one collective call. Errors are noted and not thrown, as a rank that
    // leaves would let the others wait; close() tells all of them.
    const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    // Without times of creation and without fill values the file depends on the
    // data alone, bit by bit.
    H5Pset_obj_track_times(creation, false);
    H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER);
    const Hdf5Handle file_space(H5Screate_simple(global_size.size(),
                                                 global_size.data(),
                                                 nullptr),
                                H5Sclose);
    const Hdf5Handle dataset(H5Dcreate2(file,
                                        name.c_str(),
                                        type,
                                        file_space,
                                        H5P_DEFAULT,
                                        creation,
                                        H5P_DEFAULT),
                             H5Dclose);
    note(dataset >= 0);

    // A data set without any value has no place in the file, and nothing is to
    // be written.
    const auto has_no_values = [](const std::vector<hsize_t> &size) {
      return std::find(size.begin(), size.end(), hsize_t(0)) != size.end();
    };
    if (has_no_values(global_size))
      return;

    std::vector<hsize_t> offset(global_size.size(), 0);
    std::vector<hsize_t> count = global_size;
    offset[0]                  = first_row;
    count[0]                   = n_local_rows;
    const Hdf5Handle memory_space(
      H5Screate_simple(count.size(), count.data(), nullptr), H5Sclose);
    // A rank without rows takes part with an empty selection.
    const bool nothing = has_no_values(count);
    if (nothing)
      {
        H5Sselect_none(file_space);
        H5Sselect_none(memory_space);
      }
    else
      note(H5Sselect_hyperslab(file_space,
                               H5S_SELECT_SET,
                               offset.data(),
                               nullptr,
                               count.data(),
                               nullptr) >= 0);

    const Hdf5Handle transfer(H5Pcreate(H5P_DATASET_XFER), H5Pclose);
    H5Pset_dxpl_mpio(transfer, H5FD_MPIO_COLLECTIVE);
    const char no_data = 0;
    note(H5Dwrite(dataset,
                  type,
                  memory_space,
                  file_space,
                  transfer,
                  nothing ? &no_data : values) >= 0);
  }

  bool
  Hdf5Writer::close()
  {
    // Whether the file was closed without an error counts as well.
    note(file.release());
    return Utilities::MPI::min(good ? 1 : 0, comm) == 1;
  }

  std::string
  Hdf5Writer::reason() const
  {
    for (const std::string &text :
         Utilities::MPI::all_gather(comm, silence.reason()))
      if (!text.empty())
        return text;
    return "";
  }

  template void
  Hdf5Writer::table(const std::string &, const std::vector<double> &);
  template void
  Hdf5Writer::table(const std::string &, const std::vector<int> &);

  template void
  Hdf5Writer::rows(const std::string &,
                   const double *,
                   const hsize_t,
                   const hsize_t);
  template void
  Hdf5Writer::rows(const std::string &,
                   const unsigned int *,
                   const hsize_t,
                   const hsize_t);
  template void
  Hdf5Writer::rows(const std::string &,
                   const unsigned long long *,
                   const hsize_t,
                   const hsize_t);
} // namespace Morula
