// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_mesh_file_fault_h
#define morula_base_mesh_file_fault_h

#include <string>

namespace Morula::MeshFile
{
  /**
   * Looks for the first thing in a mesh file that no reader could take: a
   * vertex without three finite numbers, a polygon that names a vertex that is
   * not there, an end before the last record.
   * @param content all bytes of the file
   * @param ending  ".obj", ".off", ".ply" or ".stl"
   * @returns what it is, with the number of the line or record, as a clause;
   *          nothing if it sees no fault
   */
  std::string
  fault_in(const std::string &content, const std::string &ending);
} // namespace Morula::MeshFile

#endif
