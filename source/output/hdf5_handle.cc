// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/hdf5_handle.h>

namespace Morula
{
  Hdf5Silence::Hdf5Silence()
  {
    // HDF5 prints every error; here they are handled, or tried for.
    H5Eget_auto2(H5E_DEFAULT, &function, &data);
    H5Eset_auto2(H5E_DEFAULT, &Hdf5Silence::remember, this);
  }

  herr_t
  Hdf5Silence::remember(const hid_t stack, void *silence)
  {
    std::string &reason = static_cast<Hdf5Silence *>(silence)->reason_;
    if (!reason.empty())
      return 0;
    // From the call that failed inward: the last one says most.
    const auto read =
      [](const unsigned int, const H5E_error2_t *error, void *text) {
        if (error->desc != nullptr)
          *static_cast<std::string *>(text) = error->desc;
        return herr_t(0);
      };
    return H5Ewalk2(stack, H5E_WALK_DOWNWARD, read, &reason);
  }

  Hdf5Silence::~Hdf5Silence()
  {
    H5Eset_auto2(H5E_DEFAULT, function, data);
  }

  Hdf5Handle
  access_by(const MPI_Comm comm)
  {
    Hdf5Handle list(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_fapl_mpio(list, comm, MPI_INFO_NULL);
    return list;
  }

  std::string
  name_for_mpi(const std::string &path)
  {
    // MPI I/O takes what stands before a colon for a file system.
    return path.find(':') == std::string::npos ? path : "ufs:" + path;
  }
} // namespace Morula
