// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_sealed_file_h
#define morula_output_sealed_file_h

#include <boost/crc.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace Morula
{
  /**
   * A number computed from bytes, by which damage is found: the CRC-64 that xz
   * and Go's hash/crc64 call ECMA (CRC-64/XZ). It can be continued when bytes
   * are added.
   *
   * It finds any one or two wrong bits and any run of up to 64 wrong bits. It
   * overlooks other damage once in 2^64 cases. HDF5's own Fletcher-32 has half
   * as many bits, leaves out the file's structure, and is checked by the
   * library that the damage may crash. Nobody forges snapshots, so a CRC is
   * enough.
   */
  using Digest = boost::crc_optimal<64,
                                    0x42f0e1eba9ea3693u,
                                    ~std::uint64_t(0),
                                    ~std::uint64_t(0),
                                    true,
                                    true>;

  /** A digest as 16 hexadecimal digits. */
  std::string
  digest_text(const std::uint64_t digest);

  /** A digest as two integers, the upper half first, for a snapshot's integer
   *  tables. */
  std::vector<int>
  as_integers(const std::uint64_t digest);

  /** The digest of two integers; inverse of as_integers(). */
  std::uint64_t
  digest_of_integers(const std::vector<int> &halves);


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

  /** Refuses a file whose bytes are not those that were written: the HDF5
   *  library must not see it. @throws InputError */
  void
  check_seal(const std::string &path);
} // namespace Morula

#endif
