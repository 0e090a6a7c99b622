// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_sealed_file_h
#define morula_output_sealed_file_h

#include <cstddef>
#include <string>

namespace Morula
{
  /**
   * Size of the seal at the beginning of a file, bytes: a text of three lines,
   *
   *     Morula snapshot
   *     bytes 123456
   *     CRC-64/XZ 0123456789abcdef
   *
   * filled up with newlines. The bytes and the digest are those behind it. HDF5
   * calls such a place a user block and passes over it; 512 is the smallest.
   *
   * The digest is that of the file's bytes, not of the values in it: then the
   * file can be judged before the HDF5 library sees it, which crashes on some
   * damaged files, and no byte is left out.
   */
  constexpr std::size_t size_of_seal = 512;

  /**
   * Writes the seal of a file that is complete, over its first bytes.
   * @throws std::runtime_error with path and reason
   */
  void
  seal(const std::string &path);

  /** What is true of a file. */
  enum class SealState
  {
    missing,    // cannot be opened
    foreign,    // has no seal
    plain_hdf5, // is HDF5 from its first byte on
    damaged,    // seal and bytes do not agree
    whole
  };

  /** Compares a file with its seal. Reads all of it. */
  SealState
  examine_seal(const std::string &path);
} // namespace Morula

#endif
