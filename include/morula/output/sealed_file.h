// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_sealed_file_h
#define morula_output_sealed_file_h

#include <cstddef>
#include <string>

namespace Morula
{
  /**
   * Size of the seal at the beginning of a file, bytes. The seal is a text of
   * three lines,
   *
   *     Morula snapshot
   *     bytes 123456
   *     CRC-64/XZ 0123456789abcdef
   *
   * filled up with newlines. Number and digest are those of the bytes behind
   * the seal. HDF5 calls such a beginning a user block and skips it; 512 is its
   * smallest size.
   *
   * The digest is computed from the file's bytes and not from the values in it.
   * So every byte counts, and the file can be checked before the HDF5 library
   * opens it, which crashes on some damaged files.
   */
  constexpr std::size_t size_of_seal = 512;

  /**
   * Writes the seal over the first bytes of `path.tmp`, which is complete, and
   * gives it the file's name.
   * @throws std::runtime_error with path and reason
   */
  void
  seal(const std::string &path);

  /** The state of a file that should have a seal. */
  enum class SealState
  {
    missing,    // cannot be opened
    foreign,    // has no seal
    plain_hdf5, // has no seal, and begins as an HDF5 file
    damaged,    // seal and bytes disagree
    whole
  };

  /** Compares a file with its seal. */
  SealState
  examine_seal(const std::string &path);
} // namespace Morula

#endif
