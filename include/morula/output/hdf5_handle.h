// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_hdf5_handle_h
#define morula_output_hdf5_handle_h

#include <hdf5.h>
#include <mpi.h>

#include <string>
#include <type_traits>
#include <utility>

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
   * Properties of a file that the ranks access through MPI I/O. A single rank
   * uses MPI I/O too, since it takes no locks, which some file systems lack.
   */
  Hdf5Handle
  access_by(const MPI_Comm comm);

  /** HDF5's type of T, which is double, int, unsigned int or unsigned long
   *  long. */
  template <typename T>
  hid_t
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

  /** The name by which MPI-IO opens the file @p path. It takes what stands
   *  before a colon for the kind of a file system, unless that is said first.
   */
  std::string
  name_for_mpi(const std::string &path);
} // namespace Morula

#endif
