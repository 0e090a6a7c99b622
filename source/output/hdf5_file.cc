// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/hdf5_file.h>
#include <morula/output/sealed_file.h>

#include <deal.II/base/exceptions.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace Morula
{
  using namespace dealii;

  namespace
  {
    /** Owns an identifier of the HDF5 library. */
    class Handle
    {
    public:
      Handle(const hid_t id, herr_t (*const close)(hid_t))
        : id(id)
        , close(close)
      {}

      ~Handle()
      {
        if (id >= 0)
          close(id);
      }

      Handle(Handle &&other) noexcept
        : id(std::exchange(other.id, H5I_INVALID_HID))
        , close(other.close)
      {}

      operator hid_t() const
      {
        return id;
      }

    private:
      hid_t id;
      herr_t (*close)(hid_t);
    };

    /**
     * Properties of a file that the ranks access through MPI I/O. A single rank
     * uses MPI I/O too, since it takes no locks, which some file systems lack.
     */
    Handle
    access_by(const MPI_Comm comm)
    {
      Handle list(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
      H5Pset_fapl_mpio(list, comm, MPI_INFO_NULL);
      return list;
    }

    /** The name by which MPI-IO opens the file @p path. */
    std::string
    name_for_mpi(const std::string &path)
    {
      // MPI I/O takes what stands before a colon for a file system.
      return path.find(':') == std::string::npos ? path : "ufs:" + path;
    }

    template <typename Number>
    Number
    check(const Number result, const std::string &what)
    {
      // Results of HDF5 are negative where something failed.
      if (result < 0)
        throw std::runtime_error("cannot read " + what);
      return result;
    }

    Handle
    open_dataset(const hid_t file, const std::string &name)
    {
      return {check(H5Dopen2(file, name.c_str(), H5P_DEFAULT),
                    "the data set '" + name + "'"),
              H5Dclose};
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

  Hdf5File::Hdf5File(const MPI_Comm comm)
    : comm(comm)
  {
    // HDF5 prints every error; here they are handled, or tried for.
    H5Eget_auto2(H5E_DEFAULT, &printer, &printer_data);
    H5Eset_auto2(H5E_DEFAULT, &Hdf5File::remember, this);
  }


  Hdf5File::Hdf5File(const std::string &path, const MPI_Comm comm)
    : Hdf5File(comm)
  {
    const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
    // HDF5 leaves so many bytes at the beginning of the file alone: there the
    // seal goes.
    H5Pset_userblock(creation, size_of_seal);
    file = H5Fcreate(name_for_mpi(path).c_str(),
                     H5F_ACC_TRUNC,
                     creation,
                     access_by(comm));
    note(file >= 0);
  }


  Hdf5File::Hdf5File(const std::string &path)
    // Each rank reads by itself, but through MPI I/O as it was written.
    : Hdf5File(MPI_COMM_SELF)
  {
    file = check(H5Fopen(name_for_mpi(path).c_str(),
                         H5F_ACC_RDONLY,
                         access_by(MPI_COMM_SELF)),
                 "the file as HDF5");
  }


  Hdf5File::~Hdf5File()
  {
    if (file >= 0)
      H5Fclose(file);
    H5Eset_auto2(H5E_DEFAULT, printer, printer_data);
  }


  herr_t
  Hdf5File::remember(const hid_t stack, void *file)
  {
    std::string &first = static_cast<Hdf5File *>(file)->first_error;
    if (!first.empty())
      return 0;
    // From the call that failed inward: the last one says most.
    const auto read =
      [](const unsigned int, const H5E_error2_t *error, void *text) {
        if (error->desc != nullptr)
          *static_cast<std::string *>(text) = error->desc;
        return herr_t(0);
      };
    return H5Ewalk2(stack, H5E_WALK_DOWNWARD, read, &first);
  }


  void
  Hdf5File::group(const std::string &name)
  {
    const Handle group(
      H5Gcreate2(file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      H5Gclose);
    note(group >= 0);
  }

  void
  Hdf5File::write_attribute(const std::string &group,
                            const std::string &name,
                            const hid_t        type,
                            const void        *value)
  {
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle attribute(H5Acreate_by_name(file,
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
  Hdf5File::text(const std::string &name, const std::string &value)
  {
    // Of fixed length, at least 1: HDF5 has no strings of length zero.
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type, std::max<std::size_t>(value.size(), 1));
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    H5Tset_cset(type, H5T_CSET_UTF8);
    write_of_root(name, type, 1, value.c_str());
  }



  void
  Hdf5File::write_rows(const std::string &name,
                       const hid_t        type,
                       const void        *values,
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
                  type,
                  {Utilities::MPI::sum(n_local, comm), n_columns},
                  Utilities::MPI::this_mpi_process(comm) == 0 ? 0 : before,
                  n_local_rows,
                  values);
  }


  void
  Hdf5File::write_dataset(const std::string          &name,
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
    const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    // Without times of creation and without fill values the file depends on the
    // data alone, bit by bit.
    H5Pset_obj_track_times(creation, false);
    H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER);
    const Handle file_space(H5Screate_simple(global_size.size(),
                                             global_size.data(),
                                             nullptr),
                            H5Sclose);
    const Handle dataset(H5Dcreate2(file,
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
    const Handle memory_space(
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

    const Handle transfer(H5Pcreate(H5P_DATASET_XFER), H5Pclose);
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
  Hdf5File::close()
  {
    // Whether the file was closed without an error counts as well.
    note(H5Fclose(std::exchange(file, H5I_INVALID_HID)) >= 0);
    return Utilities::MPI::min(good ? 1 : 0, comm) == 1;
  }

  void
  Hdf5File::read_attribute(const std::string &group,
                           const std::string &name,
                           const hid_t        type,
                           void              *value) const
  {
    const std::string what = "the attribute '" + name + "'";
    const Handle      attribute(
      check(H5Aopen_by_name(
              file, group.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
            what),
      H5Aclose);
    check(H5Aread(attribute, type, value), what);
  }


  std::vector<std::string>
  Hdf5File::attribute_names(const std::string &group) const
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
  Hdf5File::dataset_names(const std::string &group) const
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
  Hdf5File::text(const std::string &name) const
  {
    const std::string what    = "the data set '" + name + "'";
    const Handle      dataset = open_dataset(file, name);
    const Handle      type(check(H5Dget_type(dataset), what), H5Tclose);
    const Handle      space(check(H5Dget_space(dataset), what), H5Sclose);
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
  Hdf5File::size(const std::string &name) const
  {
    const std::string    what    = "the data set '" + name + "'";
    const Handle         dataset = open_dataset(file, name);
    const Handle         space(check(H5Dget_space(dataset), what), H5Sclose);
    std::vector<hsize_t> size(check(H5Sget_simple_extent_ndims(space), what));
    check(H5Sget_simple_extent_dims(space, size.data(), nullptr), what);
    return size;
  }


  void
  Hdf5File::read_rows(const std::string                        &name,
                      const hid_t                               type,
                      const hsize_t                             begin,
                      const hsize_t                             end,
                      const std::function<void *(std::size_t)> &room) const
  {
    // The range is checked against the file before memory is taken. Of the
    // columns all are read: a selection of rows [begin, end) in the file, the
    // same number of values in memory.
    const std::string    what  = "the data set '" + name + "'";
    std::vector<hsize_t> count = size(name);
    if (count.empty() || end < begin || end > count[0])
      throw std::runtime_error("cannot read " + what);
    count[0]            = end - begin;
    const std::size_t n = std::accumulate(count.begin(),
                                          count.end(),
                                          std::size_t(1),
                                          std::multiplies<>());
    if (n == 0)
      return;
    std::vector<hsize_t> offset(count.size(), 0);
    offset[0]            = begin;
    const Handle dataset = open_dataset(file, name);
    const Handle file_space(check(H5Dget_space(dataset), what), H5Sclose);
    const Handle memory_space(
      check(H5Screate_simple(count.size(), count.data(), nullptr), what),
      H5Sclose);
    check(H5Sselect_hyperslab(file_space,
                              H5S_SELECT_SET,
                              offset.data(),
                              nullptr,
                              count.data(),
                              nullptr),
          what);
    check(
      H5Dread(dataset, type, memory_space, file_space, H5P_DEFAULT, room(n)),
      what);
  }
} // namespace Morula
