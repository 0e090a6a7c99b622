// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_cuts_h
#define morula_seeding_cuts_h

#include <morula/base/key.h>
#include <morula/seeding/seeding.h>

#include <string>

namespace Morula
{
  /**
   * Adds to the surface both faces of cuts that have no width: each patch of a
   * cut becomes two at one place with opposite normals, about as large as those
   * of the surface. What lies outside of the tissue is left out. Collective.
   * @param file its cuts at t = 0, in µm: in 2-D lines as well-known text
   * (WKT), in 3-D open surfaces of triangles as STL, OFF, PLY or OBJ
   * @return how far the tissue is cut, in words
   * @throws InputError if the file cannot be read, or cuts no tissue
   */
  template <int dim>
  std::string
  add_cuts(const Key<std::string> &file,
           const Founders<dim>    &founders,
           const MPI_Comm          comm,
           SurfacePatches<dim>    &surface);
} // namespace Morula

#endif
